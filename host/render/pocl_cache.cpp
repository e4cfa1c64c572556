// SPDX-License-Identifier: Apache-2.0
#include "host/render/pocl_cache.h"

#include <link.h>

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

BuildCache pocl_build_since(std::filesystem::file_time_type start) {
    Search search{start};
    dl_iterate_phdr(look_at, &search);
    return search.found;
}

}  // namespace rt
