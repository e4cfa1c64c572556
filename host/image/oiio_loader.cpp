// SPDX-License-Identifier: Apache-2.0
#include "host/image/oiio_loader.h"

#include <dlfcn.h>
#include <signal.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "host/image/picture_format.h"

#ifndef MIRRORBALL_MODULE_DIR
#define MIRRORBALL_MODULE_DIR ""
#endif

namespace rt {
namespace {

namespace fs = std::filesystem;

struct LoadResult {
    const oiio::Module* module = nullptr;
    std::string error;
};

/// Where the module may lie, in the order of trying.
std::vector<fs::path> candidates() {
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
    for (fs::path& directory : directories) directory /= "libmirrorball_oiio.so";
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

LoadResult load(const fs::path& file) {
    const std::string advice = "; install libopenimageio and mirrorball again, or use .pfm";
    // Never closed: OpenImageIO's own destructors run when the program ends.
    void* handle = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        const char* reason = ::dlerror();
        return {nullptr, std::string(reason == nullptr ? file.c_str() : reason) +
                             ": cannot load the image library" + advice};
    }
    const auto entry = reinterpret_cast<oiio::EntryPoint>(::dlsym(handle, oiio::entry_point_name));
    const oiio::Module* module = entry == nullptr ? nullptr : entry();
    if (module == nullptr || module->version != oiio::interface_version) {
        return {nullptr, file.string() + ": belongs to another version of mirrorball" + advice};
    }
    return {module, {}};
}

LoadResult find_and_load() {
    const SignalsBlocked blocked;
    std::string tried;
    for (const fs::path& file : candidates()) {
        std::error_code error;
        if (fs::exists(file, error)) return load(file);
        tried += (tried.empty() ? "" : ", ") + file.string();
    }
    return {nullptr, tried +
                         ": no such file, needed for every picture but .pfm; install "
                         "mirrorball again, or use .pfm"};
}

/// Loaded by whoever comes first; all others wait.
const LoadResult& loaded() {
    static const LoadResult result = find_and_load();
    return result;
}

}  // namespace

const oiio::Module& image_library(ExitCode failure) {
    const LoadResult& result = loaded();
    if (result.module == nullptr) throw Error(failure, result.error);
    return *result.module;
}

ImageLibraryLoading::~ImageLibraryLoading() {
    if (thread_.joinable()) thread_.join();
}

void ImageLibraryLoading::begin_for(const std::string& picture_path) {
    if (thread_.joinable() || picture_path.empty()) return;
    if (!needs_image_library(picture_format_of_name(picture_path))) return;
    try {
        thread_ = std::thread([] { loaded(); });
    } catch (const std::system_error&) {
        // No thread to be had: image_library loads it when it is asked for.
    }
}

}  // namespace rt
