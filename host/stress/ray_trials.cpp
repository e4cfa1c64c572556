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

using stress::dot;
using stress::Quad;
using stress::unit;
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

/// The scene's first sphere, as the tracer sees it.
template <typename T>
struct FirstSphere {
    typename Flat<T>::Sphere flat;
    typename Flat<T>::Index prim = 0;
    stress::WideSphere<Quad> exact{in_quad(flat.center), Quad(flat.radius), 0};

    explicit FirstSphere(const FlatScene<T>& scene) : flat(scene.spheres[0]) {}

    glm::dvec3 point_on(RandomNumbers& random) const {
        return in_double(flat.center) + double(flat.radius) * random.direction();
    }

    glm::dvec3 point_near(RandomNumbers& random) const {
        const double reach = 1.5 * double(flat.radius) * random.uniform(0, 1);
        return in_double(flat.center) + reach * random.direction();
    }

    /// Distance to the far side, for a ray from the exact point with the answer's normal.
    std::optional<Quad> way_back(const typename Flat<T>::RayAnswer& start,
                                 const typename Flat<T>::Packed3& dir) const {
        return Quad(-2) * exact.radius * dot(unit(in_quad(start.normal)), unit(in_quad(dir)));
    }
};

/// The scene's first cone; likewise.
template <typename T>
struct FirstCone {
    typename Flat<T>::Cone flat;
    typename Flat<T>::Index prim;
    stress::WideCone<Quad> exact{in_quad(flat.base), unit(in_quad(flat.axis)),
                                 Quad(flat.length),  Quad(flat.base_radius),
                                 Quad(flat.slope),   0};

    explicit FirstCone(const FlatScene<T>& scene)
        : flat(scene.cones[0]), prim(scene.params.sphere_count) {}

    glm::dvec3 point_on(RandomNumbers& random) const { return point_near(random); }

    /// Within 1.5 times the cone's extent.
    glm::dvec3 point_near(RandomNumbers& random) const {
        const double length = flat.length, wide = std::fabs(double(flat.slope)) * length;
        const double at = random.uniform(-0.25, 1.25) * length;
        const double reach = 1.5 * (double(flat.base_radius) + wide) * random.uniform(0, 1);
        return in_double(flat.base) + at * in_double(flat.axis) + reach * random.direction();
    }

    /// Distance at which an exact ray from the answer's point hits the cone again, negative if it
    /// does not; empty if that is within a thousandth of the length of a rim.
    std::optional<Quad> way_back(const typename Flat<T>::RayAnswer& start,
                                 const typename Flat<T>::Packed3& dir) const {
        const Wide3<Quad> along = in_quad(start.point) - exact.base;
        const Quad height = dot(along, exact.axis);
        const Wide3<Quad> outwards = unit(along - height * exact.axis);
        stress::WideRay<Quad> ray;
        ray.origin =
            exact.base + height * exact.axis + (exact.radius + exact.slope * height) * outwards;
        ray.dir = unit(in_quad(dir));
        stress::WideCone<Quad> endless = exact;  // extended beyond both rims
        endless.base = exact.base - exact.length * exact.axis;
        endless.radius = exact.radius - exact.length * exact.slope;
        endless.length = 3 * exact.length;
        const Quad t = hit_shape(ray, endless, true).t;
        const auto share =
            static_cast<double>((height + t * dot(ray.dir, exact.axis)) / exact.length);
        constexpr double clear = 1e-3;
        if (!(t > 0) || share <= -clear || share >= 1 + clear) return Quad(-1);
        if (share <= clear || share >= 1 - clear) return {};
        return t;
    }
};

/// Rays that leave a shape: outwards, nothing must be hit; inwards, the way back.
template <template <typename> typename Shape>
RayTrial leaving(const Scene& scene, double shallowest, double tolerance) {
    return both_precisions([=]<typename T>(std::uint64_t rays, const RayCaster& caster) {
        const FlatScene<T> flat = flatten<T>(scene);
        const Shape<T> shape(flat);
        const auto make = [&](RandomNumbers& random) {
            return ray_query<T>(glm::dvec3(0), shape.point_on(random));
        };
        const auto continue_ray = [&](RandomNumbers& random, auto& query, const auto& answer) {
            leave_primitive<T>(random, query, answer, shape.prim, shallowest);
        };
        return many_rays<T>(caster.tracer(flat), rays, make, continue_ray,
                            [&](const auto& query, const auto& answer, RayFigures& figures) {
                                if (!has_left<T>(query)) return;
                                const bool is_outwards =
                                    glm::dot(in_double(query.next), in_double(answer.normal)) > 0;
                                const std::optional<Quad> exact =
                                    is_outwards ? Quad(-1) : shape.way_back(answer, query.next);
                                if (!exact) return;
                                note_hit(figures, answer.next_prim == shape.prim,
                                         double(answer.next_t), *exact, tolerance);
                            });
    });
}

/// Rays past a shape.
template <template <typename> typename Shape>
RayTrial past(const Scene& scene) {
    return both_precisions([=]<typename T>(std::uint64_t rays, const RayCaster& caster) {
        const FlatScene<T> flat = flatten<T>(scene);
        const Shape<T> shape(flat);
        const auto make = [&](RandomNumbers& random) {
            return ray_query<T>(glm::dvec3(0), shape.point_near(random));
        };
        return many_rays<T>(
            caster.tracer(flat), rays, make, nullptr,
            [&](const auto& query, const auto& answer, RayFigures& figures) {
                const stress::WideRay<Quad> ray{in_quad(query.origin), in_quad(query.dir)};
                note_hit(figures, answer.prim == shape.prim, double(answer.t),
                         hit_shape(ray, shape.exact, false).t);
            });
    });
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

RayTrial leaving_sphere(const Scene& scene, double shallowest) {
    return leaving<FirstSphere>(scene, shallowest, 1e-3);
}

RayTrial leaving_cone(const Scene& scene, double shallowest) {
    return leaving<FirstCone>(scene, shallowest, 1e-2);
}

RayTrial past_sphere(const Scene& scene) { return past<FirstSphere>(scene); }

RayTrial past_cone(const Scene& scene) { return past<FirstCone>(scene); }

}  // namespace rt
