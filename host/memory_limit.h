// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace rt {

/// A bound on the memory this process may still take, and whose it is.
struct FreeMemory {
    std::uint64_t bytes = 0;
    std::string reason;  ///< "are free", "are left of the container's limit", ...
};

/// The least of: what the machine has free, what each control group of this process leaves it
/// (cgroup v1 or v2: containers, batch jobs, systemd), and its address space (ulimit -v). `root`
/// is where /proc and /sys are, for tests.
FreeMemory free_memory(const std::string& root = "");

/// Throws Error (ExitCode::limit) when `bytes` more would not fit into the memory this process has
/// free now: the system would kill it only after minutes of work. `what` and `advice` stand in the
/// message.
void check_memory(std::uint64_t bytes, const std::string& what, const std::string& advice);

}  // namespace rt
