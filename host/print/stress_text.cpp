// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "host/base/text.h"
#include "host/print/print_run.h"

namespace rt {

namespace {

constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();

/// "4000 allowed", or "any" where there is no limit.
std::string allowed_text(std::size_t count) {
    return count == no_limit ? "any" : fmt::format("{} allowed", count);
}

/// The row of a family's trials of rays, among those that are judged, in which most fail.
const StressRow* worst_of_rays(const StressFamilyResult& family) {
    const StressRow* worst = nullptr;
    for (const StressCaseResult& one : family.cases) {
        for (const StressRow& row : one.rows) {
            if (!row.rays || !row.judged) continue;
            if (worst == nullptr || row.rays->failures > worst->rays->failures) worst = &row;
        }
    }
    return worst;
}

std::string worst_text(const PictureFigures& worst) {
    std::string text = fmt::format("{} wrong ({} at edges), {:.1e}", worst.wrong,
                                   worst.wrong_at_edges, worst.max_error);
    if (worst.nans > 0) text += fmt::format(", {} NaN", worst.nans);
    if (worst.infinities > 0) text += fmt::format(", {} inf", worst.infinities);
    return text;
}

/// The loosest tolerance of a family's cases.
StressTolerance loosest_tolerance(const StressFamilyResult& family) {
    StressTolerance loosest{0, 0, 0, false, true};
    for (const StressCaseResult& one : family.cases) {
        loosest.most_wrong = std::max(loosest.most_wrong, one.tolerance.most_wrong);
        loosest.most_wrong_at_edges =
            std::max(loosest.most_wrong_at_edges, one.tolerance.most_wrong_at_edges);
        loosest.max_error = std::max(loosest.max_error, one.tolerance.max_error);
    }
    return loosest;
}

/// The worst of a family next to what is allowed: "987 of 100000 rays wrong, 4000 allowed".
std::string family_figures(const StressFamilyResult& family) {
    const PictureFigures worst = worst_figures(family);
    const StressTolerance allowed = loosest_tolerance(family);
    if (const StressRow* const row = worst_of_rays(family)) {
        return fmt::format("{} of {} rays wrong, {}", row->rays->failures, row->rays->rays,
                           allowed_text(allowed.most_wrong));
    }
    if (worst.nans + worst.infinities > 0) return worst_text(worst);
    return fmt::format("{} pixels wrong, {}; error {:.0e} of {:.0e}", worst.wrong,
                       allowed_text(allowed.most_wrong), worst.max_error, allowed.max_error);
}

std::string row_name(const StressRow& row) {
    return fmt::format("{} {}", row.renderer, to_string(row.precision));
}

std::string row_figures(const StressRow& row) {
    if (row.rays) {
        return fmt::format("{} of {} rays fail, {:.1e}", row.rays->failures, row.rays->rays,
                           row.rays->max_error);
    }
    return worst_text(row.figures);
}

std::string row_verdict(const StressRow& row) {
    if (!row.judged) return "not judged";
    return row.why.empty() ? "pass" : "FAIL: " + row.why;
}

std::string case_lines(const StressCaseResult& one) {
    std::string text;
    for (const StressRow& row : one.rows) {
        text += fmt::format("  {:<24} {:<44} {:<40} {:>8.4f} s  {}\n", one.label, row_name(row),
                            row_figures(row), row.seconds, row_verdict(row));
    }
    if (!one.disagreement.empty()) {
        text += fmt::format("  {:<24} FAIL: {}\n", one.label, one.disagreement);
    }
    return text;
}

std::string broken_lines(const StressFamilyResult& family) {
    std::string text;
    for (const StressCaseResult& one : family.cases) {
        for (const StressRow& row : one.rows) {
            if (row.passed()) continue;
            text += fmt::format("    FAIL {}/{}, {}: {}\n", family.name, one.label, row_name(row),
                                row.why);
        }
        if (one.disagreement.empty()) continue;
        text += fmt::format("    FAIL {}/{}: {}\n", family.name, one.label, one.disagreement);
    }
    return text;
}

std::string family_lines(const StressFamilyResult& family, bool verbose) {
    std::string text = fmt::format("{:<4} {:<20} {}\n", family.passed() ? "pass" : "FAIL",
                                   family.name, family_figures(family));
    if (verbose) {
        text += fmt::format("     {}\n", family.why);
        for (const StressCaseResult& one : family.cases) text += case_lines(one);
        return text;
    }
    return text + broken_lines(family);
}

}  // namespace

std::string stress_text(const StressResult& result, bool verbose) {
    const auto passed = std::ranges::count_if(result.families, &StressFamilyResult::passed);
    std::string text =
        fmt::format("{}: {} of {} families, {:.0f} s{}\n", result.passed() ? "PASS" : "FAIL",
                    passed, result.families.size() + result.unfinished, result.seconds,
                    result.interrupted ? ", interrupted" : "");
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
