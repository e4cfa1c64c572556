// SPDX-License-Identifier: Apache-2.0
#include "host/base/files.h"

#include <dlfcn.h>
#include <stdlib.h>

#include <system_error>

#ifndef MIRRORBALL_MODULE_DIR
#define MIRRORBALL_MODULE_DIR ""
#endif

namespace rt {

namespace fs = std::filesystem;

fs::path program_file() {
    std::error_code error;
    return fs::read_symlink("/proc/self/exe", error);
}

fs::path beside_program(std::initializer_list<const char*> folders, const char* file) {
    std::error_code error;
    for (const char* folder : folders) {
        const fs::path place = (program_file().parent_path() / folder).lexically_normal();
        if (fs::exists(place / file, error)) return place;
    }
    return {};
}

TemporaryFolder::TemporaryFolder() {
    std::error_code error;
    std::string name = fs::temp_directory_path(error) / "mirrorball.tmp.XXXXXX";
    if (::mkdtemp(name.data()) != nullptr) name_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code error;
    if (!name_.empty()) fs::remove_all(name_, error);
}

namespace {

const void* load_file(const fs::path& file, const ModuleFile& wanted, ExitCode failure) {
    // Never closed: destructors of the libraries run when the program ends.
    void* handle = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        const char* reason = ::dlerror();
        throw Error(failure, (reason == nullptr ? file.string() : reason) +
                                 (": cannot load " + wanted.what) + "; " + wanted.advice);
    }
    const auto entry = reinterpret_cast<const void* (*)()>(::dlsym(handle, "mirrorball_module"));
    const void* interface = entry == nullptr ? nullptr : entry();
    if (interface != nullptr && *static_cast<const std::uint32_t*>(interface) == wanted.version) {
        return interface;
    }
    throw Error(failure,
                file.string() + ": belongs to a different version of mirrorball; " + wanted.advice);
}

}  // namespace

const void* load_module(const ModuleFile& module, ExitCode failure) {
    const fs::path folder = beside_program({".", MIRRORBALL_MODULE_DIR}, module.name);
    if (!folder.empty()) return load_file(folder / module.name, module, failure);
    const fs::path last = program_file().parent_path() / MIRRORBALL_MODULE_DIR / module.name;
    throw Error(failure, last.lexically_normal().string() + ": no such file; " + module.advice);
}

}  // namespace rt
