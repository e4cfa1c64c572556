// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace rt {

/// Runs the work on a thread with lowered priority and waits for it; rethrows its exception. It
/// needs its own thread because a lowered priority cannot be raised again.
void run_at_low_priority(const std::function<void()>& work);

}  // namespace rt
