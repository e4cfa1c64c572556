// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "host/base/text.h"
#include "host/print/print_run.h"

namespace rt {

namespace {

std::string row_name(const StressRow& row) {
    return fmt::format("{} {}", row.renderer, to_string(row.precision));
}

std::string row_figures(const StressRow& row) {
    if (row.rays) {
        return fmt::format("{} of {} rays fail, {:.1e}", row.rays->failures, row.rays->rays,
                           row.rays->max_error);
    }
    const PictureFigures& figures = row.figures;
    std::string text = fmt::format("{} wrong ({} at edges), {:.1e}", figures.wrong,
                                   figures.wrong_at_edges, figures.max_error);
    if (figures.nans > 0) text += fmt::format(", {} NaN", figures.nans);
    if (figures.infinities > 0) text += fmt::format(", {} inf", figures.infinities);
    return text;
}

/// Of the row, among those that are judged, in which most is wrong.
std::string family_figures(const StressFamilyResult& family) {
    const auto badness = [](const StressRow& row) {
        return row.rays ? std::pair<std::size_t, double>(row.rays->failures, row.rays->max_error)
                        : std::pair(row.figures.wrong, row.figures.max_error);
    };
    const StressRow* worst = nullptr;
    for (const StressCaseResult& one : family.cases) {
        for (const StressRow& row : one.rows) {
            if (row.judged && (!worst || badness(row) > badness(*worst))) worst = &row;
        }
    }
    return worst ? row_figures(*worst) : "not judged";
}

std::string row_verdict(const StressRow& row) {
    if (!row.judged) return "not judged";
    return row.why.empty() ? "pass" : "FAIL: " + row.why;
}

/// A line per row that failed; verbose: per row.
std::string case_lines(const StressCaseResult& one, bool verbose) {
    std::string text;
    for (const StressRow& row : one.rows) {
        if (row.passed() && !verbose) continue;
        text += fmt::format("  {:<24} {:<44} {:<40} {:>8.4f} s  {}\n", one.label, row_name(row),
                            row_figures(row), row.seconds, row_verdict(row));
    }
    if (!one.disagreement.empty()) {
        text += fmt::format("  {:<24} FAIL: {}\n", one.label, one.disagreement);
    }
    return text;
}

std::string family_lines(const StressFamilyResult& family, bool verbose) {
    std::string text = fmt::format("{:<4} {:<20} {}\n", family.passed() ? "pass" : "FAIL",
                                   family.name, family_figures(family));
    if (verbose) text += fmt::format("     {}\n", family.why);
    for (const StressCaseResult& one : family.cases) text += case_lines(one, verbose);
    return text;
}

}  // namespace

std::string stress_text(const StressResult& result, bool verbose) {
    const auto passed = std::ranges::count_if(result.families, &StressFamilyResult::passed);
    const bool has_failed = passed < std::ssize(result.families) || !result.interrupted;
    std::string text = fmt::format("{}: {} of {} families, {:.0f} s{}\n",
                                   result.passed() ? "PASS" : (has_failed ? "FAIL" : "STOPPED"),
                                   passed, result.families.size() + result.unfinished,
                                   result.seconds, result.interrupted ? ", interrupted" : "");
    for (const StressFamilyResult& family : result.families) {
        text += family_lines(family, verbose);
    }
    return text;
}

std::string stress_list(const std::vector<StressFamily>& families) {
    std::string text;
    for (const StressFamily& family : families) {
        text += fmt::format("{}: {}\n", family.name, family.why);
        for (const StressCase& one : family.cases) {
            text += fmt::format("  {}/{}{}\n", family.name, one.label, one.quick ? "  quick" : "");
        }
    }
    return text;
}

}  // namespace rt
