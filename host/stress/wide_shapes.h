// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <optional>
#include <type_traits>
#include <variant>

#include "host/scene/scene.h"

// Shapes for the reference: ray intersections and normals by textbook formulas in wide reals:
// __float128 (113 bits) or long double (64 bits), both with 15 bits of exponent. Nothing here is
// shared with the renderers.
namespace rt::stress {

using Quad = __float128;

template <typename R>
using Wide3 = glm::vec<3, R>;

// In place of GLM's, which refuse __float128.

template <typename R>
R dot(const Wide3<R>& a, const Wide3<R>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename R>
Wide3<R> cross(const Wide3<R>& a, const Wide3<R>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename R>
R magnitude(R x) {
    return x < 0 ? -x : x;
}

/// Newton's step from the long double root: 64 bits become 113.
template <typename R>
R square_root(R x) {
    if (!(x > 0)) return 0;
    const R root = std::sqrt(static_cast<long double>(x));
    return (root + x / root) / 2;
}
template <typename R>
R length(const Wide3<R>& a) {
    return square_root(dot(a, a));
}
template <typename R>
Wide3<R> unit(const Wide3<R>& a) {
    return (R(1) / length(a)) * a;
}

/// A ray that may start on primitive `from` (or -1). Hits nearer than `least` are the start itself.
template <typename R>
struct WideRay {
    Wide3<R> origin, dir;
    int from = -1;
    R least = 0;
};

/// t is negative for a miss.
template <typename R>
struct WideHit {
    R t = -1, u = 0, v = 0;
    int prim = -1;
};

template <typename R>
struct WideSurface {
    Wide3<R> point, normal, geometric;
    int material = 0;
};

template <typename R>
struct WideSphere {
    Wide3<R> center;
    R radius;
    int material;
};

/// The side of a cone's frustum: at height h along the unit axis, the radius is radius + slope h.
template <typename R>
struct WideCone {
    Wide3<R> base, axis;
    R length, radius, slope;
    int material;
};

template <typename R>
struct WideTriangle {
    Wide3<R> corner, edge1, edge2;
    Wide3<R> normal;  ///< unit
    std::optional<std::array<Wide3<R>, 3>> normals;
    int material;
};

template <typename R>
using WideShape = std::variant<WideSphere<R>, WideCone<R>, WideTriangle<R>>;

template <typename R>
WideSphere<R> wide_sphere(const Scene::Sphere& sphere) {
    return {Wide3<R>(sphere.center), R(sphere.radius), sphere.material};
}

template <typename R>
WideCone<R> wide_cone(const Scene::Cone& cone) {
    WideCone<R> wide;
    wide.base = Wide3<R>(cone.base);
    const Wide3<R> along = Wide3<R>(cone.apex) - wide.base;
    wide.length = length(along);
    wide.axis = unit(along);
    wide.radius = cone.base_radius;
    wide.slope = (R(cone.apex_radius) - R(cone.base_radius)) / wide.length;
    wide.material = cone.material;
    return wide;
}

template <typename R>
WideTriangle<R> wide_triangle(const Scene::Triangle& triangle) {
    WideTriangle<R> wide;
    wide.corner = Wide3<R>(triangle.vertices[0]);
    wide.edge1 = Wide3<R>(triangle.vertices[1]) - wide.corner;
    wide.edge2 = Wide3<R>(triangle.vertices[2]) - wide.corner;
    wide.normal = unit(cross(wide.edge1, wide.edge2));
    if (triangle.normals) {
        const auto& n = *triangle.normals;
        wide.normals = {Wide3<R>(n[0]), Wide3<R>(n[1]), Wide3<R>(n[2])};
    }
    wide.material = triangle.material;
    return wide;
}

/// A bounding sphere with a margin of 1e-9 of its radius: rejects most rays that miss the shape, in
/// long double, which takes a tenth of __float128's time.
template <typename R>
struct Bound {
    Wide3<R> center;
    long double squared_radius = 0;
};

template <typename R>
Bound<R> bound_around(const Wide3<R>& center, R squared_radius) {
    return {center, static_cast<long double>(squared_radius) * (1 + 2e-9L)};
}

template <typename R>
Bound<R> bound_of(const WideSphere<R>& sphere) {
    return bound_around(sphere.center, sphere.radius * sphere.radius);
}

template <typename R>
Bound<R> bound_of(const WideCone<R>& cone) {
    const R half = cone.length / 2;
    const R top = cone.radius + cone.slope * cone.length;
    const R widest = cone.radius > top ? cone.radius : top;
    return bound_around(cone.base + half * cone.axis, half * half + widest * widest);
}

template <typename R>
Bound<R> bound_of(const WideTriangle<R>& triangle) {
    const Wide3<R> from_corner = (R(1) / 3) * (triangle.edge1 + triangle.edge2);
    R farthest = dot(from_corner, from_corner);
    for (const Wide3<R>& edge : {triangle.edge1, triangle.edge2}) {
        const R squared = dot(edge - from_corner, edge - from_corner);
        if (squared > farthest) farthest = squared;
    }
    return bound_around(triangle.corner + from_corner, farthest);
}

/// Whether a line certainly misses the bounding sphere. The slack is a hundred times the rounding
/// error of the difference of squares.
template <typename R>
bool passes_by(const Wide3<R>& origin, const Wide3<long double>& unit_dir, const Bound<R>& bound) {
    const Wide3<long double> f = Wide3<long double>(bound.center - origin);
    const long double along = dot(f, unit_dir), squared = dot(f, f);
    return squared - along * along > bound.squared_radius + 1e-16L * squared;
}

/// How far beyond its edges a triangle reaches, so that rounding opens no gap between neighbors.
template <typename R>
constexpr R rim = std::is_same_v<R, Quad> ? R(1e-28) : R(1e-16);

/// Whether a point lies on the surface, to the last bits of a double.
template <typename R>
bool lies_on(const Wide3<R>& point, const WideSphere<R>& sphere) {
    const Wide3<R> f = point - sphere.center;
    const R squared = sphere.radius * sphere.radius;
    return magnitude(dot(f, f) - squared) <= R(1e-14) * squared;
}

template <typename R>
bool lies_on(const Wide3<R>& point, const WideCone<R>& cone) {
    const Wide3<R> w = point - cone.base;
    const R height = dot(w, cone.axis), radius = cone.radius + cone.slope * height;
    if (height < 0 || height > cone.length) return false;
    const R squared = dot(w, w) - height * height;
    return magnitude(squared - radius * radius) <= R(1e-14) * squared;
}

/// A ray that starts on a triangle needs no care.
template <typename R>
bool lies_on(const Wide3<R>&, const WideTriangle<R>&) {
    return false;
}

// hit_shape: where a ray meets a shape. `leaving`: it starts there, so that one root is known: 0.

template <typename R>
WideHit<R> hit_shape(const WideRay<R>& ray, const WideSphere<R>& sphere, bool leaving) {
    const Wide3<R> f = ray.origin - sphere.center;
    const R a = dot(ray.dir, ray.dir), b = dot(f, ray.dir);
    if (leaving) return {-2 * b / a};
    const R discriminant = b * b - a * (dot(f, f) - sphere.radius * sphere.radius);
    if (!(discriminant >= 0)) return {};
    const R root = square_root(discriminant), near = (-b - root) / a;
    return {near > ray.least ? near : (-b + root) / a};
}

/// Roots of |w + t d|^2 - h^2 = (radius + slope h)^2, h the height above the base: the nearer one
/// that lies between the rims, on the half of the double cone where the radius is positive.
template <typename R>
WideHit<R> hit_shape(const WideRay<R>& ray, const WideCone<R>& cone, bool leaving) {
    const Wide3<R> w = ray.origin - cone.base;
    const R rise = dot(ray.dir, cone.axis), height = dot(w, cone.axis);
    const R radius = cone.radius + cone.slope * height, growth = cone.slope * rise;
    const R a = dot(ray.dir, ray.dir) - rise * rise - growth * growth;
    const R b = dot(w, ray.dir) - height * rise - radius * growth;
    const R c = leaving ? R(0) : dot(w, w) - height * height - radius * radius;
    const R discriminant = b * b - a * c;
    if (!(discriminant >= 0)) return {};
    const R root = square_root(discriminant);
    const R q = b < 0 ? root - b : -root - b;
    const auto counts = [&](R t) {
        const R there = height + t * rise;
        return t > ray.least && there >= 0 && there <= cone.length && radius + t * growth >= 0;
    };
    const R one = a == 0 ? R(-1) : q / a;
    const R other = leaving || q == 0 ? R(-1) : c / q;
    const bool one_counts = counts(one), other_counts = counts(other);
    if (one_counts && other_counts) return {one < other ? one : other};
    return {one_counts ? one : (other_counts ? other : R(-1))};
}

/// Moller-Trumbore intersection.
template <typename R>
WideHit<R> hit_shape(const WideRay<R>& ray, const WideTriangle<R>& triangle, bool leaving) {
    const Wide3<R> p = cross(ray.dir, triangle.edge2);
    const R determinant = dot(triangle.edge1, p);
    if (leaving || determinant == 0) return {};
    const Wide3<R> s = ray.origin - triangle.corner;
    const R u = dot(s, p) / determinant;
    if (!(u >= -rim<R> && u <= 1 + rim<R>)) return {};
    const Wide3<R> q = cross(s, triangle.edge1);
    const R v = dot(ray.dir, q) / determinant;
    if (!(v >= -rim<R> && u + v <= 1 + rim<R>)) return {};
    return {dot(triangle.edge2, q) / determinant, u, v};
}

// surface_at: of a shape, where a ray hits it.

template <typename R>
WideSurface<R> surface_at(const WideRay<R>& ray, const WideHit<R>& hit,
                          const WideSphere<R>& sphere) {
    const Wide3<R> normal = unit(ray.origin - sphere.center + hit.t * ray.dir);
    return {sphere.center + sphere.radius * normal, normal, normal, sphere.material};
}

template <typename R>
WideSurface<R> surface_at(const WideRay<R>& ray, const WideHit<R>& hit, const WideCone<R>& cone) {
    const Wide3<R> along = ray.origin - cone.base + hit.t * ray.dir;
    const R height = dot(along, cone.axis);
    const Wide3<R> spoke = along - height * cone.axis;
    if (!(dot(spoke, spoke) > 0)) {  // the tip has no normal
        return {cone.base + along, -ray.dir, -ray.dir, cone.material};
    }
    const Wide3<R> outwards = unit(spoke);
    const R radius = cone.radius + cone.slope * height;
    const Wide3<R> normal = unit(outwards - cone.slope * cone.axis);
    const Wide3<R> point = cone.base + height * cone.axis + radius * outwards;
    return {point, normal, normal, cone.material};
}

/// Vertex normals are interpolated; the face normal is used where the interpolated one vanishes.
template <typename R>
WideSurface<R> surface_at(const WideRay<R>&, const WideHit<R>& hit,
                          const WideTriangle<R>& triangle) {
    const Wide3<R> point = triangle.corner + hit.u * triangle.edge1 + hit.v * triangle.edge2;
    WideSurface<R> surface{point, triangle.normal, triangle.normal, triangle.material};
    if (!triangle.normals) return surface;
    const auto& n = *triangle.normals;
    const Wide3<R> blend = (1 - hit.u - hit.v) * n[0] + hit.u * n[1] + hit.v * n[2];
    if (dot(blend, blend) > R(1e-12)) surface.normal = unit(blend);
    if (dot(surface.normal, triangle.normal) < 0) surface.geometric = -triangle.normal;
    return surface;
}

}  // namespace rt::stress
