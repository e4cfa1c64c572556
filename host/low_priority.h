// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace rt {

/// Runs the work on a thread that leaves most of a busy processor to the others, and waits for it;
/// rethrows what it throws. A thread of its own, since priorities cannot be raised again.
void run_at_low_priority(const std::function<void()>& work);

}  // namespace rt
