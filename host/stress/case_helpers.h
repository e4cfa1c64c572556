// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "host/stress/stress_case.h"

namespace rt {

enum class InQuick { no, yes };

/// A case that compares a picture of the scene with its reference.
inline StressCase picture_case(std::string label, double value, InQuick quick,
                               std::function<Scene()> scene, StressTolerance tolerance = {},
                               ReferenceKind reference = ReferenceKind::quad) {
    PictureTrial trial{std::move(scene), {}, reference, ""};
    return {std::move(label), value, tolerance, std::move(trial), quick == InQuick::yes};
}

inline StressCase ray_case(std::string label, double value, InQuick quick, RayTrial trial,
                           StressTolerance tolerance = {}) {
    return {std::move(label), value, tolerance, std::move(trial), quick == InQuick::yes};
}

/// A trial that runs count<T>(rays, caster), a generic lambda over T, in float and in double.
template <typename Count>
RayTrial both_precisions(const Count& count) {
    RayTrial trial;
    trial.in_float = [=](std::uint64_t rays, const RayCaster& caster) {
        return count.template operator()<float>(rays, caster);
    };
    trial.in_double = [=](std::uint64_t rays, const RayCaster& caster) {
        return count.template operator()<double>(rays, caster);
    };
    return trial;
}

inline StressCase text_case(std::string label, double value, InQuick quick,
                            std::vector<std::string> scenes) {
    StressTolerance tolerance;
    tolerance.may_overflow = true;
    return {std::move(label), value, tolerance, TextTrial{std::move(scenes)},
            quick == InQuick::yes};
}

inline InQuick quick_if(bool yes) { return yes ? InQuick::yes : InQuick::no; }

}  // namespace rt
