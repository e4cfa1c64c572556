// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/watch.h"

#include <sys/stat.h>

#include <chrono>
#include <cstdint>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/process/stop_signal.h"
#include "host/process/worker.h"
#include "host/verbs/scene_files.h"

namespace rt {

namespace {

constexpr std::chrono::milliseconds look_interval(100);

/// What changes when a file is written in place or replaced; zeros if it does not exist.
using FileState = std::tuple<ino_t, off_t, std::int64_t, std::int64_t>;

std::vector<FileState> states_of(const std::vector<std::string>& files) {
    std::vector<FileState> states;
    for (const std::string& file : files) {
        struct stat status {};
        if (::stat(file.c_str(), &status) != 0) status = {};
        states.emplace_back(status.st_ino, status.st_size, status.st_mtim.tv_sec,
                            status.st_mtim.tv_nsec);
    }
    return states;
}

/// Whether another scene may help.
bool concerns_scene(const Error& error) {
    const ExitCode code = error.exit_code();
    return code != ExitCode::usage && code != ExitCode::output && code != ExitCode::device;
}

/// Waits until `is_over`, or a file differs from `before` and has been left alone for a moment: an
/// editor may still be writing it.
void await_change(const std::vector<std::string>& files, const std::vector<FileState>& before,
                  const std::function<bool()>& is_over) {
    std::vector<FileState> last = before;
    while (stop_flag() == 0 && !is_over()) {
        std::this_thread::sleep_for(look_interval);
        std::vector<FileState> now = states_of(files);
        if (now != before && now == last && std::get<1>(now.front()) > 0) return;
        last = std::move(now);
    }
}

}  // namespace

int watch_scene(const std::string& scene, bool is_quiet, const std::function<int()>& render,
                const std::function<bool()>& is_over) {
    for (bool is_first = true; stop_flag() == 0 && !is_over(); is_first = false) {
        const FileState scene_before = states_of({scene}).front();
        const std::vector<std::string> files = scene_files(scene);
        std::vector<FileState> before = states_of(files);
        before.front() = scene_before;
        try {
            render();
            flush_results();
        } catch (const Error& error) {
            if (is_first && !concerns_scene(error)) throw;
            watch_worker("");
            print_error(error.what());
        }
        if (stop_flag() != 0 || is_over()) break;
        const bool was_quiet = stop_quietly(true);  // nothing is left to save
        if (!is_quiet) print_note("waiting for " + scene + " to change");
        await_change(files, before, is_over);
        stop_quietly(was_quiet);
    }
    return stop_flag() == 0 ? 0 : exit_code_of_stop(stop_flag());
}

}  // namespace rt
