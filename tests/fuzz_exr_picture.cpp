// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: whatever the bytes, the EXR reader returns as many values as it announced or
// throws, and takes no more memory than the file justifies.
// Build with clang++ -fsanitize=fuzzer,address,undefined; seeds: tests/pictures/.

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <exception>
#include <stdexcept>
#include <string>

#include "host/image/picture_module.h"

extern "C" const void* mirrorball_module();  // of exr_module.cpp

namespace {

/// As the program does, with a lower limit: sanitizers touch what is only reserved.
bool check_size(int width, int height, int channels) {
    if (std::int64_t{width} * height > (std::int64_t{1} << 26) / channels) {
        throw std::length_error("too many values");
    }
    return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const int file = memfd_create("fuzz.exr", 0);
    static const std::string path = "/proc/self/fd/" + std::to_string(file);
    if (ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) {
        return 0;
    }
    static const auto& exr = *static_cast<const rt::PictureModule*>(mirrorball_module());
    try {
        const rt::Picture picture = exr.decode(path, "", check_size).picture;
        const std::size_t values = static_cast<std::size_t>(picture.width) * picture.height *
                                   static_cast<std::size_t>(picture.channels);
        if (picture.pixels.size() != values) __builtin_trap();
    } catch (const std::exception&) {
    }
    return 0;
}
