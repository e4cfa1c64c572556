// SPDX-License-Identifier: Apache-2.0
#include "host/stress/ray_trials.h"

#include <array>

#include "host/flatten/flat_scene.h"
#include "host/stress/ray_dice.h"
#include "host/stress/secondary_ray.h"
#include "host/trace/closest_hit.h"

namespace rt {

namespace {

using stress::Quad;
using stress::Wide3;

/// Middle and size of the flat triangles.
struct Bounds {
    glm::dvec3 middle;
    double radius;
};

template <typename T>
Bounds bounds_of(const FlatScene<T>& flat) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const auto& triangle : flat.triangles) {
        for (const auto& p : {triangle.p0, triangle.p1, triangle.p2}) {
            low = glm::min(low, in_double(p));
            high = glm::max(high, in_double(p));
        }
    }
    const glm::dvec3 half = 0.5 * (high - low);
    return {low + half, std::min({half.x, half.y, half.z})};
}

/// The distance to the ray's sphere by the quadratic formula; negative for a miss.
template <typename T>
Quad exact_distance(const trace::Ray<T>& ray, const typename Flat<T>::Sphere& sphere) {
    const Wide3<Quad> f = in_quad(ray.origin) - in_quad(sphere.center), d = in_quad(ray.dir);
    const Quad radius = sphere.radius;
    const Quad a = dot(d, d), b = dot(f, d);
    const Quad discriminant = b * b - a * (dot(f, f) - radius * radius);
    if (!(discriminant >= 0)) return -1;
    const Quad root = stress::square_root(discriminant);
    const Quad near = (-b - root) / a;
    return near > 0 ? near : (-b + root) / a;
}

/// The far side for a ray from this point of the sphere, put onto it exactly.
template <typename T>
Quad far_side(const trace::Surface<T>& start, const Vec3<T>& dir,
              const typename Flat<T>::Sphere& sphere) {
    const Wide3<Quad> out = unit(in_quad(start.normal));
    return Quad(-2) * Quad(sphere.radius) * dot(out, unit(in_quad(dir)));
}

/// Outwards nothing must be hit; inwards the far side.
template <typename T>
void leave_sphere(const trace::SceneView<T>& view, double shallowest, Dice& dice,
                  RayFigures& figures) {
    const auto& sphere = view.spheres[0];
    const glm::dvec3 target = in_double(sphere.center) + double(sphere.radius) * dice.direction();
    const auto leaving = leave_primitive<T>(view, 0, target, shallowest, dice);
    if (!leaving) return;
    const Quad exact =
        leaving->outwards ? Quad(-1) : far_side(leaving->start, leaving->ray.dir, sphere);
    const trace::Hit<T> hit = trace::closest_hit(view, leaving->ray);
    note_hit(figures, hit.prim == 0, double(hit.t), exact, 1e-3);
}

}  // namespace

template <typename T>
RayFigures count_leaks(const Scene& mesh, RayAim aim, std::uint64_t rays) {
    const FlatScene<T> flat = flatten<T>(mesh);
    const trace::SceneView<T> view = trace::view_of(flat);
    const Bounds bounds = bounds_of(flat);
    return many_rays(rays, [&](Dice& dice, RayFigures& figures) {
        const auto& triangle = flat.triangles[dice.index(flat.triangles.size())];
        const std::array<glm::dvec3, 3> corners{in_double(triangle.p0), in_double(triangle.p1),
                                                in_double(triangle.p2)};
        const std::size_t first = dice.index(3);
        const double share = aim == RayAim::edges ? dice.uniform(0, 1) : 0;
        const glm::dvec3 target =
            corners[first] + share * (corners[(first + 1) % 3] - corners[first]);
        const double spread = 0.15 * bounds.radius * dice.uniform(0, 1);
        const Vec3<T> origin(bounds.middle + spread * dice.direction());
        const trace::Ray<T> ray = make_ray<T>(origin, target - in_double(origin));
        ++figures.rays;
        figures.failures += trace::closest_hit(view, ray).prim == Flat<T>::none ? 1 : 0;
    });
}

template <typename T>
RayFigures count_leaving_failures(const Scene& scene, double shallowest, std::uint64_t rays) {
    const FlatScene<T> flat = flatten<T>(scene);
    const trace::SceneView<T> view = trace::view_of(flat);
    return many_rays(rays, [&](Dice& dice, RayFigures& figures) {
        leave_sphere(view, shallowest, dice, figures);
    });
}

template <typename T>
RayFigures count_sphere_failures(const Scene& scene, std::uint64_t rays) {
    const FlatScene<T> flat = flatten<T>(scene);
    const trace::SceneView<T> view = trace::view_of(flat);
    const auto& sphere = flat.spheres[0];
    return many_rays(rays, [&](Dice& dice, RayFigures& figures) {
        const double reach = 1.5 * double(sphere.radius) * dice.uniform(0, 1);
        const glm::dvec3 target = in_double(sphere.center) + reach * dice.direction();
        const trace::Ray<T> ray = make_ray<T>(Vec3<T>(T(0)), target);
        const trace::Hit<T> hit = trace::closest_hit(view, ray);
        note_hit(figures, hit.prim == 0, double(hit.t), exact_distance(ray, sphere));
    });
}

template RayFigures count_leaks<float>(const Scene&, RayAim, std::uint64_t);
template RayFigures count_leaks<double>(const Scene&, RayAim, std::uint64_t);
template RayFigures count_leaving_failures<float>(const Scene&, double, std::uint64_t);
template RayFigures count_leaving_failures<double>(const Scene&, double, std::uint64_t);
template RayFigures count_sphere_failures<float>(const Scene&, std::uint64_t);
template RayFigures count_sphere_failures<double>(const Scene&, std::uint64_t);

}  // namespace rt
