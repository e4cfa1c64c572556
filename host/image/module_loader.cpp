// SPDX-License-Identifier: Apache-2.0
#include "host/image/module_loader.h"

#include <cstdlib>
#include <string>

#include "host/module_file.h"

namespace rt {
namespace {

LoadedModule load(const char* name, const char* advice) {
    return load_module(
        {name, module::entry_point_name, module::interface_version, "the image library", advice});
}

/// OpenImageIO pulls in OpenBLAS, which would start a thread per core on loading.
LoadedModule load_openimageio() {
    ::setenv("OPENBLAS_NUM_THREADS", "1", 0);
    return load("libmirrorball_oiio.so",
                "install libopenimageio2.4 and mirrorball again, or use .png, .exr or .pfm");
}

/// Loaded by the first caller; others wait.
const LoadedModule& loaded_exr() {
    static const LoadedModule result =
        load("libmirrorball_exr.so",
             "install libopenexr-3-1-30 and mirrorball again, or use .png or .pfm");
    return result;
}

const LoadedModule& loaded_openimageio() {
    static const LoadedModule result = load_openimageio();
    return result;
}

}  // namespace

const module::Module& picture_module(PictureFormat format, ExitCode failure) {
    const LoadedModule& result = format == PictureFormat::exr ? loaded_exr() : loaded_openimageio();
    if (result.interface == nullptr) throw Error(failure, result.error);
    return *static_cast<const module::Module*>(result.interface);
}

}  // namespace rt
