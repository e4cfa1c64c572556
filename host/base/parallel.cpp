// SPDX-License-Identifier: Apache-2.0
#include "host/base/parallel.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

#include "host/base/error.h"

namespace rt {

namespace {

enum class Gate { closed, open, abandoned };

/// The i-th core of a set, as a set; empty if there are fewer.
cpu_set_t one_core(const cpu_set_t& cores, int i) {
    cpu_set_t one;
    CPU_ZERO(&one);
    for (std::size_t core = 0; core < CPU_SETSIZE; ++core) {
        if (CPU_ISSET(core, &cores) && i-- == 0) CPU_SET(core, &one);
    }
    return one;
}

/// Threads that wake together often share a core for a few milliseconds: the i-th starts on a core
/// of its own among `cores`, and may then go to any of them.
void start_on_own_core(int i, const cpu_set_t& cores, const std::atomic<Gate>& gate) {
    const cpu_set_t own = one_core(cores, i);
    const bool is_moved =
        CPU_COUNT(&own) == 1 && pthread_setaffinity_np(pthread_self(), sizeof own, &own) == 0;
    gate.wait(Gate::closed);
    if (is_moved) pthread_setaffinity_np(pthread_self(), sizeof cores, &cores);
}

void rethrow_first(const std::vector<std::exception_ptr>& failures) {
    for (const std::exception_ptr& failure : failures) {
        if (failure) std::rethrow_exception(failure);
    }
}

}  // namespace

int available_cores() {
    cpu_set_t mask;
    if (sched_getaffinity(0, sizeof mask, &mask) != 0) return 1;
    const int cores = CPU_COUNT(&mask);
    return cores > 0 ? cores : 1;
}

double processor_seconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::istringstream stat_fields(const std::string& file) {
    std::ifstream stream(file);
    std::string text;
    std::getline(stream, text, '\0');  // unlike an iterator, never throws where the process ends
    const std::size_t name_end = text.rfind(')');  // field 2, in parentheses, may hold anything
    return std::istringstream(name_end == text.npos ? "" : text.substr(name_end + 1));
}

double seconds_since_process_start() {
    std::istringstream fields = stat_fields("/proc/self/stat");
    std::string field;
    for (int i = 3; i <= 22; ++i) fields >> field;  // the start, in clock ticks since boot
    timespec now{};
    if (!fields || clock_gettime(CLOCK_BOOTTIME, &now) != 0) return 0;
    const double tick = 1 / static_cast<double>(sysconf(_SC_CLK_TCK));
    const double since_tick = static_cast<double>(now.tv_sec) +
                              1e-9 * static_cast<double>(now.tv_nsec) - tick * std::stod(field);
    return std::max(processor_seconds(), since_tick - tick);
}

void run_on_threads(int count, const std::function<void(int)>& work) {
    std::atomic<Gate> gate = Gate::closed;
    const auto open_gate = [&gate](Gate state) {
        gate = state;
        gate.notify_all();
    };
    cpu_set_t cores;
    if (sched_getaffinity(0, sizeof cores, &cores) != 0) CPU_ZERO(&cores);
    std::vector<std::exception_ptr> failures(static_cast<std::size_t>(count));
    std::vector<std::jthread> threads;
    const auto run = [&](int i) {
        start_on_own_core(i, cores, gate);
        if (gate == Gate::abandoned) return;
        try {
            work(i);
        } catch (...) {
            failures[static_cast<std::size_t>(i)] = std::current_exception();
        }
    };
    try {
        while (std::ssize(threads) < count) threads.emplace_back(run, std::ssize(threads));
    } catch (const std::exception& error) {
        open_gate(Gate::abandoned);
        throw Error(ExitCode::limit,
                    fmt::format("cannot start thread {} of {}: {}; use a smaller --threads",
                                threads.size() + 1, count, error.what()));
    }
    open_gate(Gate::open);
    threads.clear();
    rethrow_first(failures);
}

void for_each_run(std::size_t count, std::size_t grain, int threads,
                  const std::function<void(std::size_t, std::size_t)>& work) {
    const std::size_t runs = (count + grain - 1) / grain;
    if (runs <= 1 || threads <= 1) {
        for (std::size_t at = 0; at < count; at += grain) work(at, std::min(at + grain, count));
        return;
    }
    std::vector<std::exception_ptr> failures(runs);
    std::atomic<std::size_t> next = 0;
    run_on_threads(static_cast<int>(std::min<std::size_t>(runs, threads)), [&](int) {
        for (std::size_t run = next++; run < runs; run = next++) {
            try {
                work(run * grain, std::min((run + 1) * grain, count));
            } catch (...) {
                failures[run] = std::current_exception();
                next = runs;
            }
        }
    });
    rethrow_first(failures);
}

}  // namespace rt
