// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <optional>

#include "host/flatten/flat_scene.h"
#include "host/render/threads_renderer.h"
#include "host/stress/families.h"
#include "host/stress/many_rays.h"
#include "host/stress/wide_shapes.h"

namespace rt {

namespace {

using stress::Quad;
using stress::Wide3;

template <typename V>
Wide3<Quad> in_quad(const V& v) {
    return {Quad(v.x), Quad(v.y), Quad(v.z)};
}

/// Counts a ray that hit (`found`) at t, or missed; `exact` is the correct distance, not positive
/// for a miss. A failure is a false hit, a missed hit, or a relative error above the tolerance.
void note_hit(RayFigures& figures, bool found, double t, Quad exact,
              double tolerance = std::numeric_limits<double>::infinity()) {
    const bool expected = exact > 0;
    const double error =
        found && expected ? static_cast<double>(stress::magnitude((Quad(t) - exact) / exact)) : 0;
    ++figures.rays;
    figures.failures += found == expected && error <= tolerance ? 0 : 1;
    figures.max_error = std::max(figures.max_error, error);
}

/// Continues an eye ray from its hit on primitive prim, three times in four outwards: two in three
/// at less than 0.1 rad above the surface, down to 1e-6. Inwards, down to `shallowest`.
template <typename T>
void leave_primitive(RandomNumbers& random, typename Flat<T>::RayQuery& query,
                     const typename Flat<T>::RayAnswer& answer, typename Flat<T>::Index prim,
                     double shallowest) {
    if (answer.prim != prim) return;
    const glm::dvec3 normal = glm::normalize(in_double(answer.normal));
    constexpr double steepest = std::numbers::pi / 2;
    const double angle = random.index(4) == 0   ? -random.log_uniform(shallowest, steepest)
                         : random.index(3) == 0 ? random.uniform(0.1, steepest)
                                                : random.log_uniform(1e-6, 0.1);
    query.next = rounded_unit<T>(at_angle(random, normal, angle));
}

/// Whether to the normal's side.
template <typename T>
bool is_outwards(const typename Flat<T>::RayQuery& query,
                 const typename Flat<T>::RayAnswer& answer) {
    return glm::dot(in_double(query.next), in_double(answer.normal)) > 0;
}

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

/// The rounded cone that the tracer sees.
template <typename T>
stress::WideCone<Quad> exact_cone(const typename Flat<T>::Cone& cone) {
    return {in_quad(cone.base),     unit(in_quad(cone.axis)), Quad(cone.length),
            Quad(cone.base_radius), Quad(cone.slope),         0};
}

/// A random direction past the cone: to a point within 1.5 times its extent.
template <typename T>
glm::dvec3 way_to(const typename Flat<T>::Cone& cone, RandomNumbers& random) {
    const double length = cone.length, wide = std::fabs(double(cone.slope)) * length;
    const double at = random.uniform(-0.25, 1.25) * length;
    const double reach = 1.5 * (double(cone.base_radius) + wide) * random.uniform(0, 1);
    return in_double(cone.base) + at * in_double(cone.axis) + reach * random.direction();
}

/// Distance at which an exact ray from this point of the cone hits it again, negative if it does
/// not; empty if that is within a thousandth of the length of a rim.
template <typename T>
std::optional<Quad> exact_return(const typename Flat<T>::Packed3& start,
                                 const typename Flat<T>::Packed3& dir,
                                 const stress::WideCone<Quad>& cone) {
    const Wide3<Quad> along = in_quad(start) - cone.base;
    const Quad height = dot(along, cone.axis);
    const Wide3<Quad> outwards = unit(along - height * cone.axis);
    stress::WideRay<Quad> ray;
    ray.origin = cone.base + height * cone.axis + (cone.radius + cone.slope * height) * outwards;
    ray.dir = unit(in_quad(dir));
    stress::WideCone<Quad> endless = cone;  // extended beyond both rims
    endless.base = cone.base - cone.length * cone.axis;
    endless.radius = cone.radius - cone.length * cone.slope;
    endless.length = 3 * cone.length;
    const Quad t = stress::hit_cone(ray, endless, true);
    const auto share = static_cast<double>((height + t * dot(ray.dir, cone.axis)) / cone.length);
    constexpr double clear = 1e-3;
    if (!(t > 0) || share <= -clear || share >= 1 + clear) return Quad(-1);
    if (share <= clear || share >= 1 - clear) return {};
    return t;
}

}  // namespace

RayCaster threads_ray_caster(int lanes) {
    ThreadsOptions options;
    options.kernels.lanes = lanes;
    return {[=](const auto& scene) { return make_threads_ray_tracer<float>(scene, options); },
            [=](const auto& scene) { return make_threads_ray_tracer<double>(scene, options); }};
}

RayTrial leaks(const Scene& mesh, RayAim aim) {
    return both_precisions([=]<typename T>(std::uint64_t rays, const RayCaster& caster) {
        const FlatScene<T> flat = flatten<T>(mesh);
        const Bounds bounds = bounds_of(flat);
        const auto make = [&](RandomNumbers& random) {
            const auto& triangle = flat.triangles[random.index(flat.triangles.size())];
            const std::array<glm::dvec3, 3> corners{in_double(triangle.p0), in_double(triangle.p1),
                                                    in_double(triangle.p2)};
            const std::size_t first = random.index(3);
            const double share = aim == RayAim::edges ? random.uniform(0, 1) : 0;
            const glm::dvec3 target =
                corners[first] + share * (corners[(first + 1) % 3] - corners[first]);
            const double spread = 0.15 * bounds.radius * random.uniform(0, 1);
            const glm::dvec3 origin =
                in_double(pack<T>(bounds.middle + spread * random.direction()));
            return ray_query<T>(origin, target - origin);
        };
        return many_rays<T>(caster.tracer(flat), rays, make, nullptr,
                            [](const auto&, const auto& answer, RayFigures& figures) {
                                ++figures.rays;
                                figures.failures += answer.prim == Flat<T>::none ? 1 : 0;
                            });
    });
}

/// Outwards, nothing must be hit; inwards, the far side.
RayTrial leaving_sphere(const Scene& scene, double shallowest) {
    return both_precisions([=]<typename T>(std::uint64_t rays, const RayCaster& caster) {
        const FlatScene<T> flat = flatten<T>(scene);
        const auto& sphere = flat.spheres[0];
        const auto make = [&](RandomNumbers& random) {
            return ray_query<T>(glm::dvec3(0), in_double(sphere.center) +
                                                   double(sphere.radius) * random.direction());
        };
        const auto continue_ray = [=](RandomNumbers& random, auto& query, const auto& answer) {
            leave_primitive<T>(random, query, answer, 0, shallowest);
        };
        return many_rays<T>(
            caster.tracer(flat), rays, make, continue_ray,
            [&](const auto& query, const auto& answer, RayFigures& figures) {
                if (!has_left<T>(query)) return;
                const Quad exact = is_outwards<T>(query, answer)
                                       ? Quad(-1)
                                       : far_side(answer.normal, query.next, sphere);
                note_hit(figures, answer.next_prim == 0, double(answer.next_t), exact, 1e-3);
            });
    });
}

RayTrial past_sphere(const Scene& scene) {
    return both_precisions([=]<typename T>(std::uint64_t rays, const RayCaster& caster) {
        const FlatScene<T> flat = flatten<T>(scene);
        const auto& sphere = flat.spheres[0];
        const auto make = [&](RandomNumbers& random) {
            const double reach = 1.5 * double(sphere.radius) * random.uniform(0, 1);
            return ray_query<T>(glm::dvec3(0),
                                in_double(sphere.center) + reach * random.direction());
        };
        return many_rays<T>(caster.tracer(flat), rays, make, nullptr,
                            [&](const auto& query, const auto& answer, RayFigures& figures) {
                                note_hit(figures, answer.prim == 0, double(answer.t),
                                         exact_distance<T>(query, sphere));
                            });
    });
}

/// Outwards, nothing must be hit; inwards, the exact far side if it is clear of the rims.
RayTrial leaving_cone(const Scene& scene, double shallowest) {
    return both_precisions([=]<typename T>(std::uint64_t rays, const RayCaster& caster) {
        const FlatScene<T> flat = flatten<T>(scene);
        const stress::WideCone<Quad> cone = exact_cone<T>(flat.cones[0]);
        const auto prim = flat.params.sphere_count;
        const auto make = [&](RandomNumbers& random) {
            return ray_query<T>(glm::dvec3(0), way_to<T>(flat.cones[0], random));
        };
        const auto continue_ray = [=](RandomNumbers& random, auto& query, const auto& answer) {
            leave_primitive<T>(random, query, answer, prim, shallowest);
        };
        return many_rays<T>(
            caster.tracer(flat), rays, make, continue_ray,
            [&](const auto& query, const auto& answer, RayFigures& figures) {
                if (!has_left<T>(query)) return;
                const std::optional<Quad> exact =
                    is_outwards<T>(query, answer) ? Quad(-1)
                                                  : exact_return<T>(answer.point, query.next, cone);
                if (!exact) return;
                note_hit(figures, answer.next_prim == prim, double(answer.next_t), *exact, 1e-2);
            });
    });
}

RayTrial past_cone(const Scene& scene) {
    return both_precisions([=]<typename T>(std::uint64_t rays, const RayCaster& caster) {
        const FlatScene<T> flat = flatten<T>(scene);
        const stress::WideCone<Quad> cone = exact_cone<T>(flat.cones[0]);
        const auto make = [&](RandomNumbers& random) {
            return ray_query<T>(glm::dvec3(0), way_to<T>(flat.cones[0], random));
        };
        return many_rays<T>(caster.tracer(flat), rays, make, nullptr,
                            [&](const auto& query, const auto& answer, RayFigures& figures) {
                                const Quad exact = stress::hit_cone<Quad>(
                                    {in_quad(query.origin), in_quad(query.dir)}, cone, false);
                                note_hit(figures, answer.prim == flat.params.sphere_count,
                                         double(answer.t), exact);
                            });
    });
}

}  // namespace rt
