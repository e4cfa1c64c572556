// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "host/base/error.h"

namespace rt {

/// One of the program's own modules: a shared library loaded on demand.
struct ModuleFile {
    const char* name;       ///< "libmirrorball_exr.so"
    std::uint32_t version;  ///< required of its interface, whose first member is its version
    std::string what;       ///< for messages: "the image library"
    std::string advice;     ///< what to do when it is missing
};

/// Loads a module, never unloads it, and returns its interface: what the one symbol that it
/// exports, mirrorball_module, returns. Throws Error(failure). It lies next to the executable, or
/// in the folder MIRRORBALL_MODULE_DIR, relative to the executable's, fixed when the program was
/// built.
const void* load_module(const ModuleFile& module, ExitCode failure);

}  // namespace rt
