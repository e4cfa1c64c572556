// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <type_traits>

#include "host/scene/scene.h"
#include "host/stress/wide_real.h"

// Shapes for the reference: ray intersections and normals by textbook formulas in wide reals.
namespace rt::stress {

/// A ray that may start on primitive `from` (or -1). Hits nearer than `least` are the start itself.
template <typename R>
struct WideRay {
    Wide3<R> origin, dir;
    int from = -1;
    R least = 0;
};

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
struct WideFrustum {
    Wide3<R> base, axis;
    R length, radius, slope;
    int material;
};

template <typename R>
struct WideFace {
    Wide3<R> corner, edge1, edge2;
    Wide3<R> normal;  ///< unit
    std::optional<std::array<Wide3<R>, 3>> normals;
    int material;
};

template <typename R>
WideSphere<R> wide_sphere(const Scene::Sphere& sphere) {
    return {widened<R>(sphere.center), R(sphere.radius), sphere.material};
}

template <typename R>
WideFrustum<R> wide_frustum(const Scene::Cone& cone) {
    WideFrustum<R> frustum;
    frustum.base = widened<R>(cone.base);
    const Wide3<R> along = widened<R>(cone.apex) - frustum.base;
    frustum.length = length(along);
    frustum.axis = unit(along);
    frustum.radius = cone.base_radius;
    frustum.slope = (R(cone.apex_radius) - R(cone.base_radius)) / frustum.length;
    frustum.material = cone.material;
    return frustum;
}

template <typename R>
WideFace<R> wide_face(const Scene::Triangle& triangle) {
    WideFace<R> face;
    face.corner = widened<R>(triangle.vertices[0]);
    face.edge1 = widened<R>(triangle.vertices[1]) - face.corner;
    face.edge2 = widened<R>(triangle.vertices[2]) - face.corner;
    face.normal = unit(cross(face.edge1, face.edge2));
    if (triangle.normals) {
        const auto& n = *triangle.normals;
        face.normals = {widened<R>(n[0]), widened<R>(n[1]), widened<R>(n[2])};
    }
    face.material = triangle.material;
    return face;
}

/// A bounding sphere with a margin of 1e-9 of its radius: rejects most rays that miss the shape, in
/// long double, which takes a tenth of __float128's time.
template <typename R>
struct Ball {
    Wide3<R> center;
    long double squared_radius = 0;
};

template <typename R>
Wide3<long double> narrowed(const Wide3<R>& v) {
    return {static_cast<long double>(v.x), static_cast<long double>(v.y),
            static_cast<long double>(v.z)};
}

template <typename R>
Ball<R> ball_around(const Wide3<R>& center, R squared_radius) {
    return {center, static_cast<long double>(squared_radius) * (1 + 2e-9L)};
}

template <typename R>
Ball<R> ball_of(const WideSphere<R>& sphere) {
    return ball_around(sphere.center, sphere.radius * sphere.radius);
}

template <typename R>
Ball<R> ball_of(const WideFrustum<R>& frustum) {
    const R half = frustum.length / 2;
    const R top = frustum.radius + frustum.slope * frustum.length;
    const R widest = frustum.radius > top ? frustum.radius : top;
    return ball_around(frustum.base + half * frustum.axis, half * half + widest * widest);
}

template <typename R>
Ball<R> ball_of(const WideFace<R>& face) {
    const Wide3<R> from_corner = (R(1) / 3) * (face.edge1 + face.edge2);
    R farthest = dot(from_corner, from_corner);
    for (const Wide3<R>& edge : {face.edge1, face.edge2}) {
        const R squared = dot(edge - from_corner, edge - from_corner);
        if (squared > farthest) farthest = squared;
    }
    return ball_around(face.corner + from_corner, farthest);
}

/// Whether a line certainly misses the ball. The slack is a hundred times the rounding error of the
/// difference of squares.
template <typename R>
bool passes_by(const Wide3<R>& origin, const Wide3<long double>& unit_dir, const Ball<R>& ball) {
    const Wide3<long double> f = narrowed(ball.center - origin);
    const long double along = dot(f, unit_dir), squared = dot(f, f);
    return squared - along * along > ball.squared_radius + 1e-16L * squared;
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
bool lies_on(const Wide3<R>& point, const WideFrustum<R>& frustum) {
    const Wide3<R> w = point - frustum.base;
    const R height = dot(w, frustum.axis), radius = frustum.radius + frustum.slope * height;
    if (height < 0 || height > frustum.length) return false;
    const R squared = dot(w, w) - height * height;
    return magnitude(squared - radius * radius) <= R(1e-14) * squared;
}

/// Distance to the sphere, negative for a miss. For a ray that leaves it, one root is known: 0.
template <typename R>
R hit_sphere(const WideRay<R>& ray, const WideSphere<R>& sphere, bool leaving) {
    const Wide3<R> f = ray.origin - sphere.center;
    const R b = dot(f, ray.dir);
    if (leaving) return -2 * b;
    const R discriminant = b * b - (dot(f, f) - sphere.radius * sphere.radius);
    if (!(discriminant >= 0)) return -1;
    const R root = square_root(discriminant);
    return -b - root > ray.least ? -b - root : -b + root;
}

/// Roots of |w + t d|^2 - h^2 = (radius + slope h)^2, h the height above the base: the nearer one
/// that lies between the rims, on the half of the double cone where the radius is positive.
template <typename R>
R hit_frustum(const WideRay<R>& ray, const WideFrustum<R>& frustum, bool leaving) {
    const Wide3<R> w = ray.origin - frustum.base;
    const R rise = dot(ray.dir, frustum.axis), height = dot(w, frustum.axis);
    const R radius = frustum.radius + frustum.slope * height, growth = frustum.slope * rise;
    const R a = dot(ray.dir, ray.dir) - rise * rise - growth * growth;
    const R b = dot(w, ray.dir) - height * rise - radius * growth;
    const R c = leaving ? R(0) : dot(w, w) - height * height - radius * radius;
    const R discriminant = b * b - a * c;
    if (!(discriminant >= 0)) return -1;
    const R root = square_root(discriminant);
    const R q = b < 0 ? root - b : -root - b;
    const auto counts = [&](R t) {
        const R there = height + t * rise;
        return t > ray.least && there >= 0 && there <= frustum.length && radius + t * growth >= 0;
    };
    const R one = a == 0 ? R(-1) : q / a;
    const R other = leaving || q == 0 ? R(-1) : c / q;
    const bool one_counts = counts(one), other_counts = counts(other);
    if (one_counts && other_counts) return one < other ? one : other;
    return one_counts ? one : (other_counts ? other : R(-1));
}

/// Moller-Trumbore intersection.
template <typename R>
R hit_face(const WideRay<R>& ray, const WideFace<R>& face, R& u, R& v) {
    const Wide3<R> p = cross(ray.dir, face.edge2);
    const R determinant = dot(face.edge1, p);
    if (determinant == 0) return -1;
    const Wide3<R> s = ray.origin - face.corner;
    u = dot(s, p) / determinant;
    if (!(u >= -rim<R> && u <= 1 + rim<R>)) return -1;
    const Wide3<R> q = cross(s, face.edge1);
    v = dot(ray.dir, q) / determinant;
    if (!(v >= -rim<R> && u + v <= 1 + rim<R>)) return -1;
    return dot(face.edge2, q) / determinant;
}

template <typename R>
WideSurface<R> sphere_surface(const WideRay<R>& ray, R t, const WideSphere<R>& sphere) {
    const Wide3<R> normal = unit(ray.origin - sphere.center + t * ray.dir);
    return {sphere.center + sphere.radius * normal, normal, normal, sphere.material};
}

template <typename R>
WideSurface<R> frustum_surface(const WideRay<R>& ray, R t, const WideFrustum<R>& frustum) {
    const Wide3<R> along = ray.origin - frustum.base + t * ray.dir;
    const R height = dot(along, frustum.axis);
    const Wide3<R> spoke = along - height * frustum.axis;
    if (!(dot(spoke, spoke) > 0)) {  // the tip has no normal
        return {frustum.base + along, -ray.dir, -ray.dir, frustum.material};
    }
    const Wide3<R> outwards = unit(spoke);
    const R radius = frustum.radius + frustum.slope * height;
    const Wide3<R> normal = unit(outwards - frustum.slope * frustum.axis);
    const Wide3<R> point = frustum.base + height * frustum.axis + radius * outwards;
    return {point, normal, normal, frustum.material};
}

/// Vertex normals are interpolated; the face normal is used where the interpolated one vanishes.
template <typename R>
WideSurface<R> face_surface(const WideHit<R>& hit, const WideFace<R>& face) {
    const Wide3<R> point = face.corner + hit.u * face.edge1 + hit.v * face.edge2;
    WideSurface<R> surface{point, face.normal, face.normal, face.material};
    if (!face.normals) return surface;
    const auto& n = *face.normals;
    const Wide3<R> blend = (1 - hit.u - hit.v) * n[0] + hit.u * n[1] + hit.v * n[2];
    if (dot(blend, blend) > R(1e-12)) surface.normal = unit(blend);
    if (dot(surface.normal, face.normal) < 0) surface.geometric = -face.normal;
    return surface;
}

}  // namespace rt::stress
