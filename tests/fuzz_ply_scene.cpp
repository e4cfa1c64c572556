// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: whatever the bytes, the PLY reader returns a model that can be rendered, or
// throws rt::Error. Build with clang++ -fsanitize=fuzzer,address,undefined; seeds: tests/models/
// and tests/scenes_bad/.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "host/scene/model.h"
#include "tests/fuzz_model.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    rt::fuzz::try_model([&] { return rt::parse_ply(text, "fuzz.ply", {1, 40}); });
    return 0;
}
