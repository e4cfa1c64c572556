// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace rt {

/// Cores this process may run on (its affinity mask), at least 1.
int available_cores();

/// Runs work(0) .. work(count - 1), each on a POSIX thread of its own, and joins them all; work
/// begins once every thread exists. The first exception of any thread is rethrown here. Throws
/// Error (ExitCode::limit) when the system will not start that many threads; no work is done then.
void run_on_threads(int count, const std::function<void(int)>& work);

}  // namespace rt
