// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <sstream>
#include <string>

namespace rt {

/// Cores this process may run on (its affinity mask), at least 1.
int available_cores();

/// Processor time of all threads of the program together, in seconds. Other load on the machine
/// affects it less than wall-clock time.
double processor_seconds();

/// The fields of a process's or thread's /proc/.../stat file from the third on, its state.
std::istringstream stat_fields(const std::string& file);

/// Seconds since the system started this process: its processor time, if its one thread has not
/// waited; else up to 0.01 s too little, the resolution of the system's own record.
double seconds_since_process_start();

/// Wall-clock seconds since construction or the last restart; monotonic.
class Stopwatch {
   public:
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

    /// Returns the seconds so far and restarts.
    double lap() {
        const Clock::time_point now = Clock::now();
        const double elapsed = std::chrono::duration<double>(now - start_).count();
        start_ = now;
        return elapsed;
    }

   private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

/// Runs work(0) .. work(count - 1), each on its own POSIX thread, and joins them all; work begins
/// once every thread exists. Rethrows the lowest-numbered thread's exception. Throws Error
/// (ExitCode::limit) when the system cannot start that many threads; no work is done then.
void run_on_threads(int count, const std::function<void(int)>& work);

/// Splits 0 .. count into runs of `grain` and calls work(first, last) for them on up to `threads`
/// threads; a single run is done on the calling thread. The runs are always the same, their
/// assignment to threads is not. Rethrows the exception of the first run that failed.
void for_each_run(std::size_t count, std::size_t grain, int threads,
                  const std::function<void(std::size_t, std::size_t)>& work);

}  // namespace rt
