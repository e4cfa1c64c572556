// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace rt {

/// Calls `render`, which returns an exit status, now and whenever the scene's file or one of its
/// models or their material libraries changes, until a stop signal comes; reports its exceptions on
/// stderr. Returns the signal's exit status.
int watch_scene(const std::string& scene, bool is_quiet, const std::function<int()>& render);

}  // namespace rt
