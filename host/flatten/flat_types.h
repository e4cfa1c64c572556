// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

// kernels/shared.h once in float and once in double: the renderer's structs, row for row as the
// kernels see them.
#define RT_STATIC_ASSERT(condition) static_assert(condition)
#define RT_COUNT std::uint64_t

namespace rt::f32 {
#define RT_REAL float
#define RT_INDEX std::int32_t
#include "kernels/shared.h"
#undef RT_REAL
#undef RT_INDEX
static_assert(offsetof(RayQuery, self_hit) == 44);
static_assert(offsetof(RayAnswer, next_t) == 48);
}  // namespace rt::f32

namespace rt::f64 {
#define RT_REAL double
#define RT_INDEX std::int64_t
#include "kernels/shared.h"
#undef RT_REAL
#undef RT_INDEX
}  // namespace rt::f64

#undef RT_STATIC_ASSERT
#undef RT_COUNT

namespace rt {

template <typename T>
struct Flat;

/// The shared structs in the precision of T, float or double; roundoff: half an ulp of 1.
#define RT_FLAT(T, of, half_ulp)                   \
    template <>                                    \
    struct Flat<T> {                               \
        using Index = of::Index;                   \
        using Packed3 = of::Packed3;               \
        using Sphere = of::Sphere;                 \
        using Cone = of::Cone;                     \
        using Triangle = of::Triangle;             \
        using VertexNormals = of::VertexNormals;   \
        using Material = of::Material;             \
        using Light = of::Light;                   \
        using BvhNode = of::BvhNode;               \
        using LaunchParams = of::LaunchParams;     \
        using Tile = of::Tile;                     \
        using RayCounts = of::RayCounts;           \
        using RayQuery = of::RayQuery;             \
        using RayAnswer = of::RayAnswer;           \
        static constexpr Index none = of::RT_NONE; \
        static constexpr Index eye = of::RT_EYE;   \
        static constexpr T roundoff = half_ulp;    \
    }
RT_FLAT(float, f32, 0x1p-24f);
RT_FLAT(double, f64, 0x1p-53);
#undef RT_FLAT

template <typename T>
using Vec3 = glm::vec<3, T, glm::defaultp>;

template <typename T>
typename Flat<T>::Packed3 pack(const glm::dvec3& v) {
    return {static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)};
}

template <typename P>
glm::dvec3 in_double(const P& p) {
    return {double(p.x), double(p.y), double(p.z)};
}

}  // namespace rt
