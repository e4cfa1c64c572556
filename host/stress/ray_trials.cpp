// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <map>
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

constexpr double least_slope = 1e-6;

/// A triangle of a closed mesh as the tracer sees it.
struct MeshTriangle {
    std::array<glm::dvec3, 3> corners;
    glm::dvec3 outwards;  ///< unit
    double height(const glm::dvec3& p) const {
        const glm::vec<3, long double> n(outwards), along(p), from(corners[0]);
        return static_cast<double>(glm::dot(n, along - from));
    }
};

template <typename T>
std::vector<MeshTriangle> triangles_of(const FlatScene<T>& flat) {
    std::vector<MeshTriangle> triangles;
    for (const auto& t : flat.triangles) {
        triangles.push_back({{in_double(t.p0), in_double(t.p1), in_double(t.p2)}, {}});
        const auto& [a, b, c] = triangles.back().corners;
        triangles.back().outwards = glm::normalize(glm::cross(b - a, c - a));
    }
    return triangles;
}

/// The triangle on the other side of each triangle's edges; edge i starts at corner i.
std::vector<std::array<std::size_t, 3>> neighbors_of(const std::vector<MeshTriangle>& triangles) {
    const auto key = [](const glm::dvec3& a, const glm::dvec3& b) {
        return std::array{a.x, a.y, a.z, b.x, b.y, b.z};
    };
    std::map<std::array<double, 6>, std::size_t> owners;
    for (std::size_t f = 0; f < triangles.size(); ++f) {
        const auto& corners = triangles[f].corners;
        for (std::size_t i = 0; i < 3; ++i) owners[key(corners[i], corners[(i + 1) % 3])] = f;
    }
    std::vector<std::array<std::size_t, 3>> neighbors(triangles.size());
    for (std::size_t f = 0; f < triangles.size(); ++f) {
        const auto& corners = triangles[f].corners;
        for (std::size_t i = 0; i < 3; ++i) {
            neighbors[f][i] = owners.at(key(corners[(i + 1) % 3], corners[i]));
        }
    }
    return neighbors;
}

/// The rays of edge_escapes.
template <typename T>
class EdgeRays {
   public:
    using Query = typename Flat<T>::RayQuery;

    EdgeRays(const FlatScene<T>& flat, MeshSide side)
        : is_inside_(side == MeshSide::inside), triangles_(triangles_of(flat)) {
        double size = 0;
        for (const MeshTriangle& triangle : triangles_) {
            for (const glm::dvec3& corner : triangle.corners)
                size = std::max(size, glm::length(corner));
        }
        clear_ = 4 * roundoff * size;
    }

    /// Towards a point next to an edge or, one in four, a vertex; almost parallel to one of the
    /// edge's two triangles.
    Query start(RandomNumbers& random) const {
        constexpr double rim = 64 * roundoff;
        for (;;) {
            const std::size_t number = random.index(triangles_.size()), edge = random.index(3);
            const MeshTriangle& hit = triangles_[number];
            const MeshTriangle& along =
                random.index(2) == 0 ? hit : triangles_[neighbors_[number][edge]];
            const glm::dvec3 a = hit.corners[edge], b = hit.corners[(edge + 1) % 3],
                             c = hit.corners[(edge + 2) % 3];
            const double share = random.uniform(0, random.index(4) == 0 ? rim : 1);
            const glm::dvec3 target = a + share * (b - a) + rim * random.uniform(0, 1) * (c - a);
            const glm::dvec3 unit_edge = glm::normalize(b - a);
            const double turn = random.uniform(0, 2 * std::numbers::pi);
            const glm::dvec3 level =
                std::cos(turn) * unit_edge + std::sin(turn) * glm::cross(along.outwards, unit_edge);
            const double slope = inwards_ * random.log_uniform(least_slope, 1);
            const double far = glm::length(c - a) * random.uniform(0.1, 1);
            const glm::dvec3 back = glm::normalize(level + slope * along.outwards);
            const glm::dvec3 origin = in_double(pack<T>(target + far * back));
            if (is_clear(origin, hit)) return ray_query<T>(origin, target - origin);
        }
    }

    /// On as a mirror ray, or to a light in any direction.
    void go_on(RandomNumbers& random, Query& query,
               const typename Flat<T>::RayAnswer& answer) const {
        if (answer.prim == Flat<T>::none) return;
        const glm::dvec3 dir = in_double(query.dir), normal = in_double(answer.normal);
        const double arriving = glm::dot(dir, normal);
        if (arriving * inwards_ > 0) return;
        const glm::dvec3 facing = arriving > 0 ? -normal : normal;
        const glm::dvec3 next =
            random.index(2) == 0 ? dir - 2 * arriving * normal
                                 : at_angle(random, facing, random.log_uniform(least_slope, 1.5));
        if (glm::dot(next, facing) < 0.5 * least_slope) return;
        query.next = rounded_unit<T>(next);
    }

    /// Where a tie has a ray from outside meet a triangle from behind, or the slope is below the
    /// least, it does not go on, and does not count.
    void judge(const Query& query, const typename Flat<T>::RayAnswer& answer,
               RayFigures& figures) const {
        const bool met = answer.prim != Flat<T>::none;
        if (!has_left<T>(query) && (met || !is_inside_)) return;
        ++figures.rays;
        const bool returns = met && answer.next_prim != Flat<T>::none;
        figures.failures += returns == is_inside_ ? 0 : 1;
    }

   private:
    static constexpr double roundoff = static_cast<double>(Flat<T>::roundoff);

    bool is_clear(const glm::dvec3& p, const MeshTriangle& hit) const {
        if (!is_inside_) return hit.height(p) > clear_;
        return std::all_of(triangles_.begin(), triangles_.end(), [&](const MeshTriangle& triangle) {
            return triangle.height(p) < -clear_;
        });
    }

    const bool is_inside_;
    const double inwards_ = is_inside_ ? -1 : 1;
    const std::vector<MeshTriangle> triangles_;
    const std::vector<std::array<std::size_t, 3>> neighbors_ = neighbors_of(triangles_);
    double clear_ = 0;  ///< how far an origin is off the mesh, at least
};

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

RayTrial edge_escapes(const Scene& mesh, MeshSide side) {
    return both_precisions([=]<typename T>(std::uint64_t rays, const RayCaster& caster) {
        const FlatScene<T> flat = flatten<T>(mesh);
        const EdgeRays<T> edge(flat, side);
        return many_rays<T>(
            caster.tracer(flat), rays, [&](RandomNumbers& random) { return edge.start(random); },
            [&](RandomNumbers& random, auto& query, const auto& answer) {
                edge.go_on(random, query, answer);
            },
            [&](const auto& query, const auto& answer, RayFigures& figures) {
                edge.judge(query, answer, figures);
            });
    });
}

}  // namespace rt
