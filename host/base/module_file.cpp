// SPDX-License-Identifier: Apache-2.0
#include "host/base/module_file.h"

#include <dlfcn.h>
#include <signal.h>

#include <filesystem>
#include <ranges>
#include <string_view>
#include <system_error>
#include <vector>

#include "host/base/files.h"

#ifndef MIRRORBALL_MODULE_DIR
#define MIRRORBALL_MODULE_DIR ""
#endif

namespace rt {
namespace {

namespace fs = std::filesystem;

/// Paths to try for a module, in order.
std::vector<fs::path> candidates(const char* name) {
    const fs::path home = program_file().parent_path();
    std::vector<fs::path> files;
    if (!home.empty()) files.push_back(home / name);
    for (const auto& part : std::views::split(std::string_view(MIRRORBALL_MODULE_DIR), ':')) {
        const std::string_view directory(part.begin(), part.end());
        if (!directory.empty()) files.push_back(home / directory / name);
    }
    return files;
}

/// Blocks all signals of this thread for its lifetime. The libraries start idle threads of their
/// own while they are loaded; these inherit the mask and never run the program's handlers.
class SignalsBlocked {
   public:
    SignalsBlocked() {
        sigset_t all;
        ::sigfillset(&all);
        ::pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    SignalsBlocked(const SignalsBlocked&) = delete;
    SignalsBlocked& operator=(const SignalsBlocked&) = delete;
    ~SignalsBlocked() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

   private:
    sigset_t before_;
};

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
    const SignalsBlocked blocked;
    std::string tried;
    for (const fs::path& file : candidates(module.name)) {
        std::error_code error;
        if (fs::exists(file, error)) return load_file(file, module, failure);
        tried += (tried.empty() ? "" : ", ") + file.string();
    }
    throw Error(failure, tried + ": no such file; " + module.advice);
}

}  // namespace rt
