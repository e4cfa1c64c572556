// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "host/base/error.h"
#include "host/flatten/bvh.h"
#include "host/flatten/flat_types.h"
#include "host/flatten/triangle_list.h"
#include "host/flatten/view_frame.h"
#include "host/scene/scene.h"

// Primitives one by one, from the author's to the renderer's frame. All arithmetic is in double;
// rounding to T comes last.
//
// Boxes that no ray that hits their contents can miss, in the arithmetic of kernels/: every
// coordinate is moved out by box_slack half-ulps of the box's largest one. The triangle test works
// on vertices rounded in the ray's frame, at most 8 half-ulps of |vertex| + |origin| off, and t is
// rounded once more; the origin's part is added to the ray (kernels/bvh.cl).
namespace rt {

/// The part of v that pack() loses by rounding; 0 in double.
template <typename T>
typename Flat<T>::Packed3 pack_low(const glm::dvec3& v) {
    const auto high = pack<T>(v);
    return pack<T>(v - glm::dvec3(high.x, high.y, high.z));
}

/// Squares of distances must stay finite in T, and those of areas in double.
template <typename T>
constexpr double farthest = sizeof(T) == sizeof(float) ? 0x1p60 : 0x1p250;

/// Whether to use intersect_huge_sphere of kernels/intersect.cl: the eye is within a radius of the
/// surface, and the radius is large in the renderer's frame, where distances are about 1, or the
/// eye much nearer than a radius.
inline bool is_huge(double radius, double distance) {
    const double gap = std::abs(distance - radius);
    return gap < radius && (radius > 32 || (radius > 0.03125 && gap < 0.03125 * radius));
}

/// The error of the difference between two points of the scene, in the renderer's frame.
inline double difference_error(const ViewFrame& view, const glm::dvec3& a, const glm::dvec3& b) {
    return 0x1p-52 * view.scale * (glm::length(a) + glm::length(b));
}

/// What a distance of 0 from a surface this large may round to.
inline double contact(double size) { return 1e-14 * size; }

/// How near to a surface the eye's rays need to be told its side, in u.
constexpr double eye_ulps = 8;

/// Where a point lies that is `gap` outside a surface: on it as far as double can tell, on one side
/// but nearer than T can tell, or elsewhere (0).
inline int side_of(double gap, double slack, double rounding) {
    if (std::abs(gap) <= slack) return f32::RT_ON;
    if (std::abs(gap) > slack + rounding) return 0;
    return gap > 0 ? f32::RT_OUTSIDE : f32::RT_INSIDE;
}

/// How far a barycentric point may lie off the plane: 4 u extent + 6 u |vertex| per axis, seen
/// along the normal (after Pharr, Jakob and Humphreys, PBR 4th ed., 6.8.5; measured in
/// docs/numerics.md).
template <typename T>
double barycentric_offset(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                          const glm::dvec3& normal) {
    const glm::dvec3 low = glm::min(a, glm::min(b, c));
    const glm::dvec3 high = glm::max(a, glm::max(b, c));
    const glm::dvec3 largest = glm::max(glm::abs(low), glm::abs(high));
    const glm::dvec3 error = 4.0 * (high - low) + 6.0 * largest;
    return static_cast<double>(Flat<T>::roundoff) * glm::dot(glm::abs(normal), error);
}

[[noreturn]] inline void refuse_distance(const glm::dvec3& scene_point, double farthest,
                                         bool is_float) {
    throw Error(
        ExitCode::input,
        fmt::format("({:g}, {:g}, {:g}) is more than {:g} times as far away as most of the scene; "
                    "move it closer{}",
                    scene_point.x, scene_point.y, scene_point.z, farthest,
                    is_float ? ", or use --precision double" : ""));
}

/// `p` is the point in the renderer's frame.
template <typename T>
typename Flat<T>::Packed3 pack_near(const glm::dvec3& p, const glm::dvec3& scene_point) {
    if (std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) > farthest<T>) {
        refuse_distance(scene_point, farthest<T>, sizeof(T) == sizeof(float));
    }
    return pack<T>(p);
}

/// Throws Error (ExitCode::input) when the point lies too far away for T.
template <typename T>
typename Flat<T>::Packed3 pack_position(const ViewFrame& view, const glm::dvec3& scene_point) {
    return pack_near<T>(view.to_view(scene_point), scene_point);
}

/// Where the point lies if it is on the shape or within ulps u of it: RT_ON as far as double can
/// tell, RT_OUTSIDE, RT_INSIDE; else 0.
template <typename T>
int side_of_sphere(const ViewFrame& view, const Scene::Sphere& sphere, const glm::dvec3& point,
                   double ulps) {
    const double radius = sphere.radius * view.scale;
    const double gap = glm::length(sphere.center - point) * view.scale - radius;
    const double slack = contact(radius) + difference_error(view, sphere.center, point);
    const double size = radius + glm::length(view.to_view(sphere.center));
    return side_of(gap, slack, ulps * static_cast<double>(Flat<T>::roundoff) * size);
}

template <typename T>
int side_of_cone(const ViewFrame& view, const Scene::Cone& cone, const glm::dvec3& point,
                 double ulps) {
    const glm::dvec3 base = (cone.base - point) * view.scale;
    const glm::dvec3 along = (cone.apex - point) * view.scale - base;
    const double length = glm::length(along), base_radius = cone.base_radius * view.scale;
    const double height = -glm::dot(base, along) / (length * length);
    if (height < 0 || height > 1) return 0;
    const double growth = cone.apex_radius * view.scale - base_radius;
    const double gap = glm::length(base + height * along) - (base_radius + height * growth);
    const double slack = contact(glm::length(base) + length + base_radius) +
                         difference_error(view, cone.base, point) +
                         difference_error(view, cone.apex, point);
    const double size = glm::length(view.to_view(cone.base)) + length + base_radius;
    return side_of(gap, slack, ulps * static_cast<double>(Flat<T>::roundoff) * size);
}

template <typename T>
typename Flat<T>::Sphere flatten_sphere(const ViewFrame& view, const Scene::Sphere& sphere) {
    typename Flat<T>::Sphere flat{};
    flat.center = pack_position<T>(view, sphere.center);
    pack_position<T>(view, sphere.center + sphere.radius);
    const double radius = sphere.radius * view.scale;
    const glm::dvec3 center = view.to_view(sphere.center);
    const double distance = glm::length(center);
    flat.center_low = pack_low<T>(center);
    flat.radius = static_cast<T>(radius);
    flat.is_huge = is_huge(radius, distance) ? 1 : 0;
    flat.power = static_cast<T>((distance - radius) * (distance + radius));
    if (view.is_perspective) {  // rounding does not move an eye next to a huge sphere
        const double ulps = flat.is_huge != 0 ? 0 : eye_ulps;
        flat.touches = side_of_sphere<T>(view, sphere, view.eye, ulps);
    }
    flat.material = sphere.material;
    return flat;
}

/// Numbers are rounded relative to the coordinates of the end that is called base: that is the
/// nearer one where the other is far away.
template <typename T>
typename Flat<T>::Cone flatten_cone(const ViewFrame& view, const Scene::Cone& given) {
    Scene::Cone cone = given;
    if (glm::length(cone.base - view.eye) > 64 * glm::length(cone.apex - view.eye)) {
        std::swap(cone.base, cone.apex);
        std::swap(cone.base_radius, cone.apex_radius);
    }
    constexpr double steepest = 0x1p60;  // its square stays finite in float
    const glm::dvec3 along = (cone.apex - cone.base) * view.scale;
    const double length = glm::length(along);
    const double slope = (cone.apex_radius - cone.base_radius) * view.scale / length;
    for (const auto& end : {cone.apex, cone.base + cone.base_radius, cone.apex + cone.apex_radius})
        pack_position<T>(view, end);
    typename Flat<T>::Cone flat{};
    flat.base = pack_position<T>(view, cone.base);
    flat.base_radius = static_cast<T>(cone.base_radius * view.scale);
    flat.axis = pack<T>(along / length);
    flat.length = static_cast<T>(length);
    flat.slope = static_cast<T>(std::clamp(slope, -steepest, steepest));
    if (view.is_perspective) flat.touches = side_of_cone<T>(view, cone, view.eye, eye_ulps);
    flat.material = cone.material;
    flat.apex_radius = static_cast<T>(cone.apex_radius * view.scale);
    return flat;
}

/// Whether the eye lies in the triangle's plane, as far as double can tell: `plane` away from it.
inline bool eye_is_in_plane(const ViewFrame& view, const TriangleList::Corners& corners,
                            const glm::dvec3& normal, double plane) {
    glm::dvec3 offsets(0), coordinates(0);
    for (const glm::dvec3& corner : corners) {
        offsets = glm::max(offsets, glm::abs(view.to_view(corner)));
        coordinates = glm::max(coordinates, glm::abs(corner));
    }
    const glm::dvec3 slopes = glm::abs(normal);
    const double error = 0x1p-52 * view.scale * glm::dot(slopes, coordinates + glm::abs(view.eye));
    return std::abs(plane) <= contact(glm::dot(slopes, offsets)) + error;
}

/// A flat triangle. Where this and its box are inlined, a large mesh takes 2 % longer to flatten.
template <typename T>
[[gnu::noinline]] typename Flat<T>::Triangle flatten_triangle(const ViewFrame& view,
                                                              const TriangleList::Corners& corners,
                                                              int material) {
    const glm::dvec3 a = view.to_view(corners[0]);
    const glm::dvec3 b = view.to_view(corners[1]);
    const glm::dvec3 c = view.to_view(corners[2]);
    const glm::dvec3 normal = unit_normal({a, b, c});
    typename Flat<T>::Triangle flat{};
    flat.p0 = pack_near<T>(a, corners[0]);
    flat.p1 = pack_near<T>(b, corners[1]);
    flat.p2 = pack_near<T>(c, corners[2]);
    flat.material = material;
    flat.smooth = Flat<T>::none;
    flat.offset = static_cast<T>(barycentric_offset<T>(a, b, c, normal));
    flat.normal = pack<T>(normal);
    const double plane = glm::dot(normal, a);
    const bool touches_eye = view.is_perspective && eye_is_in_plane(view, corners, normal, plane);
    flat.plane = touches_eye ? T(0) : static_cast<T>(plane);
    return flat;
}

template <typename T>
typename Flat<T>::VertexNormals flatten_normals(const TriangleList::Corners& normals) {
    return {pack<T>(normals[0]), 0, pack<T>(normals[1]), 0, pack<T>(normals[2]), 0};
}

/// Which materials are used by some primitive.
inline std::vector<bool> worn_materials(const Scene& scene) {
    std::vector<bool> worn(scene.materials.size(), false);
    const auto wear = [&](int material) { worn[static_cast<std::size_t>(material)] = true; };
    for (const auto& sphere : scene.spheres) wear(sphere.material);
    for (const auto& cone : scene.cones) wear(cone.material);
    for (const auto& triangle : scene.triangles) wear(triangle.material);
    for (const auto& mesh : scene.meshes) {
        for (const int material : mesh.face_materials) wear(material);
    }
    return worn;
}

/// Rounded, but not to 0, nor to a number whose reciprocal is infinite.
template <typename T>
T round_positive(double x) {
    return std::max(static_cast<T>(x), std::numeric_limits<T>::min());
}

inline bool is_black(const glm::dvec3& color) { return color == glm::dvec3(0); }

template <typename T>
typename Flat<T>::Material flatten_material(const Scene::Material& material) {
    typename Flat<T>::Material flat{};
    flat.ambient = pack<T>(material.ambient);
    flat.shininess = material.shininess == 0 ? T(0) : round_positive<T>(material.shininess);
    flat.diffuse = pack<T>(material.diffuse);
    flat.two_sided = material.two_sided ? 1 : 0;
    flat.specular = pack<T>(material.specular);
    flat.ior = round_positive<T>(material.ior);
    flat.mirror = pack<T>(material.mirror);
    flat.transmission = pack<T>(material.transmission);
    return flat;
}

/// What the materials used by some primitive do with light.
struct MaterialUse {
    bool reflects_lights = false;  ///< one is diffuse or specular
    bool mirrors = false, transmits = false;
    bool splits = false;  ///< one both mirrors and transmits
};

inline MaterialUse material_use(const Scene& scene) {
    MaterialUse use;
    const std::vector<bool> worn = worn_materials(scene);
    for (std::size_t i = 0; i < worn.size(); ++i) {
        if (!worn[i]) continue;
        const Scene::Material& material = scene.materials[i];
        const bool mirrors = !is_black(material.mirror);
        const bool transmits = !is_black(material.transmission);
        use.reflects_lights |= !is_black(material.diffuse) || !is_black(material.specular);
        use.mirrors |= mirrors;
        use.transmits |= transmits;
        use.splits |= mirrors && transmits;
    }
    return use;
}

constexpr int box_slack = 16;

/// The box from low to high, enlarged. Adding 0 turns -0 into 0, so that a minimum of several
/// boxes has the same bits in any order.
template <typename T>
BvhBox<T> enlarged(const Vec3<T>& low, const Vec3<T>& high) {
    T largest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        largest = std::max({largest, std::fabs(low[axis]), std::fabs(high[axis])});
    }
    const T slack = T(box_slack) * Flat<T>::roundoff * largest;
    BvhBox<T> box{};
    box.low = {low.x - slack + T(0), low.y - slack + T(0), low.z - slack + T(0)};
    box.high = {high.x + slack + T(0), high.y + slack + T(0), high.z + slack + T(0)};
    return box;
}

template <typename T>
Vec3<T> unpacked(const typename Flat<T>::Packed3& p) {
    return {p.x, p.y, p.z};
}

template <typename T>
BvhBox<T> box_of(const typename Flat<T>::Sphere& sphere) {
    const Vec3<T> center = unpacked<T>(sphere.center);
    return enlarged<T>(center - sphere.radius, center + sphere.radius);
}

template <typename T>
BvhBox<T> box_of(const typename Flat<T>::Cone& cone) {
    const Vec3<T> base = unpacked<T>(cone.base), axis = unpacked<T>(cone.axis);
    const Vec3<T> end = base + cone.length * axis;
    const T end_radius = cone.apex_radius;
    Vec3<T> low, high;
    for (int i = 0; i < 3; ++i) {
        // A disc's half-width along an axis, slightly more than sqrt(1 - a^2) rounds to.
        const T width = std::sqrt(std::max(T(0), T(1) - axis[i] * axis[i]) + 8 * Flat<T>::roundoff);
        low[i] = std::min(base[i] - cone.base_radius * width, end[i] - end_radius * width);
        high[i] = std::max(base[i] + cone.base_radius * width, end[i] + end_radius * width);
    }
    return enlarged<T>(low, high);
}

/// For the vertices as rounded.
template <typename T>
[[gnu::noinline]] BvhBox<T> box_of(const typename Flat<T>::Packed3& a,
                                   const typename Flat<T>::Packed3& b,
                                   const typename Flat<T>::Packed3& c) {
    return enlarged<T>(
        {std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})},
        {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})});
}

}  // namespace rt
