// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/cli/render_steps.h"
#include "host/process/stop_signal.h"
#include "host/process/worker.h"
#include "host/scene/json_document.h"
#include "host/scene/line_scanner.h"
#include "host/scene/model.h"
#include "host/scene/text_file.h"

namespace rt {

namespace {

using Names = std::vector<std::string>;

/// The names that `find` sees in a file's text, relative to where the program runs; none if that
/// cannot be read.
template <typename Find>
Names names_in(const std::string& file, const Find& find) {
    Names names;
    try {
        const FileText text = read_text_file(file, max_model_bytes);
        const std::filesystem::path folder = std::filesystem::path(file).parent_path();
        for (const std::string& name : find(text.view())) names.push_back((folder / name).string());
    } catch (const Error&) {
    }
    return names;
}

/// What mtllib statements name: names may hold blanks, or be several.
Names libraries_in(std::string_view model) {
    Names names;
    for (LineScanner at(model); at.find_word(); at.next_line()) {
        if (at.word() != "mtllib" || !at.word_follows()) continue;
        const std::string_view all = at.rest();
        names.emplace_back(all);
        for (LineScanner words(all); words.word_follows();) names.emplace_back(words.word());
    }
    return names;
}

const JsonValue& member(const JsonValue& value, std::string_view key) {
    static const JsonValue none;
    const auto* const object = value.as<JsonValue::Object>();
    if (object == nullptr) return none;
    const auto found = std::ranges::find(*object, key, &JsonMember::key);
    return found == object->end() ? none : found->value;
}

Names models_in(std::string_view scene) {
    Names names;
    Mistakes mistakes(scene, "");
    const JsonValue root = parse_json(mistakes);
    const auto* const meshes = member(root, "meshes").as<JsonValue::Array>();
    if (meshes == nullptr) return names;
    for (const JsonValue& mesh : *meshes) {
        const auto* const name = member(mesh, "file").as<std::string>();
        if (name != nullptr) names.push_back(*name);
    }
    return names;
}

/// The scene's file, first, and all that it names: models and their material libraries, whether
/// they are there and right or not. Without models while the scene's own text is wrong.
std::vector<std::string> scene_files(const std::string& scene) {
    Names files{scene};
    if (!is_obj_name(scene) && !is_ply_name(scene)) {
        for (const std::string& model : names_in(scene, models_in)) files.push_back(model);
    }
    for (std::size_t i = 0, count = files.size(); i < count; ++i) {
        if (!is_obj_name(files[i])) continue;
        for (const std::string& library : names_in(files[i], libraries_in)) {
            files.push_back(library);
        }
    }
    return files;
}

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
