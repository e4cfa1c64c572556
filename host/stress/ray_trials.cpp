// SPDX-License-Identifier: Apache-2.0
#include "host/stress/ray_trials.h"

#include <array>

#include "host/flatten/flat_scene.h"
#include "host/render/threads_renderer.h"
#include "host/stress/ray_dice.h"
#include "host/stress/secondary_ray.h"

namespace rt {

namespace {

using stress::Quad;
using stress::Wide3;

/// Center and smallest half extent of the flat triangles.
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

/// The ray's exact distance to the sphere, by the quadratic formula; negative for a miss.
template <typename T>
Quad exact_distance(const typename Flat<T>::RayQuery& ray, const typename Flat<T>::Sphere& sphere) {
    const Wide3<Quad> f = in_quad(ray.origin) - in_quad(sphere.center), d = in_quad(ray.dir);
    const Quad radius = sphere.radius;
    const Quad a = dot(d, d), b = dot(f, d);
    const Quad discriminant = b * b - a * (dot(f, f) - radius * radius);
    if (!(discriminant >= 0)) return -1;
    const Quad root = stress::square_root(discriminant);
    const Quad near = (-b - root) / a;
    return near > 0 ? near : (-b + root) / a;
}

/// Distance to the far side, for a ray from the exact point of the sphere with this normal.
template <typename P, typename Sphere>
Quad far_side(const P& normal, const P& dir, const Sphere& sphere) {
    return Quad(-2) * Quad(sphere.radius) * dot(unit(in_quad(normal)), unit(in_quad(dir)));
}

}  // namespace

RayCaster threads_ray_caster(int lanes) {
    ThreadsOptions options;
    options.kernels.lanes = lanes;
    return {[=](const auto& scene) { return make_threads_ray_tracer<float>(scene, options); },
            [=](const auto& scene) { return make_threads_ray_tracer<double>(scene, options); }};
}

template <typename T>
RayFigures count_leaks(const Scene& mesh, RayAim aim, std::uint64_t rays, const RayCaster& caster) {
    const FlatScene<T> flat = flatten<T>(mesh);
    const Bounds bounds = bounds_of(flat);
    const auto make = [&](Dice& dice) {
        const auto& triangle = flat.triangles[dice.index(flat.triangles.size())];
        const std::array<glm::dvec3, 3> corners{in_double(triangle.p0), in_double(triangle.p1),
                                                in_double(triangle.p2)};
        const std::size_t first = dice.index(3);
        const double share = aim == RayAim::edges ? dice.uniform(0, 1) : 0;
        const glm::dvec3 target =
            corners[first] + share * (corners[(first + 1) % 3] - corners[first]);
        const double spread = 0.15 * bounds.radius * dice.uniform(0, 1);
        const glm::dvec3 origin = in_double(pack<T>(bounds.middle + spread * dice.direction()));
        return ray_query<T>(origin, target - origin);
    };
    return many_rays<T>(caster.tracer(flat), rays, make, nullptr,
                        [](const auto&, const auto& answer, RayFigures& figures) {
                            ++figures.rays;
                            figures.failures += answer.prim == Flat<T>::none ? 1 : 0;
                        });
}

/// Outwards, nothing must be hit; inwards, the far side.
template <typename T>
RayFigures count_leaving_failures(const Scene& scene, double shallowest, std::uint64_t rays,
                                  const RayCaster& caster) {
    const FlatScene<T> flat = flatten<T>(scene);
    const auto& sphere = flat.spheres[0];
    const auto make = [&](Dice& dice) {
        return ray_query<T>(glm::dvec3(0),
                            in_double(sphere.center) + double(sphere.radius) * dice.direction());
    };
    const auto go_on = [=](Dice& dice, auto& query, const auto& answer) {
        leave_primitive<T>(dice, query, answer, 0, shallowest);
    };
    return many_rays<T>(caster.tracer(flat), rays, make, go_on,
                        [&](const auto& query, const auto& answer, RayFigures& figures) {
                            if (!has_left<T>(query)) return;
                            const Quad exact = is_outwards<T>(query, answer)
                                                   ? Quad(-1)
                                                   : far_side(answer.normal, query.next, sphere);
                            note_hit(figures, answer.next_prim == 0, double(answer.next_t), exact,
                                     1e-3);
                        });
}

template <typename T>
RayFigures count_sphere_failures(const Scene& scene, std::uint64_t rays, const RayCaster& caster) {
    const FlatScene<T> flat = flatten<T>(scene);
    const auto& sphere = flat.spheres[0];
    const auto make = [&](Dice& dice) {
        const double reach = 1.5 * double(sphere.radius) * dice.uniform(0, 1);
        return ray_query<T>(glm::dvec3(0), in_double(sphere.center) + reach * dice.direction());
    };
    return many_rays<T>(caster.tracer(flat), rays, make, nullptr,
                        [&](const auto& query, const auto& answer, RayFigures& figures) {
                            note_hit(figures, answer.prim == 0, double(answer.t),
                                     exact_distance<T>(query, sphere));
                        });
}

template RayFigures count_leaks<float>(const Scene&, RayAim, std::uint64_t, const RayCaster&);
template RayFigures count_leaks<double>(const Scene&, RayAim, std::uint64_t, const RayCaster&);
template RayFigures count_leaving_failures<float>(const Scene&, double, std::uint64_t,
                                                  const RayCaster&);
template RayFigures count_leaving_failures<double>(const Scene&, double, std::uint64_t,
                                                   const RayCaster&);
template RayFigures count_sphere_failures<float>(const Scene&, std::uint64_t, const RayCaster&);
template RayFigures count_sphere_failures<double>(const Scene&, std::uint64_t, const RayCaster&);

}  // namespace rt
