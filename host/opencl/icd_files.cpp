// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/icd_files.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "host/base/text.h"

namespace rt {

using Json = nlohmann::json;

/// What a child process says of a device; all but icd_file, which it cannot know.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ClDevice, index, platform_index, device_index, name, vendor,
                                   driver, version, platform, is_cpu, is_gpu, compute_units,
                                   float_lanes, double_lanes, memory_bytes, max_buffer_bytes,
                                   has_double, rounds_correctly, keeps_subnormals, unusable)

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

/// What a child process said, and how it ended.
struct ChildEnd {
    bool is_started = false;
    std::string answer;
    int status = 0;

    /// "crashes while loading (Aborted)".
    std::string how(const char* doing) const {
        if (!is_started) return "could not be started";
        if (!WIFSIGNALED(status)) {
            return fmt::format("ends the process while {} (exit code {})", doing,
                               WEXITSTATUS(status));
        }
        if (WTERMSIG(status) == SIGALRM) {
            return fmt::format("hangs: still {} after {} s", doing, most_seconds);
        }
        return fmt::format("crashes while {} ({})", doing, strsignal(WTERMSIG(status)));
    }
};

std::string answer_of(int pipe_end) {
    std::array<char, 512> text{};
    std::string answer;
    for (ssize_t count; (count = read(pipe_end, text.data(), text.size())) > 0;) {
        answer.append(text.data(), static_cast<std::size_t>(count));
    }
    return answer;
}

void say(int answer, const std::string& text) {
    for (std::size_t at = 0; at < text.size();) {
        const ssize_t written = write(answer, text.data() + at, text.size() - at);
        if (written <= 0) return;
        at += static_cast<std::size_t>(written);
    }
}

/// Runs `work`, which gets a descriptor for its answer, in a child process, for at most
/// `most_seconds`.
template <typename Work>
ChildEnd run_in_child(const Work& work) {
    ChildEnd end;
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) return end;
    const pid_t child = fork();
    if (child == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        std::signal(SIGALRM, SIG_DFL);
        alarm(most_seconds);
        const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
        work(ends[1]);
        _exit(0);
    }
    close(ends[1]);
    end.answer = child > 0 ? answer_of(ends[0]) : "";
    close(ends[0]);
    end.is_started = child > 0 && waitpid(child, &end.status, 0) == child;
    return end;
}

void load_and_list(const fs::path& file, const std::string& library, int answer) {
    void* const driver = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    // Every driver exports this, and the loader skips what does not (cl_khr_icd).
    if (driver == nullptr || dlsym(driver, "clGetExtensionFunctionAddress") == nullptr) {
        return say(answer, dlerror());
    }
    say(answer, {loaded});
    setenv("OCL_ICD_VENDORS", fs::absolute(file).c_str(), 1);
    std::vector<std::string> problems;
    list_cl_devices(problems);
    say(answer, {listed});
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
    const ChildEnd end = run_in_child([&](int answer) { load_and_list(file, library, answer); });
    if (!end.is_started) return {};
    const std::string& answer = end.answer;
    const bool is_loaded = !answer.empty() && answer.front() == loaded;
    if (WIFEXITED(end.status)) {
        if (!answer.empty() && answer.back() == listed) return {};
        if (!answer.empty() && !is_loaded) return {"cannot be loaded: " + answer};
    }
    return {end.how(is_loaded ? "listing its devices" : "loading"), true};
}

/// What the loader lists in a child process.
struct Listing {
    std::vector<ClDevice> devices;
    std::vector<std::string> problems;
    std::string failure;  ///< of the process; empty: none
};

/// `file`: the only driver; empty: those that the environment says.
Listing list_in_child(const std::string& file) {
    const ChildEnd end = run_in_child([&](int answer) {
        if (!file.empty()) setenv("OCL_ICD_VENDORS", file.c_str(), 1);
        std::vector<std::string> problems;
        const Json devices = list_cl_devices(problems);
        const Json json = Json::array({devices, problems});
        say(answer, json.dump(-1, ' ', false, Json::error_handler_t::replace));
    });
    Listing listing;
    const Json json = Json::parse(end.answer, nullptr, false);
    if (json.is_discarded()) {
        listing.failure = end.how("listing their devices");
        return listing;
    }
    json.at(0).get_to(listing.devices);
    json.at(1).get_to(listing.problems);
    return listing;
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

UsableIcdFiles::UsableIcdFiles(const IcdFiles& files)
    : leaves_out_(files.any_dangerous && !files.usable.empty() && !folder_.name().empty()) {
    for (std::size_t i = 0; i < files.usable.size() && !place().empty(); ++i) {
        std::error_code error;
        fs::create_symlink(fs::absolute(files.usable[i]), fmt::format("{}/{:04}.icd", place(), i),
                           error);
    }
}

std::vector<std::string> UsableIcdFiles::change() const {
    if (!leaves_out_) return {};
    return {"OCL_ICD_VENDORS=" + place()};
}

std::vector<ClDevice> list_devices_of(IcdFiles& files, const UsableIcdFiles& usable) {
    if (files.any_dangerous) setenv("OCL_ICD_VENDORS", usable.place().c_str(), 1);
    if (files.any_dangerous && (files.usable.empty() || usable.place().empty())) return {};
    Listing together = list_in_child("");
    std::vector<std::string>& problems = files.problems;
    if (together.failure.empty()) {
        problems.insert(problems.end(), together.problems.begin(), together.problems.end());
        return together.devices;
    }
    std::vector<ClDevice> devices;
    for (const std::string& file : files.usable) {
        const std::string place = fs::absolute(file).string();
        Listing alone = list_in_child(place);
        for (ClDevice& device : alone.devices) {
            device.icd_file = place;
            devices.push_back(std::move(device));
        }
        problems.insert(problems.end(), alone.problems.begin(), alone.problems.end());
        if (!alone.failure.empty()) problems.push_back(printable(place + ": " + alone.failure));
    }
    if (files.usable.size() > 1) {
        problems.push_back(printable(
            fmt::format("a process that loads the drivers of {} {}; choose one of them with "
                        "OCL_ICD_VENDORS",
                        fmt::join(files.usable, " and "), together.failure)));
    }
    return devices;
}

}  // namespace rt
