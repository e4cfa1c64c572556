// SPDX-License-Identifier: Apache-2.0
#include "host/stress/scale_cases.h"

#include <cmath>

#include "host/stress/families.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

StressCase same_bits(MakeScene scene) {
    StressCase one = picture_case(std::move(scene));
    std::get<PictureTrial>(one.trial).same_bits = "the scene as it is";
    return one;
}

StressFamily powers_of_two() {
    return sweep(
        {"scale-2", "scale",
         "absolute epsilons swallow small scenes and leave holes in large ones"},
        {0, -40, -36, -32, -28, -24, -20, -16, -12, -8, -4, 4, 8, 12, 16, 20, 24, 28, 32, 36, 40},
        {0, -40, -20, 20, 40}, [](int k) { return scaled_by_two(still_life, k); });
}

StressFamily powers_of_ten() {
    return sweep(
        {"scale-10", "scale", "squares of distances leave the range of float beyond 10^19"},
        {-30, -25, -20, -15, -10, -6, -4, -3, -2, -1, 1, 2, 3, 4, 6, 10, 15, 20, 25, 30},
        {-30, -3, 3, 30}, [](int k) { return scaled_by_ten(still_life, k); });
}

StressFamily integer_shifts() {
    return sweep({"shift", "distance from the origin",
                  "coordinates far from the origin leave no precision for the scene"},
                 {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {0, 5, 9}, [](int k) {
                     if (k == 0) return labeled("0", 0, same_bits(still_life));
                     return moved(still_life, fmt::format("1e{}", k), std::pow(10.0, k));
                 });
}

/// Coordinates are rounded to double after the shift; the reference sees the same doubles.
StressFamily odd_shifts() {
    return sweep({"shift-odd", "distance from the origin", "offsets that float cannot represent"},
                 {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {7}, [](int k) {
                     const double by = 1.1 * std::pow(10.0, k);
                     return labeled(fmt::format("1.1e{}", k), by, picture_case([=] {
                                        return shifted(still_life(), {by, -by / 3, by / 7});
                                    }));
                 });
}

/// A scene with one distant object, which must not set the scale.
StressFamily outliers() {
    return sweep({"outlier", "distance of one ball",
                  "one distant object must not cost the others their precision"},
                 {1e2, 1e4, 1e6, 1e9, 1e12, 1e15}, {1e9}, [](double distance) {
                     Scene scene = still_life();
                     const double radius = 0.25 * distance;
                     add_sphere(scene, {0.5 * radius, radius, -distance}, radius, 0);
                     return scene;
                 });
}

}  // namespace

StressCase scaled_by_two(const MakeScene& scene, int k) {
    const double factor = std::ldexp(1.0, k);
    return labeled(fmt::format("2^{}", k), factor,
                   same_bits([=] { return scaled(scene(), factor); }));
}

StressCase scaled_by_ten(const MakeScene& scene, int k) {
    const double factor = std::pow(10.0, k);
    return labeled(fmt::format("10^{}", k), factor,
                   picture_case([=] { return scaled(scene(), factor); }));
}

StressCase moved(const MakeScene& scene, std::string label, double by) {
    return labeled(std::move(label), by, same_bits([=] {
                       return shifted(scene(), {by, -by, by < 5e8 ? 2 * by : by});
                   }));
}

StressFamilies scale_families() {
    return {powers_of_two(), powers_of_ten(), integer_shifts(), odd_shifts(), outliers()};
}

}  // namespace rt
