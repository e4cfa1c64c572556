// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "host/stress/case_helpers.h"
#include "host/stress/families.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

/// A case that must give the same bits as the family's first.
StressCase same_bits_case(StressCase one) {
    std::get<PictureTrial>(one.trial).same_bits = "the scene as it is";
    return one;
}

Scene scaled(double factor) {
    Scene scene = still_life();
    scale_scene(scene, factor);
    return scene;
}

Scene shifted(glm::dvec3 by) {
    Scene scene = still_life();
    shift_scene(scene, by);
    return scene;
}

StressFamily powers_of_two() {
    StressFamily family{"scale-2",
                        "scale",
                        "absolute epsilons swallow small scenes and prick "
                        "large ones",
                        {}};
    family.cases.push_back(
        same_bits_case(picture_case("2^0", 1, InQuick::yes, [] { return scaled(1); })));
    for (int k = -40; k <= 40; k += 4) {
        if (k == 0) continue;
        family.cases.push_back(
            same_bits_case(picture_case(fmt::format("2^{}", k), std::ldexp(1.0, k),
                                        quick_if(k == -40 || k == -20 || k == 20 || k == 40),
                                        [k] { return scaled(std::ldexp(1.0, k)); })));
    }
    return family;
}

StressFamily powers_of_ten() {
    StressFamily family{"scale-10",
                        "scale",
                        "squares of distances leave the range of float "
                        "beyond 10^19",
                        {}};
    for (const int k :
         {-30, -25, -20, -15, -10, -6, -4, -3, -2, -1, 1, 2, 3, 4, 6, 10, 15, 20, 25, 30}) {
        family.cases.push_back(picture_case(fmt::format("10^{}", k), std::pow(10.0, k),
                                            quick_if(k == -30 || k == -3 || k == 3 || k == 30),
                                            [k] { return scaled(std::pow(10.0, k)); }));
    }
    return family;
}

StressFamily integer_shifts() {
    StressFamily family{"shift",
                        "distance from the origin",
                        "coordinates far from the origin "
                        "leave no digits for the scene",
                        {}};
    family.cases.push_back(
        same_bits_case(picture_case("0", 0, InQuick::yes, [] { return still_life(); })));
    for (int k = 1; k <= 9; ++k) {
        const double by = std::pow(10.0, k);
        family.cases.push_back(same_bits_case(
            picture_case(fmt::format("1e{}", k), by, quick_if(k == 5 || k == 9),
                         [by] { return shifted(glm::dvec3(by, -by, by < 5e8 ? 2 * by : by)); })));
    }
    return family;
}

/// Coordinates are rounded to double after the shift; the reference sees the same doubles.
StressFamily odd_shifts() {
    StressFamily family{
        "shift-odd", "distance from the origin", "offsets that float cannot represent", {}};
    for (int k = 0; k <= 9; ++k) {
        const double by = 1.1 * std::pow(10.0, k);
        family.cases.push_back(picture_case(fmt::format("1.1e{}", k), by, quick_if(k == 7), [by] {
            return shifted({by, -by / 3, by / 7});
        }));
    }
    return family;
}

/// A scene with one distant object, which must not set the scale.
StressFamily outliers() {
    StressFamily family{"outlier",
                        "distance of one ball",
                        "one thing far away must not cost the "
                        "others their digits",
                        {}};
    for (const double distance : {1e2, 1e4, 1e6, 1e9, 1e12, 1e15}) {
        family.cases.push_back(picture_case(
            fmt::format("{:g}", distance), distance, quick_if(distance == 1e9), [distance] {
                Scene scene = still_life();
                add_sphere(scene, {0.125 * distance, 0.25 * distance, -distance}, 0.25 * distance,
                           0);
                return scene;
            }));
    }
    return family;
}

}  // namespace

void add_scale_families(StressFamilies& families) {
    for (const auto make : {powers_of_two, powers_of_ten, integer_shifts, odd_shifts, outliers}) {
        families.push_back(make());
    }
}

}  // namespace rt
