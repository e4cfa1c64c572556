// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace rt {

/// Cores this process may run on (its affinity mask), at least 1.
int available_cores();

/// Runs work(0) .. work(count - 1), each on a POSIX thread of its own, and joins them all; work
/// begins once every thread exists. The first exception of any thread is rethrown here. Throws
/// Error (ExitCode::limit) when the system will not start that many threads; no work is done then.
void run_on_threads(int count, const std::function<void(int)>& work);

/// Cuts 0 .. count into runs of `grain` and has up to `threads` threads call work(first, last) for
/// them; one run is worked on right here. Which thread works on a run is left open, the runs are
/// not. Rethrows the exception of the first run that failed.
void for_each_run(std::size_t count, std::size_t grain, int threads,
                  const std::function<void(std::size_t, std::size_t)>& work);

}  // namespace rt
