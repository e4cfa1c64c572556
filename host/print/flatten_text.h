// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "host/flatten/flat_scene.h"

namespace rt {

/// One line each: the hierarchies that flatten built, such as "hierarchy over triangles (1059607
/// nodes, 23 deep), built in 0.330 s", and how many light-triangle pairs cast shadows.
std::string hierarchies_text(const FlattenStats& stats);
std::string casters_text(const FlattenStats& stats);

nlohmann::ordered_json hierarchies_json(const FlattenStats& stats);

}  // namespace rt
