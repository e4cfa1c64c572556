// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "host/stress/case_helpers.h"
#include "host/stress/families.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

/// Narrow views aim at the red ball's outline, so that they contain an edge.
StressFamily fields_of_view() {
    StressFamily family{"field-of-view",
                        "degrees",
                        "neighboring rays differ in their last bits, "
                        "or the view plane runs off to infinity",
                        {}};
    for (const double degrees : {1e-4, 1e-3, 1e-2, 1e-1, 1.0, 90.0, 170.0, 179.0, 179.99}) {
        StressTolerance tolerance;
        tolerance.in_float = degrees >= 1e-3;
        if (degrees < 1) tolerance.max_error = std::max(1e-4, 1e-6 / degrees);
        family.cases.push_back(picture_case(
            fmt::format("{:g}", degrees), degrees,
            quick_if(degrees == 1e-3 || degrees == 1e-2 || degrees == 179.99),
            [degrees] {
                Scene scene = still_life();
                set_image_size(scene, 80, 60);
                const glm::dvec3 outline(-0.5076, 1.0625, 0.1240);
                set_view(scene, {0, 2, 8}, degrees < 2 ? outline : glm::dvec3(0, 0.75, 0), degrees);
                return scene;
            },
            tolerance));
    }
    return family;
}

StressFamily parallel_views() {
    StressFamily family{"parallel-view",
                        "direction",
                        "0 times infinity where rays run along the "
                        "axes",
                        {}};
    const auto add = [&](const char* label, InQuick quick, glm::dvec3 from, glm::dvec3 up) {
        family.cases.push_back(
            picture_case(label, static_cast<double>(family.cases.size()), quick, [=] {
                Scene scene = still_life();
                scene.camera.up = up;
                set_orthographic(scene, from, {0, 0.75, 0}, 6);
                return scene;
            }));
    };
    add("slanted", InQuick::no, {3, 4, 8}, {0, 1, 0});
    add("along-z", InQuick::yes, {0, 0.75, 8}, {0, 1, 0});
    add("along-x", InQuick::no, {8, 0.75, 0}, {0, 1, 0});
    add("along-y", InQuick::no, {0, 8.75, 0}, {0, 0, -1});
    return family;
}

/// Up vectors of any length, and nearly parallel to the view.
StressFamily ups() {
    StressFamily family{"up", "the camera's up", "axes lose their digits, or their length", {}};
    const auto add = [&](const char* label, InQuick quick, glm::dvec3 up) {
        family.cases.push_back(
            picture_case(label, static_cast<double>(family.cases.size()), quick, [=] {
                Scene scene = still_life();
                scene.camera.up = up;
                return scene;
            }));
    };
    add("1e-30", InQuick::yes, {0, 1e-30, 0});
    add("1e30", InQuick::no, {0, 1e30, 0});
    add("1e-300", InQuick::no, {0, 1e-300, 0});
    add("1e-6-off-the-view", InQuick::yes, {1e-6, -1.25, -8});
    add("1e-8-off-the-view", InQuick::no, {1e-8, -1.25, -8});
    return family;
}

StressFamily picture_shapes() {
    StressFamily family{"picture-shape",
                        "pixels",
                        "one pixel, one column, one row: indices and "
                        "halves of nothing",
                        {}};
    const auto add = [&](int width, int height, InQuick quick) {
        family.cases.push_back(picture_case(fmt::format("{}x{}", width, height),
                                            double{1} * width * height, quick, [=] {
                                                Scene scene = still_life();
                                                set_image_size(scene, width, height);
                                                return scene;
                                            }));
    };
    add(1, 1, InQuick::yes);
    add(1, 2, InQuick::no);
    add(3, 5, InQuick::no);
    add(1, 1024, InQuick::yes);
    add(1, 65536, InQuick::no);
    add(65536, 1, InQuick::no);
    return family;
}

}  // namespace

void add_view_families(StressFamilies& families) {
    for (const auto make : {fields_of_view, parallel_views, ups, picture_shapes}) {
        families.push_back(make());
    }
}

}  // namespace rt
