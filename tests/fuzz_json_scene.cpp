// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: whatever the bytes, the scene reader returns a scene or throws rt::Error, and
// the positions it gives to JSON values are where such values stand.
// Build with clang++ -fsanitize=fuzzer,address,undefined; seeds: scenes/ and tests/scenes_bad/.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "host/base/error.h"
#include "host/scene/json_document.h"
#include "host/scene/mistakes.h"
#include "host/scene/scene_file.h"
#include "tests/fuzz_model.h"

namespace {

using rt::fuzz::require;

/// Every value's offset points at a character that starts such a value.
void check_offsets(const rt::JsonValue& value, std::string_view text) {
    constexpr std::string_view first_characters[] = {"n", "tf", "-0123456789", "\"", "[", "{"};
    require(value.offset < text.size());
    require(first_characters[value.data.index()].find(text[value.offset]) != text.npos);
    if (const auto* items = value.as<rt::JsonValue::Array>()) {
        for (const rt::JsonValue& item : *items) check_offsets(item, text);
    }
    if (const auto* members = value.as<rt::JsonValue::Object>()) {
        for (const rt::JsonMember& member : *members) {
            require(text[member.key_offset] == '"' && member.key_offset < member.value.offset);
            check_offsets(member.value, text);
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
        rt::Mistakes mistakes(text, "fuzz.json");
        const rt::JsonValue root = rt::parse_json(mistakes);
        check_offsets(root, text);
        const rt::Scene scene = rt::parse_json_scene(text, "fuzz.json");
        rt::fuzz::check_scene(scene);
        const rt::Scene::Window& window = scene.camera.window;
        require(std::isfinite(window.right - window.left));
        require(std::isfinite(window.top - window.bottom));
        require(scene.width >= 1 && scene.height >= 1);
    } catch (const rt::Error& error) {
        require(error.exit_code() == rt::ExitCode::input ||
                error.exit_code() == rt::ExitCode::limit);
        require(std::string_view(error.what()).starts_with("fuzz.json:"));
    }
    return 0;
}
