// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace rt {

/// The type of the one symbol that a module exports. It returns the module's interface.
using ModuleEntryPoint = const void* (*)();

/// One of the program's own modules: a shared library loaded on demand.
struct ModuleFile {
    const char* name;         ///< "libmirrorball_exr.so"
    const char* entry_point;  ///< its ModuleEntryPoint
    std::uint32_t version;    ///< required of its interface, whose first member is its version
    std::string what;         ///< for messages: "the image library"
    std::string advice;       ///< what to do when it is missing
};

/// A module's interface, or why it could not be loaded.
struct LoadedModule {
    const void* interface = nullptr;
    std::string error;
};

/// Loads a module and never unloads it. It is looked for
/// 1. in the directory of the executable,
/// 2. in the directories of MIRRORBALL_MODULE_DIR, a list separated by colons fixed when the
///    program was built; a relative one starts at the directory of the executable.
LoadedModule load_module(const ModuleFile& module);

}  // namespace rt
