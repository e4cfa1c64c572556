// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: whatever the bytes, the OBJ and MTL readers return a model that can be
// rendered, or throw rt::Error. What follows a line "# library" is the text of every library.
// Build with clang++ -fsanitize=fuzzer,address,undefined; seeds: tests/models/ and
// tests/scenes_bad/.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "host/scene/model.h"
#include "tests/fuzz_model.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    constexpr std::string_view mark = "\n# library\n";
    const std::size_t end = std::min(text.find(mark), text.size());
    const std::string library(text.substr(std::min(end + mark.size(), text.size())));
    const auto open = [&](const std::string& name) {
        if (name.size() > 8) return rt::LibraryFile{{}, {}, "no such file"};
        return rt::LibraryFile{"fuzz.mtl", library, {}};
    };
    rt::fuzz::try_model([&] {
        return rt::parse_obj(text.substr(0, end), "fuzz.obj", open, {1, 40});
    });
    return 0;
}
