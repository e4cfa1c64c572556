// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace rt {

/// Calls `render`, which returns an exit status, now and whenever the scene's file or one of its
/// models or their material libraries changes, until `is_over`, with exit status 0, or a stop
/// signal comes, with the signal's; reports its exceptions on stderr.
int watch_scene(const std::string& scene, bool is_quiet, const std::function<int()>& render,
                const std::function<bool()>& is_over);

}  // namespace rt
