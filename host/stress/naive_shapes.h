// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "host/scene/scene.h"

// Textbook ray intersections in the arithmetic of T, with absolute epsilons. For comparison only.
namespace rt::naive {

template <typename T>
using Vec = glm::vec<3, T, glm::defaultp>;

template <typename T>
struct Sphere {
    Vec<T> center;
    T radius;
    int material;
};

/// The side of a frustum: at height h along the unit axis, the radius is radius + slope h.
template <typename T>
struct Cone {
    Vec<T> base, axis;
    T length, radius, slope;
    int material;
};

template <typename T>
struct Face {
    Vec<T> corner, edge1, edge2, normal;
    std::array<Vec<T>, 3> normals;
    bool smooth;
    int material;
};

template <typename T>
struct Surface {
    Vec<T> normal, geometric;
    int material;
};

template <typename T>
Sphere<T> make_sphere(const Scene::Sphere& sphere) {
    return {Vec<T>(sphere.center), T(sphere.radius), sphere.material};
}

template <typename T>
Cone<T> make_cone(const Scene::Cone& cone) {
    const Vec<T> base(cone.base), along = Vec<T>(cone.apex) - base;
    const T length = glm::length(along);
    const T slope = (T(cone.apex_radius) - T(cone.base_radius)) / length;
    return {base, along / length, length, T(cone.base_radius), slope, cone.material};
}

template <typename T>
Face<T> make_face(const Scene::Triangle& triangle) {
    Face<T> face{};
    face.corner = Vec<T>(triangle.vertices[0]);
    face.edge1 = Vec<T>(triangle.vertices[1]) - face.corner;
    face.edge2 = Vec<T>(triangle.vertices[2]) - face.corner;
    face.normal = glm::normalize(glm::cross(face.edge1, face.edge2));
    face.smooth = triangle.normals.has_value();
    for (std::size_t i = 0; face.smooth && i < 3; ++i) {
        face.normals[i] = Vec<T>((*triangle.normals)[i]);
    }
    face.material = triangle.material;
    return face;
}

/// The nearer root beyond `least`, by the quadratic formula; negative for none.
template <typename T>
T hit_sphere(const Vec<T>& origin, const Vec<T>& dir, const Sphere<T>& sphere, T least) {
    const Vec<T> f = origin - sphere.center;
    const T a = glm::dot(dir, dir);
    const T b = T(2) * glm::dot(f, dir);
    const T c = glm::dot(f, f) - sphere.radius * sphere.radius;
    const T discriminant = b * b - T(4) * a * c;
    if (discriminant < T(0)) return T(-1);
    const T root = std::sqrt(discriminant);
    const T near = (-b - root) / (T(2) * a);
    return near > least ? near : (-b + root) / (T(2) * a);
}

template <typename T>
T hit_cone(const Vec<T>& origin, const Vec<T>& dir, const Cone<T>& cone, T least) {
    const Vec<T> w = origin - cone.base;
    const T rise = glm::dot(dir, cone.axis), height = glm::dot(w, cone.axis);
    const T radius = cone.radius + cone.slope * height, growth = cone.slope * rise;
    const T a = glm::dot(dir, dir) - rise * rise - growth * growth;
    const T b = T(2) * (glm::dot(w, dir) - height * rise - radius * growth);
    const T c = glm::dot(w, w) - height * height - radius * radius;
    const T discriminant = b * b - T(4) * a * c;
    if (discriminant < T(0)) return T(-1);
    const T root = std::sqrt(discriminant);
    T best = T(-1);
    for (const T t : {(-b - root) / (T(2) * a), (-b + root) / (T(2) * a)}) {
        const T there = height + t * rise;
        if (!(t > least) || there < T(0) || there > cone.length) continue;
        if (radius + t * growth >= T(0) && (best < T(0) || t < best)) best = t;
    }
    return best;
}

/// Moller-Trumbore intersection.
template <typename T>
T hit_face(const Vec<T>& origin, const Vec<T>& dir, const Face<T>& face, T& u, T& v) {
    const Vec<T> p = glm::cross(dir, face.edge2);
    const T determinant = glm::dot(face.edge1, p);
    if (std::fabs(determinant) < T(1e-8)) return T(-1);
    const T inverse = T(1) / determinant;
    const Vec<T> s = origin - face.corner;
    u = glm::dot(s, p) * inverse;
    if (u < T(0) || u > T(1)) return T(-1);
    const Vec<T> q = glm::cross(s, face.edge1);
    v = glm::dot(dir, q) * inverse;
    if (v < T(0) || u + v > T(1)) return T(-1);
    return glm::dot(face.edge2, q) * inverse;
}

template <typename T>
Surface<T> cone_surface(const Vec<T>& point, const Cone<T>& cone) {
    const Vec<T> w = point - cone.base;
    const Vec<T> outwards = glm::normalize(w - glm::dot(w, cone.axis) * cone.axis);
    const Vec<T> normal = glm::normalize(outwards - cone.slope * cone.axis);
    return {normal, normal, cone.material};
}

template <typename T>
Surface<T> face_surface(const Face<T>& face, T u, T v) {
    Surface<T> surface{face.normal, face.normal, face.material};
    if (!face.smooth) return surface;
    const auto& n = face.normals;
    surface.normal = glm::normalize((T(1) - u - v) * n[0] + u * n[1] + v * n[2]);
    if (glm::dot(surface.normal, face.normal) < T(0)) surface.geometric = -face.normal;
    return surface;
}

}  // namespace rt::naive
