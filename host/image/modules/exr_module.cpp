// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include "host/image/module_guard.h"
#include "host/image/modules/exr_reader.h"
#include "host/image/modules/exr_writer.h"

namespace rt::module {
namespace {

int encode(const EncodeRequest* request, const ByteSink* sink, ErrorText error) {
    return guarded(error, [&] { return encode_exr(*request, *sink); });
}

int decode(const char* path, const char* /*format*/, const PictureSink* sink, ErrorText error) {
    return guarded(error, [&] { return decode_exr(path, *sink); });
}

}  // namespace
}  // namespace rt::module

extern "C" __attribute__((visibility("default"))) const void* mirrorball_picture_module() {
    static constexpr rt::module::Module module{rt::module::interface_version, rt::module::encode,
                                               rt::module::decode};
    return &module;
}
