// SPDX-License-Identifier: Apache-2.0
#include "host/process/drivers.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <system_error>

#include "host/base/console.h"
#include "host/base/parallel.h"
#include "host/base/text.h"
#include "host/record/record.h"

namespace rt {

namespace {

namespace fs = std::filesystem;

/// Loading and listing may never end, but many GPUs take seconds each to start.
constexpr double most_deadlines = 6;

constexpr const char* library_folders =
    "/usr/lib/x86_64-linux-gnu:/usr/lib/x86_64-linux-gnu/intel-opencl:/usr/lib64:/usr/lib:"
    "/usr/local/lib:/usr/local/nvidia/lib64:/usr/lib/wsl/lib:/opt/rocm/lib";

/// In the loader's order. Reading what is no regular file might never end.
std::vector<std::string> icd_files(const std::string& place) {
    std::error_code error;
    std::vector<std::string> files;
    const auto add = [&](const fs::path& file) {
        std::error_code ignored;
        if (file.extension() != ".icd" || !fs::is_regular_file(file, ignored)) return;
        files.push_back(fs::absolute(file));
    };
    add(place);
    for (fs::directory_iterator file(place, error), end; !error && file != end;
         file.increment(error)) {
        add(file->path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

/// The first line: the driver's library.
std::string library_of(const std::string& file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    const auto end = line.find_last_not_of(" \t\r");
    return end == std::string::npos ? "" : line.substr(0, end + 1);
}

/// Why the loader skips a file's driver; empty if it does not.
std::string why_skipped(const std::string& file) {
    const std::string library = library_of(file);
    if (library.empty()) return "it names no library";
    void* const driver = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    // Every driver exports this (cl_khr_icd).
    const bool is_driver =
        driver != nullptr && dlsym(driver, "clGetExtensionFunctionAddress") != nullptr;
    return is_driver ? "" : dlerror();
}

constexpr const char* cannot_be_loaded = "cannot be loaded: ";

std::string problem_of(const std::string& file, const std::string& what) {
    return printable(
        fmt::format("{}: its driver {}; reinstall the driver or remove the file", file, what));
}

/// What a worker listed.
struct Listing {
    bool is_started = true;
    std::string failure;  ///< how it ended; empty: as it should
    Json answer;          ///< "skipped": pairs of a file and why; "devices"; "problems"
};

/// `drivers`: a folder of .icd files; empty: those of the environment.
Listing list_in_worker(const std::string& drivers, double deadline) {
    const WorkerEnd end =
        run_worker({{"mirrorball", "devices"}, drivers, deadline, 0, most_deadlines * deadline});
    end_if_stopped(end);
    if (end.is_regular && !end.records.empty()) return {true, "", Json::parse(end.records.front())};
    const std::string how =
        end.is_regular ? fmt::format("ended with exit code {}", end.status) : end.how;
    return {end.is_started, how + (end.task.empty() ? "" : " while " + end.task), {}};
}

/// Lists the devices of these drivers by a folder of links to their files: Khronos' loader looks
/// for drivers in folders only.
Listing list_linked(const std::vector<std::string>& files, const TemporaryFolder& folder,
                    double deadline) {
    std::error_code error;
    for (std::size_t i = 0; i < files.size() && !folder.name().empty(); ++i) {
        fs::create_symlink(files[i], fmt::format("{}/{:04}.icd", folder.name(), i), error);
    }
    if (error || folder.name().empty()) return {false, "has no temporary folder", {}};
    return list_in_worker(folder.name(), deadline);
}

/// Leaves out drivers that fail in a worker of their own; an only one has failed already, in this
/// listing.
void leave_out_failing(Drivers& drivers, const Listing& together, double deadline) {
    const bool is_only = drivers.files.size() == 1;
    std::erase_if(drivers.files, [&](const std::string& file) {
        const Listing alone = is_only ? together : list_linked({file}, {}, deadline);
        if (!alone.is_started) return false;
        std::string failure = alone.failure;
        if (failure.empty() && !alone.answer.at("skipped").empty()) {
            failure = cannot_be_loaded + alone.answer.at("skipped").front().get<std::string>();
        }
        if (!failure.empty()) drivers.bad_files.push_back(problem_of(file, failure));
        return !failure.empty();
    });
}

void add(Drivers& drivers, const Json& answer) {
    for (const auto& [file, why] : answer.at("skipped").get<std::map<std::string, std::string>>()) {
        drivers.bad_files.push_back(problem_of(file, cannot_be_loaded + why));
        std::erase(drivers.files, file);
    }
    read_json(answer.at("devices"), drivers.devices);
    for (const Json& problem : answer.at("problems")) drivers.problems.push_back(problem);
}

}  // namespace

Drivers list_drivers(const std::string& place, double deadline) {
    Drivers drivers;
    drivers.files = icd_files(place);
    Listing listing = list_in_worker("", deadline);
    if (listing.is_started && !listing.failure.empty()) {
        leave_out_failing(drivers, listing, deadline);
        if (drivers.files.empty()) return drivers;
        if (!drivers.bad_files.empty()) {
            drivers.folder = std::make_unique<TemporaryFolder>();
            listing = list_linked(drivers.files, *drivers.folder, deadline);
            if (listing.is_started) drivers.place = drivers.folder->name();
        }
    }
    if (listing.failure.empty()) {
        add(drivers, listing.answer);
    } else {
        const bool may_choose = listing.is_started && drivers.files.size() > 1;
        drivers.problems.push_back(printable(fmt::format(
            "a process that loads {} {}{}", fmt::join(drivers.files, " and "), listing.failure,
            may_choose ? "; choose one of them with OCL_ICD_VENDORS" : "")));
    }
    return drivers;
}

std::vector<std::string> unlisted_drivers(const std::string& place, const std::string& folders) {
    std::string named;
    for (const std::string& file : icd_files(place)) named += library_of(file) + "\n";
    std::vector<std::string> found;
    for (const std::string& folder : split(folders + ":" + library_folders, ':')) {
        for (const std::string library :
             {"libnvidia-opencl.so.1", "libamdocl64.so", "libigdrcl.so"}) {
            std::error_code error;
            const fs::path file = fs::path(folder) / library;
            if (named.find(library + "\n") != std::string::npos || !fs::exists(file, error))
                continue;
            if (fs::equivalent(file, place, error)) continue;  // OCL_ICD_VENDORS may be a library
            found.push_back(file);
            named += library + "\n";
        }
    }
    return found;
}

void list_drivers_for_parent(const std::string& place) {
    const FileDescriptor nowhere(open("/dev/null", O_RDWR | O_CLOEXEC));
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere.number(), stream);
    watch_worker("loading");
    std::map<std::string, std::string> skipped;
    for (const std::string& file : icd_files(place)) {
        if (const std::string why = why_skipped(file); !why.empty()) skipped.emplace(file, why);
    }
    watch_worker("listing its devices");
    const ClDeviceList list = list_cl_devices();
    const Json answer{
        {"skipped", skipped}, {"devices", json_of(list.devices)}, {"problems", list.problems}};
    tell_parent(answer.dump(-1, ' ', false, Json::error_handler_t::replace));
}

WorkerEnd run_without_bad_drivers(const WorkerCommand& command, const std::string& place,
                                  bool is_quiet) {
    const Stopwatch watch;
    WorkerEnd end = run_worker(command);
    if (end.has_failed() && end.task == listing_devices) {
        const Drivers drivers = list_drivers(place, command.deadline);
        if (!is_quiet) print_notes(drivers.bad_files);
        if (!drivers.place.empty() && !drivers.files.empty()) {
            WorkerCommand again = command;
            again.drivers = drivers.place;
            again.seconds_before += watch.seconds();
            again.longest = std::max(again.longest - watch.seconds(), again.deadline);
            end = run_worker(again);
        }
    }
    return end;
}

}  // namespace rt
