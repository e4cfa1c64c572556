// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/isolated_render.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/temporary_folder.h"
#include "host/opencl/device_spec.h"
#include "host/opencl/icd_files.h"
#include "host/process/stop_signal.h"
#include "host/process/worker.h"
#include "host/render/stopwatch.h"
#include "host/scene/scene_file.h"
#include "host/scene/text_file.h"
#include "host/verbs/batch_log.h"
#include "host/verbs/render_steps.h"

namespace rt {

namespace {

/// Renders in worker processes, which load the drivers.
class IsolatedRender {
   public:
    IsolatedRender(RenderOptions options, double seconds_before_main, RenderHere render_here)
        : options_(std::move(options)),
          seconds_before_(seconds_before_main),
          render_here_(std::move(render_here)),
          name_(options_.device.empty() ? "OpenCL" : "--device " + options_.device) {}

    /// If the first worker crashes, another one tries. If that crashes too, others try without each
    /// of several devices. If they crash, or one hangs, threads resume here from the journal. A
    /// batch gets a new worker as long as pictures are finished.
    int run() {
        if (options_.scene == stdin_scene) keep_stdin();  // each worker reads it
        const JournalState journal = state_of_journal();
        if (batch_log_) options_.batch_log = std::to_string(batch_log_.number());
        WorkerEnd end = work({});
        for (std::size_t before = 0, now = 0; has_failed(end); before = now) {
            now = BatchLog(options_.batch_log).finished();
            if (now == before) break;
            say(end, "restarting it");
            end = work({});
        }
        keep_journal(journal);
        if (has_crashed(end)) end = try_otherwise(end);
        if (end.stop_signal != 0) end_by_stop_signal(end.stop_signal);
        if (end.is_regular) return end.status;
        if (options_.no_fallback) {
            throw Error(ExitCode::device, name_ + ": the driver process " + end.how);
        }
        keep_journal(journal);
        say(end, "rendering on threads instead");
        if (options_.timeout > 0) {
            options_.timeout = std::max(options_.timeout - watch_.seconds(), 0.001);
        }
        options_.failed_device = name_;
        options_.device_failure = "the driver process " + end.how;
        options_.device = "threads";
        return render_here_(options_, seconds_before_ + watch_.seconds());
    }

   private:
    static bool has_failed(const WorkerEnd& end) { return !end.is_regular && end.stop_signal == 0; }
    static bool has_crashed(const WorkerEnd& end) { return has_failed(end) && !end.is_hung; }

    static bool lacks_device(const WorkerEnd& end) {
        return end.is_regular && end.status == static_cast<int>(ExitCode::device);
    }

    using JournalState = std::pair<std::filesystem::file_time_type, std::uintmax_t>;

    JournalState state_of_journal() const {
        if (!options_.fresh || options_.is_batch()) return {};
        RenderOptions chosen = options_;
        choose_journal(chosen);
        std::error_code ignored;
        return {std::filesystem::last_write_time(chosen.journal, ignored),
                std::filesystem::file_size(chosen.journal, ignored)};
    }

    /// What a worker with --fresh has written is resumed by those after it.
    void keep_journal(const JournalState& before) {
        if (state_of_journal() == before) return;
        options_.fresh = false;
        std::erase(options_.command, "--fresh");
    }

    WorkerEnd work(std::vector<std::string> changes) const {
        if (batch_log_) changes.push_back("MIRRORBALL_BATCH=" + options_.batch_log);
        // A driver may busy-wait for ever: at --timeout the worker gets a while to save its
        // picture.
        const double passed = watch_.seconds();
        const double longest = options_.timeout > 0
                                   ? std::max(options_.timeout - passed, 0.0) + options_.deadline
                                   : std::numeric_limits<double>::infinity();
        return run_worker(options_.command, changes, options_.deadline, seconds_before_ + passed,
                          longest);
    }

    WorkerEnd try_otherwise(const WorkerEnd& first) const {
        IcdFiles files = try_icd_files(options_.drivers);
        const UsableIcdFiles usable(files);
        const WorkerEnd second = try_again(first, files, usable);
        return has_crashed(second) ? try_fewer(second, files, usable) : second;
    }

    /// Without drivers that crash when listing their devices, else with an empty kernel cache.
    WorkerEnd try_again(const WorkerEnd& first, const IcdFiles& files,
                        const UsableIcdFiles& usable) const {
        const TemporaryFolder cache;
        if (!files.any_dangerous && !cache.name().empty()) {
            say(first, "retrying with an empty kernel cache");
            return work({"POCL_CACHE_DIR=" + cache.name()});
        }
        if (usable.change().empty()) return first;
        say(first, "retrying with the other drivers");
        const WorkerEnd second = work(usable.change());
        return lacks_device(second) ? first : second;
    }

    /// Without one of several OpenCL devices after the other.
    WorkerEnd try_fewer(WorkerEnd end, IcdFiles& files, const UsableIcdFiles& usable) const {
        const std::vector<std::string> specs = specs_one_by_one(files, usable);
        if (std::count_if(specs.begin(), specs.end(), needs_opencl) < 2) return end;
        for (const std::string& left_out : specs) {
            if (!needs_opencl(left_out) || !has_crashed(end)) continue;
            std::vector<std::string> others = specs;
            std::erase(others, left_out);
            say(end, "trying again without --device " + left_out);
            const WorkerEnd next =
                work({fmt::format("MIRRORBALL_DEVICES={}", fmt::join(others, ","))});
            if (!lacks_device(next)) end = next;
        }
        return end;
    }

    /// What --device lists, with each device that "all" stands for.
    std::vector<std::string> specs_one_by_one(IcdFiles& files, const UsableIcdFiles& usable) const {
        std::vector<std::string> specs;
        for (const std::string& spec : specs_of(options_.device)) {
            if (spec != all_devices) {
                specs.push_back(spec);
                continue;
            }
            specs.emplace_back("threads");
            for (const ClDevice& device : list_devices_of(files, usable)) {
                if (device.unusable.empty()) specs.push_back(std::to_string(device.index));
            }
        }
        return specs;
    }

    void say(const WorkerEnd& end, const std::string& then) const {
        if (options_.quiet) return;
        print_note(fmt::format("{}: the driver process {}; {}", name_, end.how, then));
    }

    RenderOptions options_;
    const double seconds_before_;
    const RenderHere render_here_;
    const std::string name_;
    const FileDescriptor batch_log_ =
        options_.is_batch() ? BatchLog::make_memory() : FileDescriptor();
    const Stopwatch watch_;
};

}  // namespace

int render_isolated(const RenderOptions& options, double seconds_before_main,
                    RenderHere render_here) {
    return IsolatedRender(options, seconds_before_main, std::move(render_here)).run();
}

}  // namespace rt
