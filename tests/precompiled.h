// SPDX-License-Identifier: Apache-2.0
//
// Headers nearly every test needs, compiled once per program. Each test still includes what it
// uses.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "host/scene/scene.h"
