// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace rt {

/// Throws Error (ExitCode::limit) when `bytes` more would not fit into the memory this machine has
/// free now: the system would kill the process only after minutes of work. `what` and `advice`
/// stand in the message.
void check_memory(std::uint64_t bytes, const std::string& what, const std::string& advice);

}  // namespace rt
