// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/icd_files.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "host/printable.h"

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

/// The first line: the driver's library. Of a regular file: others may never end.
std::string library_of(const fs::path& file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    const auto end = line.find_last_not_of(" \t\r");
    return end == std::string::npos ? "" : line.substr(0, end + 1);
}

// What a child process reports at each step.
constexpr char loaded = '\1', listed = '\2';

[[noreturn]] void try_in_child(const fs::path& file, const std::string& library, int answer) {
    const auto say = [&](const char* text, std::size_t length) {
        [[maybe_unused]] const ssize_t ignored = write(answer, text, length);
    };
    std::signal(SIGALRM, SIG_DFL);
    alarm(most_seconds);
    const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    void* const driver = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    // Every driver exports this, and the loader skips what does not (cl_khr_icd).
    if (driver == nullptr || dlsym(driver, "clGetExtensionFunctionAddress") == nullptr) {
        const char* const why = dlerror();
        say(why, std::strlen(why));
        _exit(0);
    }
    say(&loaded, 1);
    setenv("OCL_ICD_VENDORS", fs::absolute(file).c_str(), 1);
    std::vector<std::string> problems;
    list_cl_devices(problems);
    say(&listed, 1);
    _exit(0);
}

std::string answer_of(int pipe_end) {
    std::array<char, 512> text{};
    std::string answer;
    for (ssize_t count; (count = read(pipe_end, text.data(), text.size())) > 0;) {
        answer.append(text.data(), static_cast<std::size_t>(count));
    }
    return answer;
}

struct Attempt {
    std::string problem;  ///< empty if there is none, or if it cannot be tried
    bool is_dangerous = false;
};

Attempt try_driver(const fs::path& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return {"cannot be loaded: it is not a file", true};
    const std::string library = library_of(file);
    if (library.empty()) return {"cannot be loaded: it names no library"};
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) return {};
    const pid_t child = fork();
    if (child == 0) try_in_child(file, library, ends[1]);
    close(ends[1]);
    const std::string answer = child > 0 ? answer_of(ends[0]) : "";
    close(ends[0]);
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child) return {};
    const bool is_loaded = !answer.empty() && answer.front() == loaded;
    const char* const doing = is_loaded ? "listing its devices" : "loading";
    if (WIFSIGNALED(status)) {
        if (WTERMSIG(status) == SIGALRM) {
            return {fmt::format("hangs: still {} after {} s", doing, most_seconds), true};
        }
        return {fmt::format("crashes while {} ({})", doing, strsignal(WTERMSIG(status))), true};
    }
    if (!answer.empty() && answer.back() == listed) return {};
    if (!answer.empty() && !is_loaded) return {"cannot be loaded: " + answer};
    return {fmt::format("ends the process while {} (exit code {})", doing, WEXITSTATUS(status)),
            true};
}

}  // namespace

IcdFiles try_icd_files(const std::string& place) {
    IcdFiles files;
    for (const fs::path& file : icd_files(place)) {
        const Attempt attempt = try_driver(file);
        if (attempt.problem.empty()) {
            files.usable.push_back(file.string());
            continue;
        }
        files.any_dangerous |= attempt.is_dangerous;
        files.problems.push_back(
            printable(fmt::format("{}: its driver {}; reinstall the driver or remove the file",
                                  file.string(), attempt.problem)));
    }
    return files;
}

UsableIcdFiles::UsableIcdFiles(const IcdFiles& files) {
    for (std::size_t i = 0; i < files.usable.size() && !place().empty(); ++i) {
        std::error_code error;
        fs::create_symlink(fs::absolute(files.usable[i]), fmt::format("{}/{:04}.icd", place(), i),
                           error);
    }
}

std::vector<ClDevice> list_devices_of(IcdFiles& files, const UsableIcdFiles& usable) {
    if (files.any_dangerous) setenv("OCL_ICD_VENDORS", usable.place().c_str(), 1);
    if (files.any_dangerous && (files.usable.empty() || usable.place().empty())) return {};
    return list_cl_devices(files.problems);
}

}  // namespace rt
