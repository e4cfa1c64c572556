// SPDX-License-Identifier: Apache-2.0
#include "host/stress/case_helpers.h"
#include "host/stress/families.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

StressCase seen_from(glm::dvec3 from, glm::dvec3 at) {
    return picture_case([=] {
        Scene scene = still_life();
        for (auto& material : scene.materials) material.two_sided = true;
        set_view(scene, from, at, 60);
        return scene;
    });
}

/// The same with a tube of radius 0.5 about (3, y, 2), from the floor to y = 2.
StressCase with_tube(glm::dvec3 from, glm::dvec3 at) {
    const StressCase without = seen_from(from, at);
    return picture_case([before = std::get<PictureTrial>(without.trial).scene] {
        Scene scene = before();
        add_cone(scene, {3, 0, 2}, 0.5, {3, 2, 2}, 0.5, 1);
        return scene;
    });
}

/// The red ball is about (-1.5, 1, 0) with radius 1, the floor at y = 0.
StressFamily eyes_in_and_between() {
    return listed(
        {"eye-place", "where the eye is", "the near root, or its rounding, is behind the eye"},
        {{"in-a-ball", InQuick::yes, seen_from({-1.5, 1.25, 0.25}, {0, 0.5, 1})},
         {"just-in-a-ball", InQuick::no, seen_from({-1.5, 2 - 0x1p-20, 0}, {0, 0.5, 1})},
         {"just-off-a-ball", InQuick::yes, seen_from({-1.5, 2 + 0x1p-20, 0}, {1, 1, 4})},
         {"between-ball-and-floor", InQuick::no, seen_from({-1.5, 0x1p-12, 0.25}, {0, 0.5, 4})},
         {"just-above-the-floor", InQuick::no, seen_from({0, 0x1p-20, 6}, {0, 0.5, 0})},
         {"below-the-floor", InQuick::no, seen_from({0, -1, 6}, {0, 0.5, 0})},
         {"in-a-tube", InQuick::yes, with_tube({3, 1, 2.25}, {1, 0.5, 1})},
         {"just-off-a-tube", InQuick::no, with_tube({3.5 + 0x1p-20, 1, 2}, {4, 1, 6})},
         {"1e-9-off-a-tube", InQuick::yes, with_tube({3.5 + 1e-9, 1, 2}, {0, 0.5, 2.5})},
         {"1e-9-off-a-tube-looking-away", InQuick::no, with_tube({3.5 + 1e-9, 1, 2}, {4, 1, 6})},
         {"1e-9-in-a-tube", InQuick::yes, with_tube({3.5 - 1e-9, 1, 2}, {4, 1, 6})},
         {"1e-9-in-a-tube-looking-in", InQuick::no, with_tube({3.5 - 1e-9, 1, 2}, {0, 0.5, 2.5})},
         {"1e-9-off-a-ball", InQuick::no, seen_from({-1.5, 2 + 1e-9, 0}, {-1.25, 0, 0.5})}});
}

/// Rays from such an eye start with the surface's primitive index.
StressFamily eyes_on_surfaces() {
    return listed({"eye-on-surface", "what the eye is on",
                   "rounding decides whether the surface hides everything else"},
                  {{"top-of-a-ball", InQuick::yes, seen_from({-1.5, 2, 0}, {1, 1, 4})},
                   {"side-of-a-ball", InQuick::no, seen_from({-0.5, 1, 0}, {2, 1, 1})},
                   {"ball-looking-in", InQuick::no, seen_from({-1.5, 2, 0}, {-1.25, 0, 0.5})},
                   {"floor-looking-up", InQuick::no, seen_from({0, 0, 6}, {0, 3, 2})},
                   {"tube-looking-away", InQuick::yes, with_tube({3.5, 1, 2}, {4, 1, 6})},
                   {"tube-looking-in", InQuick::no, with_tube({3.5, 1, 2}, {0, 0.5, 2.5})}});
}

}  // namespace

StressFamilies eye_families() { return {eyes_in_and_between(), eyes_on_surfaces()}; }

}  // namespace rt
