// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <thread>

#include "host/error.h"
#include "host/image/oiio_module.h"

namespace rt {

/// The image library, loaded on the first call, which takes 150 ms; while it loads, no thread can
/// be started and no other library loaded. It is libmirrorball_oiio.so, looked for
/// 1. in the directory of the executable,
/// 2. in the directories of MIRRORBALL_MODULE_DIR, a list separated by colons fixed when the
///    program was built; a relative one starts at the directory of the executable.
/// Throws Error(failure) naming the missing file.
const oiio::Module& image_library(ExitCode failure);

/// Loads the image library beside other work, in a thread of its own, so that image_library need
/// not wait as long later, or at all.
class ImageLibraryLoading {
   public:
    ImageLibraryLoading() = default;
    ImageLibraryLoading(const ImageLibraryLoading&) = delete;
    ImageLibraryLoading& operator=(const ImageLibraryLoading&) = delete;
    ~ImageLibraryLoading();

    /// Begins where a picture of this name needs the library; an empty name does not. Only the
    /// first call does anything. What goes wrong is for image_library to tell.
    void begin_for(const std::string& picture_path);

   private:
    std::thread thread_;
};

}  // namespace rt
