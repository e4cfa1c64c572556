// SPDX-License-Identifier: Apache-2.0
#include "host/stress/case_helpers.h"
#include "host/stress/families.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

/// Narrow views aim at the red ball's outline, so that they contain an edge.
Scene narrow_or_wide(double degrees) {
    Scene scene = still_life();
    set_image_size(scene, 80, 60);
    const glm::dvec3 outline(-0.5076, 1.0625, 0.1240);
    set_view(scene, {0, 2, 8}, degrees < 2 ? outline : glm::dvec3(0, 0.75, 0), degrees);
    return scene;
}

StressFamily fields_of_view() {
    return sweep(
        {"field-of-view", "degrees",
         "neighboring rays differ in their last bits, or the view plane runs off to infinity"},
        {1e-4, 1e-3, 1e-2, 1e-1, 1.0, 90.0, 170.0, 179.0, 179.99}, {1e-3, 1e-2, 179.99},
        [](double degrees) {
            StressTolerance tolerance;
            tolerance.in_float = degrees >= 1e-3;
            if (degrees < 1) tolerance.max_error = std::max(1e-4, 1e-6 / degrees);
            return picture_case([=] { return narrow_or_wide(degrees); }, tolerance);
        });
}

StressFamily parallel_views() {
    const auto view = [](glm::dvec3 from, glm::dvec3 up) {
        return picture_case([=] {
            Scene scene = still_life();
            scene.camera.up = up;
            set_orthographic(scene, from, {0, 0.75, 0}, 6);
            return scene;
        });
    };
    return listed({"parallel-view", "direction", "0 times infinity where rays run along the axes"},
                  {{"slanted", InQuick::no, view({3, 4, 8}, {0, 1, 0})},
                   {"along-z", InQuick::yes, view({0, 0.75, 8}, {0, 1, 0})},
                   {"along-x", InQuick::no, view({8, 0.75, 0}, {0, 1, 0})},
                   {"along-y", InQuick::no, view({0, 8.75, 0}, {0, 0, -1})}});
}

/// Up vectors of any length, and nearly parallel to the view.
StressFamily ups() {
    const auto with_up = [](glm::dvec3 up) {
        return picture_case([=] {
            Scene scene = still_life();
            scene.camera.up = up;
            return scene;
        });
    };
    return listed({"up", "the camera's up", "axes lose precision, or their length"},
                  {{"1e-30", InQuick::yes, with_up({0, 1e-30, 0})},
                   {"1e30", InQuick::no, with_up({0, 1e30, 0})},
                   {"1e-300", InQuick::no, with_up({0, 1e-300, 0})},
                   {"1e-6-off-the-view", InQuick::yes, with_up({1e-6, -1.25, -8})},
                   {"1e-8-off-the-view", InQuick::no, with_up({1e-8, -1.25, -8})}});
}

StressFamily picture_shapes() {
    using Size = std::pair<int, int>;
    const std::vector<Size> sizes{{1, 1}, {1, 2}, {3, 5}, {1, 1024}, {1, 65536}, {65536, 1}};
    return sweep({"picture-shape", "pixels", "one pixel, one column, one row: degenerate sizes"},
                 sizes, {{1, 1}, {1, 1024}}, [](const Size& size) {
                     const auto [width, height] = size;
                     return labeled(fmt::format("{}x{}", width, height), width * height,
                                    picture_case([size] {
                                        Scene scene = still_life();
                                        set_image_size(scene, size.first, size.second);
                                        return scene;
                                    }));
                 });
}

}  // namespace

StressFamilies view_families() {
    return {fields_of_view(), parallel_views(), ups(), picture_shapes()};
}

}  // namespace rt
