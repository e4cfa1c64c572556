// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/pocl.h"

#include <fmt/format.h>
#include <sched.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>
#include <system_error>

#include "host/base/files.h"
#include "host/base/text.h"

namespace rt {

namespace {

namespace fs = std::filesystem;

constexpr int overwrite = 1;
constexpr const char* cache_variable = "POCL_CACHE_DIR";
constexpr const char* most_threads = "POCL_MAX_PTHREAD_COUNT";
constexpr const char* least_threads = "POCL_PTHREAD_MIN_THREADS";

/// The number of cores, if this process may use them all; else 0.
int cores_to_use() {
    cpu_set_t usable;
    if (sched_getaffinity(0, sizeof(usable), &usable) != 0) return 0;
    const auto cores = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
    for (int core = 0; core < cores; ++core) {
        if (!CPU_ISSET(static_cast<std::size_t>(core), &usable)) return 0;
    }
    return cores;
}

void set_threads(int count) {
    const int cores = cores_to_use();
    if (count == 0 && !getenv(most_threads) && !getenv(least_threads)) count = cores;
    if (count == 0) return;
    setenv(most_threads, std::to_string(count).c_str(), overwrite);
    // PoCL pins thread i to core i, and ends the process if there is no such core.
    if (count == cores && !getenv(least_threads)) setenv("POCL_AFFINITY", "1", !overwrite);
}

/// Whether only we can write there; a missing folder will be made by us.
bool is_ours(const fs::path& folder) {
    struct stat status {};
    if (stat(folder.c_str(), &status) != 0) return errno == ENOENT;
    return status.st_uid == geteuid() && (status.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

/// Empty if there is no home.
fs::path own_cache_folder() {
    const fs::path xdg = environment("XDG_CACHE_HOME");
    if (xdg.is_absolute()) return xdg;  // as its specification says
    const std::string home = environment("HOME");
    return home.empty() ? fs::path() : fs::path(home) / ".cache";
}

/// PoCL leaves an empty file there per process, and others when it crashes. Removes those that no
/// running build can need.
void remove_leftovers(const fs::path& cache) {
    const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
    std::error_code error;
    for (auto entry = fs::directory_iterator(cache, error); !error && entry != fs::end(entry);
         entry.increment(error)) {
        if (!entry->path().filename().string().starts_with("tempfile_")) continue;
        std::error_code failed;
        const bool is_probe = !entry->path().has_extension() && entry->file_size(failed) == 0;
        const auto written = entry->last_write_time(failed);
        if (!failed && (is_probe || written < long_ago)) fs::remove(entry->path(), failed);
    }
}

/// The folder of this process alone, if there is no permanent one.
std::optional<TemporaryFolder> private_cache;

/// Or the permanent one; empty if it is not ours to clean.
fs::path kept_cache;

/// Its paths have at most 1,023 bytes; those of kernels have up to 200 after the folder's name.
constexpr std::size_t longest_folder = 800;

/// Empty if others can write there, or we or PoCL cannot.
fs::path kept_cache_folder() {
    std::error_code error;
    fs::path folder = own_cache_folder();
    if (folder.empty()) {
        folder = fs::temp_directory_path(error) / ("mirrorball-" + std::to_string(geteuid()));
        mkdir(folder.c_str(), S_IRWXU);
        if (!is_ours(folder)) return {};
    }
    folder /= "mirrorball";
    fs::create_directories(folder, error);
    folder /= "pocl";
    if (folder.native().size() > longest_folder) return {};
    mkdir(folder.c_str(), S_IRWXU);
    if (!is_ours(folder) || access(folder.c_str(), W_OK | X_OK) != 0) return {};
    remove_leftovers(folder);
    return folder;
}

void set_cache_folder() {
    const std::string given = environment(cache_variable);
    if (!given.empty() && is_ours(given)) return;
    kept_cache = kept_cache_folder();
    if (kept_cache.empty()) return start_fresh_pocl_cache();
    setenv(cache_variable, kept_cache.c_str(), overwrite);
}

void find_linker() {
    std::string path;
    bool is_found = false;
    for (const std::string& folder : split(environment("PATH"), ':')) {
        if (!fs::path(folder).is_absolute()) continue;  // anybody's ld may be there
        is_found |= access((fs::path(folder) / "ld").c_str(), X_OK) == 0;
        path += (path.empty() ? "" : ":") + folder;
    }
    if (!is_found) path += path.empty() ? "/usr/bin:/bin" : ":/usr/bin:/bin";
    setenv("PATH", path.c_str(), overwrite);
}

}  // namespace

void prepare_pocl(int count) {
    set_threads(count);
    set_cache_folder();
    find_linker();
}

void start_fresh_pocl_cache() {
    setenv(cache_variable, private_cache.emplace().name().c_str(), overwrite);
}

void leave_pocl_cache() {
    private_cache.reset();
    if (!kept_cache.empty()) remove_leftovers(kept_cache);
}

fs::path pocl_cache_folder() {
    const std::string folder = environment(cache_variable);
    return folder.empty() ? "/tmp/pocl/kcache" : folder;
}

bool pocl_keeps_kernels() {
    const char* const wanted = getenv("POCL_KERNEL_CACHE");
    return wanted == nullptr || *wanted == '1';
}

std::string why_pocl_cache_is_read_only() {
    const fs::path folder = pocl_cache_folder();
    if (folder.native().size() > longest_folder) {
        return fmt::format("its name has {} bytes, and PoCL has room for {}",
                           folder.native().size(), longest_folder);
    }
    std::string probe = folder / "mirrorball-XXXXXX";
    const int file = mkstemp(probe.data());
    if (file < 0) return folder.string() + ": " + std::strerror(errno);
    close(file);
    unlink(probe.c_str());
    return "";
}

std::string pocl_build_advice() {
    const std::string why = why_pocl_cache_is_read_only();
    if (why.empty()) return "update the driver";
    return "PoCL cannot write its kernel cache (" + why +
           "): set POCL_CACHE_DIR to a writable folder";
}

}  // namespace rt
