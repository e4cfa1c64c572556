// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: whatever the bytes, the EXR reader returns as many values as it announced or
// throws, and takes no more memory than the file justifies.
// Build with clang++ -fsanitize=fuzzer,address,undefined; seeds: tests/pictures/.

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>

#include "host/image/modules/exr_reader.h"

namespace {

struct Counts {
    std::size_t announced = 0, received = 0;
};

int take_header(void* context, int width, int height, int channels) {
    static_cast<Counts*>(context)->announced = static_cast<std::size_t>(width) *
                                               static_cast<std::size_t>(height) *
                                               static_cast<std::size_t>(channels);
    return 1;
}

int take_attribute(void*, const char*, const char*) { return 1; }

int take_rows(void* context, const float*, std::size_t count) {
    static_cast<Counts*>(context)->received += count;
    return 1;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const int file = memfd_create("fuzz.exr", 0);
    static const std::string path = "/proc/self/fd/" + std::to_string(file);
    if (ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) {
        return 0;
    }
    Counts counts;
    const rt::module::PictureSink sink{&counts, take_header, take_attribute, take_rows};
    try {
        rt::module::decode_exr(path.c_str(), sink);
    } catch (const std::exception&) {
        return 0;
    }
    if (counts.announced != counts.received) __builtin_trap();
    return 0;
}
