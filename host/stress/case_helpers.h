// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "host/stress/stress_case.h"

namespace rt {

using MakeScene = std::function<Scene()>;

// Cases, which get their names from a family.

/// A picture of the scene, compared with its reference.
inline StressCase picture_case(MakeScene scene, StressTolerance tolerance = {},
                               ReferenceKind reference = ReferenceKind::quad) {
    return {"", 0, tolerance, PictureTrial{std::move(scene), {}, reference, ""}};
}

/// The same with another scene's reference, since that scene looks the same.
inline StressCase seen_as(MakeScene reference_scene, StressCase one) {
    std::get<PictureTrial>(one.trial).reference_scene = std::move(reference_scene);
    return one;
}

inline StressCase ray_case(RayTrial trial, StressTolerance tolerance = {}) {
    return {"", 0, tolerance, std::move(trial)};
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

inline StressCase text_case(std::vector<std::string> scenes) {
    StressTolerance tolerance;
    tolerance.may_overflow = true;
    return {"", 0, tolerance, TextTrial{std::move(scenes)}};
}

/// The case with a label and a value of its own, which a sweep keeps.
inline StressCase labeled(std::string label, double value, StressCase one) {
    one.label = std::move(label);
    one.value = value;
    return one;
}

// Families.

inline std::string label_of(int value) { return std::to_string(value); }
inline std::string label_of(double value) { return fmt::format("{:g}", value); }

/// Adds a case for each value, labeled with it: make(value), which is a case, or a scene to be
/// pictured. Those of the `quick` values are part of --quick.
template <typename Value, typename Make>
StressFamily sweep(StressFamily family, const std::vector<Value>& values,
                   const std::vector<Value>& quick, const Make& make) {
    for (const Value& value : values) {
        StressCase one;
        if constexpr (std::is_same_v<std::invoke_result_t<Make, Value>, Scene>) {
            one = picture_case([=] { return make(value); });
        } else {
            one = make(value);
        }
        if constexpr (std::is_arithmetic_v<Value>) {
            if (one.label.empty()) one = labeled(label_of(value), value, std::move(one));
        }
        one.quick = std::find(quick.begin(), quick.end(), value) != quick.end();
        family.cases.push_back(std::move(one));
    }
    return family;
}

template <typename Value, typename Make>
StressFamily sweep(StressFamily family, std::initializer_list<Value> values,
                   const std::vector<Value>& quick, const Make& make) {
    return sweep(std::move(family), std::vector(values), quick, make);
}

enum class InQuick { no, yes };

struct LabeledCase {
    std::string label;
    InQuick quick;
    StressCase one;
};

/// Adds the cases, numbered from `first`.
inline StressFamily listed(StressFamily family, const std::vector<LabeledCase>& cases,
                           int first = 0) {
    for (const LabeledCase& next : cases) {
        family.cases.push_back(labeled(next.label, first++, next.one));
        family.cases.back().quick = next.quick == InQuick::yes;
    }
    return family;
}

}  // namespace rt
