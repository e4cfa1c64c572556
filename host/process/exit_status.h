// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace rt {

/// Runs it and returns its exit status. For an exception, prints the error and returns its exit
/// code.
int exit_status_of(const std::function<int()>& run);

}  // namespace rt
