// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/stress/stress_case.h"

namespace rt {

using StressFamilies = std::vector<StressFamily>;

// One file of families each.
void add_ordinary_families(StressFamilies& families);
void add_scale_families(StressFamilies& families);
void add_sphere_families(StressFamilies& families);
void add_cone_families(StressFamilies& families);
void add_mirror_families(StressFamilies& families);
void add_glass_families(StressFamilies& families);
void add_light_families(StressFamilies& families);
void add_eye_families(StressFamilies& families);
void add_view_families(StressFamilies& families);
void add_triangle_families(StressFamilies& families);
void add_normal_families(StressFamilies& families);
void add_leak_families(StressFamilies& families);
void add_ray_families(StressFamilies& families);
void add_input_families(StressFamilies& families);

}  // namespace rt
