// SPDX-License-Identifier: Apache-2.0
#include "host/render/pocl_cache.h"

#include <algorithm>
#include <system_error>

namespace rt {

namespace {

namespace fs = std::filesystem;

/// The last time a folder beneath `folder`, down to `depth` levels, gained or lost an entry. Not
/// `folder` itself, where PoCL makes temporary files in every run; kernels go to
/// <2 hex digits>/<rest of the hash>/<kernel>/<local size>/.
fs::file_time_type newest_change(const fs::path& folder, int depth) {
    fs::file_time_type newest = fs::file_time_type::min();
    if (depth == 0) return newest;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        std::error_code ignored;
        if (!entry->is_directory(ignored)) continue;
        newest = std::max(newest, fs::last_write_time(entry->path(), ignored));
        newest = std::max(newest, newest_change(entry->path(), depth - 1));
    }
    return newest;
}

constexpr int kernel_folder_depth = 4;

}  // namespace

PoclCacheWatch::PoclCacheWatch(fs::path folder)
    : folder_(std::move(folder)), newest_(newest_change(folder_, kernel_folder_depth)) {}

bool PoclCacheWatch::grew() const { return newest_change(folder_, kernel_folder_depth) > newest_; }

}  // namespace rt
