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
static_assert(offsetof(Sphere, center_low) == 32);
static_assert(offsetof(Cone, material) == 36);
static_assert(offsetof(Triangle, plane) == 60);
static_assert(offsetof(VertexNormals, n2) == 32);
static_assert(offsetof(Material, transmission) == 64);
static_assert(offsetof(Light, caster_count) == 28);
static_assert(offsetof(BvhNode, count) == 28);
static_assert(offsetof(LaunchParams, pad1) == 188);
static_assert(offsetof(Tile, film_width) == 20);
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

/// The shared structs in the precision of T, float or double.
template <>
struct Flat<float> {
    using Index = f32::Index;
    using Packed3 = f32::Packed3;
    using Sphere = f32::Sphere;
    using Cone = f32::Cone;
    using Triangle = f32::Triangle;
    using VertexNormals = f32::VertexNormals;
    using Material = f32::Material;
    using Light = f32::Light;
    using BvhNode = f32::BvhNode;
    using LaunchParams = f32::LaunchParams;
    using Tile = f32::Tile;
    using RayCounts = f32::RayCounts;
    using RayQuery = f32::RayQuery;
    using RayAnswer = f32::RayAnswer;
    static constexpr Index none = f32::RT_NONE;
    static constexpr Index eye = f32::RT_EYE;
    static constexpr float roundoff = 0x1p-24f;  ///< half an ulp of 1
};

template <>
struct Flat<double> {
    using Index = f64::Index;
    using Packed3 = f64::Packed3;
    using Sphere = f64::Sphere;
    using Cone = f64::Cone;
    using Triangle = f64::Triangle;
    using VertexNormals = f64::VertexNormals;
    using Material = f64::Material;
    using Light = f64::Light;
    using BvhNode = f64::BvhNode;
    using LaunchParams = f64::LaunchParams;
    using Tile = f64::Tile;
    using RayCounts = f64::RayCounts;
    using RayQuery = f64::RayQuery;
    using RayAnswer = f64::RayAnswer;
    static constexpr Index none = f64::RT_NONE;
    static constexpr Index eye = f64::RT_EYE;
    static constexpr double roundoff = 0x1p-53;
};

template <typename T>
using Vec3 = glm::vec<3, T, glm::defaultp>;

}  // namespace rt
