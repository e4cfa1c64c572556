// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/measure/ray_tree.h"

namespace rt {

/// The trees as indented lines: a ray, what it hit, what each light adds, and the secondary rays.
std::string ray_trees_text(const std::vector<SampleTree>& trees);

/// "samples" of `explain --json` (docs/results-format.md).
nlohmann::ordered_json ray_trees_json(const std::vector<SampleTree>& trees);

}  // namespace rt
