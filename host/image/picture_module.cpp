// SPDX-License-Identifier: Apache-2.0
#include "host/image/picture_module.h"

#include <cstdlib>

#include "host/base/module_file.h"

namespace rt {
namespace {

const PictureModule& load(const char* name, const char* advice, ExitCode failure) {
    return *static_cast<const PictureModule*>(
        load_module({name, PictureModule::current_version, "the image library", advice}, failure));
}

/// OpenImageIO pulls in OpenBLAS, which would start a thread per core on loading.
const PictureModule& load_openimageio(ExitCode failure) {
    ::setenv("OPENBLAS_NUM_THREADS", "1", 0);
    return load("libmirrorball_oiio.so",
                "reinstall libopenimageio2.4 and mirrorball, or use .png, .exr or .pfm", failure);
}

}  // namespace

const PictureModule& picture_module(PictureFormat format, ExitCode failure) {
    if (format == PictureFormat::exr) {
        static const PictureModule& exr =
            load("libmirrorball_exr.so",
                 "reinstall libopenexr-3-1-30 and mirrorball, or use .png or .pfm", failure);
        return exr;
    }
    static const PictureModule& others = load_openimageio(failure);
    return others;
}

}  // namespace rt
