// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: whatever the bytes, the NFF reader returns a scene or throws rt::Error, and a
// scene can be flattened and rendered on a thread.
// Build with clang++ -fsanitize=fuzzer,address,undefined; seeds: tests/scenes_nff/.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "host/scene/scene_file.h"
#include "tests/fuzz_model.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    bool is_read = false;
    try {
        const rt::Scene scene = rt::parse_nff_scene(text, "fuzz.nff");
        is_read = true;
        rt::fuzz::check_scene(scene);
        rt::fuzz::render(scene);
    } catch (const rt::Error& error) {
        rt::fuzz::require(error.exit_code() == rt::ExitCode::input ||
                          error.exit_code() == rt::ExitCode::limit);
        rt::fuzz::require(is_read || std::string_view(error.what()).starts_with("fuzz.nff:"));
    }
    return 0;
}
