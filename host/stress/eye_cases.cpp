// SPDX-License-Identifier: Apache-2.0
#include "host/stress/case_helpers.h"
#include "host/stress/families.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

void add_eye(StressFamily& family, const char* label, InQuick quick, glm::dvec3 from,
             glm::dvec3 at) {
    family.cases.push_back(
        picture_case(label, static_cast<double>(family.cases.size()), quick, [=] {
            Scene scene = still_life();
            for (auto& material : scene.materials) material.two_sided = true;
            set_view(scene, from, at, 60);
            return scene;
        }));
}

/// The same with a tube of radius 0.5 about (3, y, 2), from the floor to y = 2.
void add_tube_eye(StressFamily& family, const char* label, InQuick quick, glm::dvec3 from,
                  glm::dvec3 at) {
    add_eye(family, label, quick, from, at);
    auto& trial = std::get<PictureTrial>(family.cases.back().trial);
    trial.scene = [before = trial.scene] {
        Scene scene = before();
        add_cone(scene, {3, 0, 2}, 0.5, {3, 2, 2}, 0.5, 1);
        return scene;
    };
}

/// The red ball is about (-1.5, 1, 0) with radius 1, the floor at y = 0.
StressFamily eyes_in_and_between() {
    StressFamily family{"eye-place",
                        "where the eye is",
                        "the near root is behind the eye, or its "
                        "rounding is",
                        {}};
    add_eye(family, "in-a-ball", InQuick::yes, {-1.5, 1.25, 0.25}, {0, 0.5, 1});
    add_eye(family, "just-in-a-ball", InQuick::no, {-1.5, 2 - 0x1p-20, 0}, {0, 0.5, 1});
    add_eye(family, "just-off-a-ball", InQuick::yes, {-1.5, 2 + 0x1p-20, 0}, {1, 1, 4});
    add_eye(family, "between-ball-and-floor", InQuick::no, {-1.5, 0x1p-12, 0.25}, {0, 0.5, 4});
    add_eye(family, "just-above-the-floor", InQuick::no, {0, 0x1p-20, 6}, {0, 0.5, 0});
    add_eye(family, "below-the-floor", InQuick::no, {0, -1, 6}, {0, 0.5, 0});
    add_tube_eye(family, "in-a-tube", InQuick::yes, {3, 1, 2.25}, {1, 0.5, 1});
    add_tube_eye(family, "just-off-a-tube", InQuick::no, {3.5 + 0x1p-20, 1, 2}, {4, 1, 6});
    return family;
}

/// Rays from such an eye start with the surface's primitive index.
StressFamily eyes_on_surfaces() {
    StressFamily family{"eye-on-surface",
                        "what the eye is on",
                        "rounding decides whether the "
                        "surface hides all else",
                        {}};
    add_eye(family, "top-of-a-ball", InQuick::yes, {-1.5, 2, 0}, {1, 1, 4});
    add_eye(family, "side-of-a-ball", InQuick::no, {-0.5, 1, 0}, {2, 1, 1});
    add_eye(family, "ball-looking-in", InQuick::no, {-1.5, 2, 0}, {-1.25, 0, 0.5});
    add_eye(family, "floor-looking-up", InQuick::no, {0, 0, 6}, {0, 3, 2});
    add_tube_eye(family, "tube-looking-away", InQuick::yes, {3.5, 1, 2}, {4, 1, 6});
    add_tube_eye(family, "tube-looking-in", InQuick::no, {3.5, 1, 2}, {0, 0.5, 2.5});
    return family;
}

}  // namespace

void add_eye_families(StressFamilies& families) {
    families.push_back(eyes_in_and_between());
    families.push_back(eyes_on_surfaces());
}

}  // namespace rt
