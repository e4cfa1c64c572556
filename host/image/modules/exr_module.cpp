// SPDX-License-Identifier: Apache-2.0
#include "host/image/modules/exr_file.h"

extern "C" [[gnu::visibility("default")]] const void* mirrorball_module() {
    static constexpr rt::PictureModule module{rt::PictureModule::current_version, rt::encode_exr,
                                              rt::decode_exr};
    return &module;
}
