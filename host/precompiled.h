// SPDX-License-Identifier: Apache-2.0
//
// Headers that most libraries need, compiled once. Each source still includes what it uses.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/scene/scene.h"
