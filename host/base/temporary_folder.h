// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/base/file_descriptor.h"

namespace rt {

/// An empty folder, deleted with its files on destruction; has no name if it could not be created.
/// It is locked as long as its process lives. Folders that killed processes of this user left are
/// deleted by the next one, an hour later.
class TemporaryFolder {
   public:
    TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder();

    const std::string& name() const { return name_; }

   private:
    std::string name_;
    FileDescriptor lock_;
};

}  // namespace rt
