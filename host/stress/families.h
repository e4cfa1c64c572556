// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/stress/stress_case.h"

namespace rt {

using StressFamilies = std::vector<StressFamily>;

// One file of families each.
StressFamilies ordinary_families();
StressFamilies scale_families();
StressFamilies sphere_families();
StressFamilies cone_families();
StressFamilies mirror_families();
StressFamilies glass_families();
StressFamilies light_families();
StressFamilies eye_families();
StressFamilies view_families();
StressFamilies triangle_families();
StressFamilies normal_families();
StressFamilies leak_families();
StressFamilies ray_families();
StressFamilies input_families();

}  // namespace rt
