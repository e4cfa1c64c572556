// SPDX-License-Identifier: Apache-2.0
#include "host/base/files.h"

#include <stdlib.h>

#include <system_error>

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

}  // namespace rt
