// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/trace/math.h"
#include "host/trace/scene_view.h"

// Twin of kernels/intersect.cl: one ray against one primitive; the method is described there.
namespace rt::trace {

/// A huge sphere by the constant term of its quadratic, |origin|^2 - 2 origin.center + power.
template <typename T>
T intersect_huge_sphere(const Ray<T>& ray, const typename Flat<T>::Sphere& sphere) {
    const Vec3<T> center = load3(sphere.center);
    const T squared_radius = sphere.radius * sphere.radius;
    const T c = (dot3(ray.origin, ray.origin) - T(2) * dot3(ray.origin, center)) + sphere.power;
    const Vec3<T> f = ray.origin - center;
    const T b = -dot3(f, ray.dir);
    const Vec3<T> l = add_scaled(f, b, ray.dir);
    const T discriminant =
        squared_radius > b * b ? std::fma(b, b, -c) : squared_radius - dot3(l, l);
    if (!(discriminant >= T(0))) return T(-1);
    const T s = std::sqrt(discriminant);
    const T q = b < T(0) ? b - s : b + s;
    const T other = q == T(0) ? q : c / q;
    const T near = min_of(q, other);
    return near > T(0) ? near : max_of(q, other);
}

/// Distance along the ray to sphere number prim, or -1: to the nearer end in front of the origin,
/// else to the farther one. From the sphere it starts on, to the far end of its chord.
template <typename T>
RT_INLINE T intersect_sphere(const Ray<T>& ray, const typename Flat<T>::Sphere& sphere,
                             typename Flat<T>::Index prim) {
    const Vec3<T> center = load3(sphere.center);
    if (ray.from == prim) return ray.chord;
    if (sphere.touches_eye != 0 && ray.from == Flat<T>::eye) return T(2) * dot3(center, ray.dir);
    if (sphere.is_huge != 0) return intersect_huge_sphere(ray, sphere);
    const Vec3<T> f = ray.origin - center;
    const T b = -dot3(f, ray.dir);
    const Vec3<T> l = add_scaled(f, b, ray.dir);
    const T discriminant = sphere.radius * sphere.radius - dot3(l, l);
    if (!(discriminant >= T(0))) return T(-1);
    const T s = std::sqrt(discriminant);
    const T near = b - s;
    return near > T(0) ? near : b + s;
}

/// Whether a ray to a light ends on the sphere rather than being blocked by it at t: the light lies
/// on the sphere, within the rounding of its nearer root.
template <typename T>
bool ends_on_sphere(const Ray<T>& ray, const typename Flat<T>::Sphere& sphere, T t) {
    const T b = dot3(load3(sphere.center) - ray.origin, ray.dir);
    const T slack = T(8) * Flat<T>::roundoff * sphere.radius * sphere.radius;
    return t < b && (ray.t_max - t) * (b - t) <= slack;
}

/// The ray's frame: axis z is where its direction is largest, x and y the next two in turn.
template <typename T>
struct RayShear {
    int kx, ky, kz;
    T origin_x, origin_y, origin_z;
    T sx, sy, sz;
};

template <typename T>
RT_INLINE T component3(const Vec3<T>& v, int k) {
    return k == 0 ? v.x : (k == 1 ? v.y : v.z);
}

template <typename T>
RT_INLINE RayShear<T> make_shear(const Ray<T>& ray) {
    const Vec3<T> a = abs3(ray.dir);
    RayShear<T> shear;
    shear.kz = a.x > a.y ? (a.x > a.z ? 0 : 2) : (a.y > a.z ? 1 : 2);
    shear.kx = shear.kz == 2 ? 0 : shear.kz + 1;
    shear.ky = shear.kx == 2 ? 0 : shear.kx + 1;
    shear.origin_x = component3(ray.origin, shear.kx);
    shear.origin_y = component3(ray.origin, shear.ky);
    shear.origin_z = component3(ray.origin, shear.kz);
    shear.sz = T(1) / component3(ray.dir, shear.kz);
    shear.sx = component3(ray.dir, shear.kx) * shear.sz;
    shear.sy = component3(ray.dir, shear.ky) * shear.sz;
    return shear;
}

/// The vertex in the ray's frame. Its components are picked as they are loaded.
template <typename T>
RT_INLINE Vec3<T> shear_vertex(const RayShear<T>& shear, const typename Flat<T>::Packed3& vertex) {
    const T* p = &vertex.x;
    const T z = p[shear.kz] - shear.origin_z;
    return {std::fma(-shear.sx, z, p[shear.kx] - shear.origin_x),
            std::fma(-shear.sy, z, p[shear.ky] - shear.origin_y), z};
}

/// Distance along the ray to the triangle's plane; NaN or infinite where it runs in it.
template <typename T>
T plane_distance(const RayShear<T>& shear, const typename Flat<T>::Triangle& triangle) {
    const T* n = &triangle.normal.x;
    const T height = std::fma(n[shear.kz], shear.origin_z,
                              std::fma(n[shear.ky], shear.origin_y, n[shear.kx] * shear.origin_x));
    const T slope = std::fma(n[shear.kx], shear.sx, std::fma(n[shear.ky], shear.sy, n[shear.kz]));
    return (triangle.plane - height) * shear.sz / slope;
}

/// Distance along the ray to the triangle, or -1; u and v are set on a hit.
template <typename T>
RT_INLINE T intersect_triangle(const RayShear<T>& shear, const typename Flat<T>::Triangle& triangle,
                               T& u, T& v) {
    const Vec3<T> a = shear_vertex(shear, triangle.p0);
    const Vec3<T> b = shear_vertex(shear, triangle.p1);
    const Vec3<T> c = shear_vertex(shear, triangle.p2);
    const T wa = difference_of_products(c.x, b.y, c.y, b.x);
    const T wb = difference_of_products(a.x, c.y, a.y, c.x);
    const T wc = difference_of_products(b.x, a.y, b.y, a.x);
    const bool front = min_of(wa, min_of(wb, wc)) >= T(0);
    const bool back = max_of(wa, max_of(wb, wc)) <= T(0);
    if (!front && !back) return T(-1);
    const T determinant = wa + wb + wc;
    if (determinant == T(0)) return T(-1);
    const T inverse = T(1) / determinant;
    u = wb * inverse;
    v = wc * inverse;
    const T t = std::fma(wa, a.z, std::fma(wb, b.z, wc * c.z)) * shear.sz * inverse;
    const T reach =
        max_of(max_of(std::fabs(a.z), std::fabs(b.z)), std::fabs(c.z)) * std::fabs(shear.sz);
    return reach > T(8) * std::fabs(t) ? plane_distance(shear, triangle) : t;
}

}  // namespace rt::trace
