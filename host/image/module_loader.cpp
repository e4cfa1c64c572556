// SPDX-License-Identifier: Apache-2.0
#include "host/image/module_loader.h"

#include <dlfcn.h>
#include <signal.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#ifndef MIRRORBALL_MODULE_DIR
#define MIRRORBALL_MODULE_DIR ""
#endif

namespace rt {
namespace {

namespace fs = std::filesystem;

struct ModuleFile {
    const char* name;
    const char* advice;
};

constexpr ModuleFile exr_module{"libmirrorball_exr.so",
                                "install libopenexr and mirrorball again, or use .png or .pfm"};
constexpr ModuleFile openimageio_module{
    "libmirrorball_oiio.so",
    "install libopenimageio and mirrorball again, or use .png, .exr or .pfm"};

struct LoadResult {
    const module::Module* module = nullptr;
    std::string error;
};

/// Where a module may lie, in the order of trying.
std::vector<fs::path> candidates(const char* name) {
    std::error_code error;
    const fs::path home = fs::read_symlink("/proc/self/exe", error).parent_path();
    std::vector<fs::path> directories;
    if (!home.empty()) directories.push_back(home);
    std::string_view rest = MIRRORBALL_MODULE_DIR;
    while (!rest.empty()) {
        const std::size_t colon = rest.find(':');
        const fs::path directory = rest.substr(0, colon);
        rest = colon == rest.npos ? std::string_view() : rest.substr(colon + 1);
        if (!directory.empty()) directories.push_back(home / directory);
    }
    for (fs::path& directory : directories) directory /= name;
    return directories;
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

LoadResult load(const fs::path& file, const ModuleFile& wanted) {
    const std::string advice = std::string("; ") + wanted.advice;
    // Never closed: destructors of the libraries run when the program ends.
    void* handle = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        const char* reason = ::dlerror();
        return {nullptr, std::string(reason == nullptr ? file.c_str() : reason) +
                             ": cannot load the image library" + advice};
    }
    const auto entry =
        reinterpret_cast<module::EntryPoint>(::dlsym(handle, module::entry_point_name));
    const module::Module* found = entry == nullptr ? nullptr : entry();
    if (found == nullptr || found->version != module::interface_version) {
        return {nullptr, file.string() + ": belongs to a different version of mirrorball" + advice};
    }
    return {found, {}};
}

LoadResult find_and_load(const ModuleFile& wanted) {
    const SignalsBlocked blocked;
    std::string tried;
    for (const fs::path& file : candidates(wanted.name)) {
        std::error_code error;
        if (fs::exists(file, error)) return load(file, wanted);
        tried += (tried.empty() ? "" : ", ") + file.string();
    }
    return {nullptr, tried + ": no such file; " + wanted.advice};
}

/// OpenImageIO brings OpenBLAS along, which would start a thread for each core while it is loaded.
LoadResult find_and_load_openimageio() {
    ::setenv("OPENBLAS_NUM_THREADS", "1", 0);
    return find_and_load(openimageio_module);
}

/// Loaded by whoever comes first; all others wait.
const LoadResult& loaded_exr() {
    static const LoadResult result = find_and_load(exr_module);
    return result;
}

const LoadResult& loaded_openimageio() {
    static const LoadResult result = find_and_load_openimageio();
    return result;
}

}  // namespace

const module::Module& picture_module(PictureFormat format, ExitCode failure) {
    const LoadResult& result = format == PictureFormat::exr ? loaded_exr() : loaded_openimageio();
    if (result.module == nullptr) throw Error(failure, result.error);
    return *result.module;
}

}  // namespace rt
