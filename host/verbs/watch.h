// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace rt {

/// Calls `render`, which returns an exit status, and again whenever the scene's file or one of its
/// models has changed, until a stop signal comes; what it throws goes to stderr. Returns the exit
/// status of the signal.
int watch_scene(const std::string& scene, bool is_quiet, const std::function<int()>& render);

}  // namespace rt
