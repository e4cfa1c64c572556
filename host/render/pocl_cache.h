// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace rt {

/// PoCL's kernel cache on disk, watched to tell a cold build from a warm one: a build that had to
/// compile leaves new folders there.
class PoclCacheWatch {
   public:
    /// `folder` may be empty or missing.
    explicit PoclCacheWatch(std::filesystem::path folder);

    /// Whether anything was added to the cache since this watch was made.
    bool grew() const;

   private:
    std::filesystem::path folder_;
    std::filesystem::file_time_type newest_;
};

}  // namespace rt
