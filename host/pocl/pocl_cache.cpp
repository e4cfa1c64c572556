// SPDX-License-Identifier: Apache-2.0
#include "host/pocl/pocl_cache.h"

#include <link.h>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace rt {

namespace {

namespace fs = std::filesystem;

struct Search {
    fs::file_time_type start;
    BuildCache found = BuildCache::unknown;
};

/// PoCL's place for a kernel: <kernel>/<local size and more>/<kernel>.so
bool is_kernel(const fs::path& library) {
    return library.extension() == ".so" &&
           library.stem() == library.parent_path().parent_path().filename();
}

int look_at(dl_phdr_info* info, std::size_t, void* data) {
    Search& search = *static_cast<Search*>(data);
    const fs::path library = info->dlpi_name;
    if (!is_kernel(library)) return 0;
    std::error_code error;
    const fs::file_time_type written = fs::last_write_time(library, error);
    if (error) return 0;
    search.found = written >= search.start ? BuildCache::cold : BuildCache::warm;
    return search.found == BuildCache::cold ? 1 : 0;
}

}  // namespace

fs::path pocl_cache_folder() {
    const char* const folder = getenv("POCL_CACHE_DIR");
    return folder == nullptr ? "/tmp/pocl/kcache" : folder;
}

bool pocl_keeps_kernels() {
    const char* const wanted = getenv("POCL_KERNEL_CACHE");
    return wanted == nullptr || *wanted == '1';
}

std::string why_pocl_cache_is_read_only() {
    const fs::path folder = pocl_cache_folder();
    std::string probe = folder / "mirrorball-XXXXXX";
    const int file = mkstemp(probe.data());
    if (file < 0) return folder.string() + ": " + std::strerror(errno);
    close(file);
    unlink(probe.c_str());
    return "";
}

BuildCache pocl_build_since(std::filesystem::file_time_type start) {
    Search search{start};
    dl_iterate_phdr(look_at, &search);
    return search.found;
}

}  // namespace rt
