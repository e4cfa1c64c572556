// SPDX-License-Identifier: Apache-2.0
#include "host/cli/result_file.h"

#include <filesystem>
#include <fstream>
#include <span>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/image/atomic_file.h"
#include "host/image/output_path.h"

namespace rt {

void check_result_path(const std::string& path, const std::string& first_bytes) {
    if (path.empty() || path == "-") return;
    check_output_path(path);
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return;
    std::ifstream file(path, std::ios::binary);
    std::string start(first_bytes.size(), ' ');
    file.read(start.data(), static_cast<std::streamsize>(start.size()));
    if (file.gcount() == 0 || start == first_bytes) return;
    throw Error(ExitCode::usage,
                path + ": already exists and is not such a result file; choose another name");
}

void write_result(const std::string& path, const std::function<std::string()>& text) {
    const std::string result = path.empty() ? "" : text();
    if (result.empty()) return;
    if (path == "-") return print_result(result);
    write_file_atomically(path, std::as_bytes(std::span(result)));
}

void check_stdout_has_one_use(const std::vector<std::array<std::string, 2>>& results) {
    std::string user;
    for (const auto& [option, path] : results) {
        if (path != "-") continue;
        if (!user.empty()) {
            usage_error("{} and {} cannot both write to stdout; send one to a file", user, option);
        }
        user = option;
    }
}

}  // namespace rt
