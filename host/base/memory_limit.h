// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace rt {

/// How much memory this process may still allocate, and which limit applies.
struct FreeMemory {
    std::uint64_t bytes = 0;
    std::string reason;  ///< "are free", "are left of the container's limit", ...
};

/// The smallest of: the machine's free memory, what each control group of this process leaves
/// (cgroup v1 or v2: containers, batch jobs, systemd), and its address space (ulimit -v). `root` is
/// where /proc and /sys are, for tests.
FreeMemory free_memory(const std::string& root = "");

/// Throws Error (ExitCode::limit) when `bytes` more would exceed the free memory of this process:
/// otherwise the system would kill it only after minutes of work. `what` and `advice` go into the
/// message.
void check_memory(std::uint64_t bytes, const std::string& what, const std::string& advice);

}  // namespace rt
