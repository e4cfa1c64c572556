// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/scene_files.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "host/base/error.h"
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

}  // namespace

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

}  // namespace rt
