// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/icd_files.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace rt {

namespace {

namespace fs = std::filesystem;

constexpr unsigned most_seconds = 10;

std::vector<fs::path> icd_files(const std::string& place) {
    std::error_code error;
    std::vector<fs::path> files;
    if (fs::is_regular_file(place, error)) return {place};
    for (fs::directory_iterator file(place, error), end; !error && file != end;
         file.increment(error)) {
        if (file->path().extension() == ".icd") files.push_back(file->path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

/// The first line: the driver's library.
std::string library_of(const fs::path& file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    const auto end = line.find_last_not_of(" \t\r");
    return end == std::string::npos ? "" : line.substr(0, end + 1);
}

[[noreturn]] void load_in_child(const std::string& library, int answer) {
    alarm(most_seconds);
    const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    if (dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL) != nullptr) _exit(0);
    const char* const why = dlerror();
    [[maybe_unused]] const ssize_t ignored = write(answer, why, std::strlen(why));
    _exit(1);
}

std::string answer_of(int pipe_end) {
    std::array<char, 512> text{};
    std::string answer;
    for (ssize_t count; (count = read(pipe_end, text.data(), text.size())) > 0;) {
        answer.append(text.data(), static_cast<std::size_t>(count));
    }
    return answer;
}

/// Why a library cannot be loaded; empty where it can, or where that cannot be tried.
std::string why_not_loaded(const std::string& library) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) return "";
    const pid_t child = fork();
    if (child == 0) load_in_child(library, ends[1]);
    close(ends[1]);
    std::string why = child > 0 ? answer_of(ends[0]) : "";
    close(ends[0]);
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child) return "";
    if (!WIFSIGNALED(status)) return why;
    if (WTERMSIG(status) == SIGALRM) return fmt::format("still loading after {} s", most_seconds);
    return fmt::format("it crashes while loading ({})", strsignal(WTERMSIG(status)));
}

}  // namespace

std::vector<std::string> broken_icd_files(const std::string& place) {
    std::vector<std::string> lines;
    for (const fs::path& file : icd_files(place)) {
        const std::string library = library_of(file);
        const std::string why = library.empty() ? "it names no library" : why_not_loaded(library);
        if (why.empty()) continue;
        lines.push_back(
            fmt::format("{}: its driver cannot be loaded: {}; reinstall the driver or "
                        "remove the file",
                        file.string(), why));
    }
    return lines;
}

}  // namespace rt
