// SPDX-License-Identifier: Apache-2.0
#include "host/stress/families.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

StressCase seen_from(glm::dvec3 from, glm::dvec3 at, bool has_tube = false) {
    Scene scene = still_life();
    for (auto& material : scene.materials) material.two_sided = true;
    if (has_tube) add_cone(scene, {3, 0, 2}, 0.5, {3, 2, 2}, 0.5, 1);
    set_view(scene, from, at, 60);
    return picture_case(scene);
}

/// The same with a tube of radius 0.5 about (3, y, 2), from the floor to y = 2.
StressCase with_tube(glm::dvec3 from, glm::dvec3 at) { return seen_from(from, at, true); }

/// Narrow views aim at the red ball's outline, so that they contain an edge.
Scene narrow_or_wide(double degrees) {
    Scene scene = still_life();
    set_image_size(scene, 80, 60);
    const glm::dvec3 outline(-0.5076, 1.0625, 0.1240);
    set_view(scene, {0, 2, 8}, degrees < 2 ? outline : glm::dvec3(0, 0.75, 0), degrees);
    return scene;
}

}  // namespace

StressFamilies eye_families() {
    const auto view = [](glm::dvec3 from, glm::dvec3 up) {
        Scene scene = still_life();
        scene.camera.up = up;
        set_orthographic(scene, from, {0, 0.75, 0}, 6);
        return picture_case(scene);
    };
    const auto with_up = [](glm::dvec3 up) {
        Scene scene = still_life();
        scene.camera.up = up;
        return picture_case(scene);
    };
    using Size = std::pair<int, int>;
    const std::vector<Size> sizes{{1, 1}, {1, 2}, {3, 5}, {1, 1024}, {1, 65536}, {65536, 1}};
    return {
        // The red ball is about (-1.5, 1, 0) with radius 1, the floor at y = 0.
        listed(
            {"eye-place", "where the eye is", "the near root, or its rounding, is behind the eye"},
            {{"in-a-ball", quick(seen_from({-1.5, 1.25, 0.25}, {0, 0.5, 1}))},
             {"just-in-a-ball", seen_from({-1.5, 2 - 0x1p-20, 0}, {0, 0.5, 1})},
             {"just-off-a-ball", quick(seen_from({-1.5, 2 + 0x1p-20, 0}, {1, 1, 4}))},
             {"between-ball-and-floor", seen_from({-1.5, 0x1p-12, 0.25}, {0, 0.5, 4})},
             {"just-above-the-floor", seen_from({0, 0x1p-20, 6}, {0, 0.5, 0})},
             {"below-the-floor", seen_from({0, -1, 6}, {0, 0.5, 0})},
             {"in-a-tube", quick(with_tube({3, 1, 2.25}, {1, 0.5, 1}))},
             {"just-off-a-tube", with_tube({3.5 + 0x1p-20, 1, 2}, {4, 1, 6})},
             {"1e-9-off-a-tube", quick(with_tube({3.5 + 1e-9, 1, 2}, {0, 0.5, 2.5}))},
             {"1e-9-off-a-tube-looking-away", with_tube({3.5 + 1e-9, 1, 2}, {4, 1, 6})},
             {"1e-9-in-a-tube", quick(with_tube({3.5 - 1e-9, 1, 2}, {4, 1, 6}))},
             {"1e-9-in-a-tube-looking-in", with_tube({3.5 - 1e-9, 1, 2}, {0, 0.5, 2.5})},
             {"1e-9-off-a-ball", seen_from({-1.5, 2 + 1e-9, 0}, {-1.25, 0, 0.5})}}),
        // Rays from such an eye start with the surface's primitive index.
        listed({"eye-on-surface", "what the eye is on",
                "rounding decides whether the surface hides everything else"},
               {{"top-of-a-ball", quick(seen_from({-1.5, 2, 0}, {1, 1, 4}))},
                {"side-of-a-ball", seen_from({-0.5, 1, 0}, {2, 1, 1})},
                {"ball-looking-in", seen_from({-1.5, 2, 0}, {-1.25, 0, 0.5})},
                {"floor-looking-up", seen_from({0, 0, 6}, {0, 3, 2})},
                {"tube-looking-away", quick(with_tube({3.5, 1, 2}, {4, 1, 6}))},
                {"tube-looking-in", with_tube({3.5, 1, 2}, {0, 0.5, 2.5})}}),
        sweep(
            {"field-of-view", "degrees",
             "neighboring rays differ in their last bits, or the view plane runs off to infinity"},
            {1e-4, 1e-3, 1e-2, 1e-1, 1.0, 90.0, 170.0, 179.0, 179.99}, {1e-3, 1e-2, 179.99},
            [](double degrees) {
                const double error = degrees < 1 ? std::max(1e-4, 1e-6 / degrees) : usual_error;
                return picture_case(narrow_or_wide(degrees),
                                    {.max_error = error, .in_float = degrees >= 1e-3});
            }),
        listed({"parallel-view", "direction", "0 times infinity where rays run along the axes"},
               {{"slanted", view({3, 4, 8}, {0, 1, 0})},
                {"along-z", quick(view({0, 0.75, 8}, {0, 1, 0}))},
                {"along-x", view({8, 0.75, 0}, {0, 1, 0})},
                {"along-y", view({0, 8.75, 0}, {0, 0, -1})}}),
        // Up vectors of any length, and nearly parallel to the view.
        listed({"up", "the camera's up", "axes lose precision, or their length"},
               {{"1e-30", quick(with_up({0, 1e-30, 0}))},
                {"1e30", with_up({0, 1e30, 0})},
                {"1e-300", with_up({0, 1e-300, 0})},
                {"1e-6-off-the-view", quick(with_up({1e-6, -1.25, -8}))},
                {"1e-8-off-the-view", with_up({1e-8, -1.25, -8})}}),
        sweep({"picture-shape", "pixels", "one pixel, one column, one row: degenerate sizes"},
              sizes, {{1, 1}, {1, 1024}}, [](const Size& size) {
                  const auto [width, height] = size;
                  Scene scene = still_life();
                  set_image_size(scene, width, height);
                  return labeled(fmt::format("{}x{}", width, height), width * height,
                                 picture_case(scene));
              })};
}

}  // namespace rt
