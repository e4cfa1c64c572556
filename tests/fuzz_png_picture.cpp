// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: whatever the bytes, the PNG reader returns a picture of its size or throws
// rt::Error. Build with clang++ -fsanitize=fuzzer,address,undefined; seeds: tests/pictures/.

#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>

#include "host/base/error.h"
#include "host/image/built_in_formats.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
    try {
        const rt::Picture picture = rt::read_png("fuzz.png", stream, true).picture;
        const std::size_t values = static_cast<std::size_t>(picture.width) * picture.height *
                                   static_cast<std::size_t>(picture.channels);
        if (picture.pixels.size() != values) __builtin_trap();
    } catch (const rt::Error&) {
    }
    return 0;
}
