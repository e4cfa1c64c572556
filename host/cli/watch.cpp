// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <thread>
#include <tuple>
#include <utility>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/cli/render_steps.h"
#include "host/process/stop_signal.h"
#include "host/process/worker.h"
#include "host/scene/text_file.h"

namespace rt {

namespace {

constexpr std::chrono::milliseconds look_interval(100);

FileStates states_of(FileStates files) {
    for (auto& [file, state] : files) state = state_of(file);
    return files;
}

/// Whether another scene may help.
bool concerns_scene(const Error& error) {
    const ExitCode code = error.exit_code();
    return code != ExitCode::usage && code != ExitCode::output && code != ExitCode::device;
}

/// Waits until `is_over`, or a file differs from `before` and has been left alone for a moment: an
/// editor may still be writing it.
void await_change(const std::string& scene, const FileStates& before,
                  const std::function<bool()>& is_over) {
    FileStates last = before;
    while (stop_flag() == 0 && !is_over()) {
        std::this_thread::sleep_for(look_interval);
        FileStates now = states_of(last);
        if (now != before && now == last && std::get<1>(now.at(scene)) > 0) return;
        last = std::move(now);
    }
}

}  // namespace

int watch_scene(const std::string& scene, bool is_quiet, const std::function<int()>& render,
                const std::function<bool()>& is_over) {
    FileStates files{{scene, {}}};
    for (bool is_first = true; stop_flag() == 0 && !is_over(); is_first = false) {
        files = states_of(files);
        take_asked_files();
        try {
            render();
            flush_results();
        } catch (const Error& error) {
            if (is_first && !concerns_scene(error)) throw;
            watch_worker("");
            print_error(error.what());
        }
        if (stop_flag() != 0 || is_over()) break;
        if (FileStates asked = take_asked_files(); asked.contains(scene)) files = std::move(asked);
        const bool was_quiet = stop_quietly(true);  // nothing is left to save
        if (!is_quiet) print_note("waiting for " + scene + " to change");
        await_change(scene, files, is_over);
        stop_quietly(was_quiet);
    }
    return stop_flag() == 0 ? 0 : exit_code_of_stop(stop_flag());
}

}  // namespace rt
