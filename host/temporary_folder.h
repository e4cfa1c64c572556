// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>
#include <system_error>

namespace rt {

/// An empty folder, deleted with its files on destruction; has no name if it could not be created.
class TemporaryFolder {
   public:
    TemporaryFolder() {
        std::error_code error;
        std::string name =
            (std::filesystem::temp_directory_path(error) / "mirrorball-XXXXXX").string();
        if (::mkdtemp(name.data()) != nullptr) name_ = name;
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code error;
        if (!name_.empty()) std::filesystem::remove_all(name_, error);
    }

    const std::string& name() const { return name_; }

   private:
    std::string name_;
};

}  // namespace rt
