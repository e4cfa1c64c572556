// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>

#include "host/base/error.h"
#include "host/base/parallel.h"
#include "host/base/text.h"
#include "host/base/version.h"
#include "host/picture/crew.h"
#include "host/process/stop_signal.h"
#include "host/process/worker.h"
#include "host/record/record.h"
#include "host/scene/line_scanner.h"
#include "host/scene/text_file.h"
#include "host/selftest/selftest.h"
#include "host/stress/judge.h"

namespace rt {

namespace {

std::string xml(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        const bool is_special = c == '&' || c == '<' || c == '"' || c == '\n';
        safe += is_special ? fmt::format("&#{};", code) : std::string(1, code < 32 ? '?' : c);
    }
    return safe;
}

const char* verdict(const Check& check) {
    return check.is_expected() ? "known" : check.why.empty() ? "passes" : "wrong";
}

std::string reason(const Check& check) {
    return check.why.empty() ? "right, but expected to fail" : check.why;
}

}  // namespace

std::set<std::string> known_failures(const std::string& file) {
    std::set<std::string> names;
    if (file.empty()) return names;
    const FileText text = read_text_file(file, 1 << 20);
    Mistakes mistakes(text.view(), file);
    for (LineScanner scanner(text.view()); scanner.find_word(); scanner.next_line()) {
        names.emplace(scanner.word());
        if (!scanner.word_follows()) continue;
        mistakes.add(scanner.offset(),
                     "another word; put one name on a line, and # before comments");
    }
    mistakes.throw_if_any();
    return names;
}

bool Checks::wants(const std::string& name) const {
    if (stop_flag() != 0) return false;
    return filters_.empty() ||
           std::any_of(filters_.begin(), filters_.end(), [&](const std::string& glob) {
               return fnmatch(glob.c_str(), name.c_str(), 0) == 0;
           });
}

void Checks::run(const std::string& name, const std::function<std::string()>& check) {
    if (!wants(name)) return;
    Check done{name, "", 0};
    const DriverTask task(name);
    const Stopwatch watch;
    try {
        done.why = check();
    } catch (const cl::Error& error) {
        done.why = fmt::format("{}: {}", error.what(), cl_status_text(error.err()));
    } catch (const Error& error) {
        done.why = error.what();
    }
    done.seconds = watch.seconds();
    note_worker_progress();
    if (stop_flag() == 0) add(std::move(done));
}

void Checks::add(Check done) {
    done.is_known = known_.count(done.name) != 0;
    tell_parent(json_of(done).dump(-1, ' ', false, Json::error_handler_t::replace));
    list_.push_back(std::move(done));
}

bool Checks::is_all_expected() const {
    return std::all_of(list_.begin(), list_.end(), [](auto& check) { return check.is_expected(); });
}

std::string Checks::text(double seconds) const {
    std::string text;
    std::size_t wrong = 0, known = 0, surprises = 0;
    for (const Check& check : list_) {
        wrong += !check.why.empty();
        known += check.is_known;
        surprises += !check.is_expected();
        if (check.why.empty() && !check.is_known) continue;
        text +=
            fmt::format("{:<6} {}: {}\n", verdict(check), check.name, first_line(reason(check)));
    }
    text += fmt::format("{} checks, {} wrong", list_.size(), wrong);
    if (known != 0) text += fmt::format(", {} known to be, {} unexpected", known, surprises);
    return text + fmt::format(", {:.1f} s\n", seconds);
}

std::string Checks::json(double seconds, const std::vector<ClDevice>& devices) const {
    return json_text({{"format", "mirrorball-selftest"},
                      {"version", 1},
                      {"program", fmt::format("{} ({})", version, git_revision)},
                      {"devices", json_of(devices)},
                      {"passed", is_all_expected()},
                      {"seconds", seconds},
                      {"checks", json_of(list_)}});
}

std::string Checks::junit(double seconds) const {
    std::string cases;
    std::size_t failures = 0;
    for (const Check& check : list_) {
        cases += fmt::format("  <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"",
                             xml(check.name.substr(0, check.name.find('/'))), xml(check.name),
                             check.seconds);
        failures += !check.is_expected();
        const bool is_plain = check.why.empty() && !check.is_known;
        cases += is_plain
                     ? "/>\n"
                     : fmt::format("><{} message=\"{}\"/></testcase>\n",
                                   check.is_expected() ? "skipped" : "failure", xml(reason(check)));
    }
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<testsuite name=\"mirrorball\" tests=\"{}\" failures=\"{}\" time=\"{:.3f}\">\n"
        "{}</testsuite>\n",
        list_.size(), failures, seconds, cases);
}

void check_stress(Checks& checks, const std::string& spec, const std::string& prefix) {
    StressOptions stress;
    stress.devices = {spec};
    stress.quick = stress.quiet = true;
    RenderCache cache;  // one build for all
    for (const StressFamily& family : chosen_families(all_stress_families(), {}, {}, true)) {
        checks.run(prefix + "stress/" + family.name, [&]() -> std::string {
            const StressResult result = run_stress_cases({family}, stress, cache);
            if (result.families.empty()) return "";  // stopped
            for (const StressCaseResult& one : result.families.front().cases) {
                for (const StressRow& row : one.rows) {
                    if (row.passed()) continue;
                    return fmt::format("{} in {}: {}", one.label, to_string(row.precision),
                                       row.why);
                }
            }
            return "";
        });
    }
}

}  // namespace rt
