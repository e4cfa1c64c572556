// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <mutex>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "host/base/parallel.h"
#include "host/flatten/flat_scene.h"
#include "host/render/threads_renderer.h"
#include "host/stress/families.h"
#include "host/stress/wide_shapes.h"

namespace rt {

namespace {

using stress::dot;
using stress::Quad;
using stress::unit;
using stress::Wide3;

template <typename T>
using Query = typename Flat<T>::RayQuery;
template <typename T>
using Answer = typename Flat<T>::RayAnswer;

/// Random numbers, the same on every machine.
class RandomNumbers {
   public:
    explicit RandomNumbers(std::uint64_t seed) : engine_(seed) {}

    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    double log_uniform(double low, double high) {
        return std::exp(uniform(std::log(low), std::log(high)));
    }
    std::size_t index(std::size_t count) { return engine_() % count; }
    glm::dvec3 direction() {
        const double z = uniform(-1, 1), angle = uniform(0, 2 * std::numbers::pi);
        const double radius = std::sqrt(1 - z * z);
        return {radius * std::cos(angle), radius * std::sin(angle), z};
    }

   private:
    std::mt19937_64 engine_;
};

/// `dir`, of any length, normalized, rounded to T and normalized again in T.
template <typename T>
typename Flat<T>::Packed3 rounded_unit(const glm::dvec3& dir) {
    const auto d = pack<T>(dir / glm::length(dir));
    const T inverse = T(1) / std::sqrt(std::fma(d.z, d.z, std::fma(d.y, d.y, d.x * d.x)));
    return {inverse * d.x, inverse * d.y, inverse * d.z};
}

/// An endless ray.
template <typename T>
Query<T> ray_query(const glm::dvec3& origin, const glm::dvec3& dir) {
    Query<T> query{};
    query.origin = pack<T>(origin);
    query.dir = rounded_unit<T>(dir);
    query.t_max = std::numeric_limits<T>::infinity();
    query.from = Flat<T>::none;
    return query;
}

/// Traces many rays and sums up the results. rays.start(random) returns a query; rays.go_on(random,
/// query, answer), if there is such a function, may set the direction of a secondary ray from the
/// hit; rays.judge(query, answer, figures) counts. Each block of rays has its own numbers, so that
/// the rays are the same on any number of cores.
template <typename T, typename Rays>
RayFigures trace_many(const RayTracer<T>& trace, std::uint64_t ray_count, const Rays& rays) {
    constexpr std::size_t block = 4096, batch = 16 * block;
    std::vector<Query<T>> queries;
    std::vector<Answer<T>> answers;
    RayFigures sum;
    std::mutex mutex;
    for (std::uint64_t at = 0; at < ray_count; at += batch) {
        const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(ray_count - at, batch));
        std::vector<RandomNumbers> random;
        for (std::size_t i = 0; i < count; i += block) random.emplace_back(at + i + 1);
        queries.resize(count);
        answers.resize(count);
        const auto in_blocks = [&](const auto& work) {
            for_each_run(count, block, available_cores(), [&](std::size_t first, std::size_t last) {
                work(random[first / block], first, last);
            });
        };
        in_blocks([&](RandomNumbers& own, std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) queries[i] = rays.start(own);
        });
        trace(queries, answers);
        if constexpr (requires { &Rays::go_on; }) {
            in_blocks([&](RandomNumbers& own, std::size_t first, std::size_t last) {
                for (std::size_t i = first; i < last; ++i) rays.go_on(own, queries[i], answers[i]);
            });
            trace(queries, answers);
        }
        in_blocks([&](RandomNumbers&, std::size_t first, std::size_t last) {
            RayFigures own;
            for (std::size_t i = first; i < last; ++i) rays.judge(queries[i], answers[i], own);
            const std::lock_guard lock(mutex);
            sum.rays += own.rays;
            sum.failures += own.failures;
            sum.max_error = std::max(sum.max_error, own.max_error);
        });
    }
    return sum;
}

/// A trial of the rays that make_rays(flat scene) returns, in float and in double.
template <typename MakeRays>
RayTrial trial_of(const Scene& scene, const MakeRays& make_rays) {
    return {[=](std::uint64_t ray_count, const RayCaster& caster, Precision precision) {
        const auto run = [&]<typename T>(const FlatScene<T>& flat) {
            return trace_many<T>(caster.tracer(flat), ray_count, make_rays(flat));
        };
        return precision == Precision::float64 ? run(flatten<double>(scene))
                                               : run(flatten<float>(scene));
    }};
}

/// A random direction at this angle above a surface with this normal.
glm::dvec3 at_angle(RandomNumbers& random, const glm::dvec3& normal, double angle) {
    const glm::dvec3 other = std::fabs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 across = glm::normalize(glm::cross(normal, other));
    const double turn = random.uniform(0, 2 * std::numbers::pi);
    const glm::dvec3 tangent =
        std::cos(turn) * across + std::sin(turn) * glm::cross(normal, across);
    return std::cos(angle) * tangent + std::sin(angle) * normal;
}

/// Whether the ray was continued.
template <typename T>
bool has_left(const Query<T>& query) {
    return glm::length(in_double(query.next)) > 0;
}

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

/// The scene's first sphere, as the tracer sees it.
template <typename T>
struct FirstSphere {
    typename Flat<T>::Sphere flat;
    typename Flat<T>::Index prim = 0;
    stress::WideSphere<Quad> exact{in_quad(flat.center), Quad(flat.radius), 0};
    /// What it meets, a ray cannot miss the sphere by rounding.
    stress::WideSphere<Quad> core{exact.center, Quad(0.9) * exact.radius, 0};

    explicit FirstSphere(const FlatScene<T>& scene) : flat(scene.spheres[0]) {}

    glm::dvec3 point_on(RandomNumbers& random) const {
        return in_double(flat.center) + double(flat.radius) * random.direction();
    }

    glm::dvec3 point_near(RandomNumbers& random) const {
        const double reach = 1.5 * double(flat.radius) * random.uniform(0, 1);
        return in_double(flat.center) + reach * random.direction();
    }

    /// Distance to the far side, for a ray from the exact point with the answer's normal.
    std::optional<Quad> way_back(const Answer<T>& start,
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
    std::optional<Quad> way_back(const Answer<T>& start,
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
template <typename T, template <typename> typename Shape>
struct Leaving {
    Shape<T> shape;
    double shallowest, tolerance;

    Query<T> start(RandomNumbers& random) const {
        return ray_query<T>(glm::dvec3(0), shape.point_on(random));
    }

    /// From the hit, three times in four outwards: two in three at less than 0.1 rad above the
    /// surface, down to 1e-6. Inwards, down to `shallowest`.
    void go_on(RandomNumbers& random, Query<T>& query, const Answer<T>& answer) const {
        if (answer.prim != shape.prim) return;
        const glm::dvec3 normal = glm::normalize(in_double(answer.normal));
        constexpr double steepest = std::numbers::pi / 2;
        const double angle = random.index(4) == 0   ? -random.log_uniform(shallowest, steepest)
                             : random.index(3) == 0 ? random.uniform(0.1, steepest)
                                                    : random.log_uniform(1e-6, 0.1);
        query.next = rounded_unit<T>(at_angle(random, normal, angle));
    }

    void judge(const Query<T>& query, const Answer<T>& answer, RayFigures& figures) const {
        if (!has_left<T>(query)) {
            if constexpr (requires { shape.core; }) {
                const stress::WideRay<Quad> ray{in_quad(query.origin), in_quad(query.dir)};
                note_hit(figures, false, 0, hit_shape(ray, shape.core, false).t);
            }
            return;
        }
        const bool is_outwards = glm::dot(in_double(query.next), in_double(answer.normal)) > 0;
        const std::optional<Quad> exact =
            is_outwards ? Quad(-1) : shape.way_back(answer, query.next);
        if (!exact) return;
        note_hit(figures, answer.next_prim == shape.prim, double(answer.next_t), *exact, tolerance);
    }
};

template <template <typename> typename Shape>
RayTrial leaving(const Scene& scene, double shallowest, double tolerance) {
    return trial_of(scene, [=]<typename T>(const FlatScene<T>& flat) {
        return Leaving<T, Shape>{Shape<T>(flat), shallowest, tolerance};
    });
}

/// Rays past a shape.
template <typename T, template <typename> typename Shape>
struct Passing {
    Shape<T> shape;

    Query<T> start(RandomNumbers& random) const {
        return ray_query<T>(glm::dvec3(0), shape.point_near(random));
    }

    void judge(const Query<T>& query, const Answer<T>& answer, RayFigures& figures) const {
        const stress::WideRay<Quad> ray{in_quad(query.origin), in_quad(query.dir)};
        note_hit(figures, answer.prim == shape.prim, double(answer.t),
                 hit_shape(ray, shape.exact, false).t);
    }
};

template <template <typename> typename Shape>
RayTrial past(const Scene& scene) {
    return trial_of(scene, []<typename T>(const FlatScene<T>& flat) {
        return Passing<T, Shape>{Shape<T>(flat)};
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

/// The rays of `leaks`.
template <typename T>
class LeakRays {
   public:
    LeakRays(const FlatScene<T>& flat, RayAim aim) : triangles_(triangles_of(flat)), aim_(aim) {
        glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
        for (const MeshTriangle& triangle : triangles_) {
            for (const glm::dvec3& corner : triangle.corners) {
                low = glm::min(low, corner);
                high = glm::max(high, corner);
            }
        }
        const glm::dvec3 half = 0.5 * (high - low);
        middle_ = low + half;
        reach_ = 0.15 * std::min({half.x, half.y, half.z});
    }

    Query<T> start(RandomNumbers& random) const {
        const auto& corners = triangles_[random.index(triangles_.size())].corners;
        const std::size_t first = random.index(3);
        const double share = aim_ == RayAim::edges ? random.uniform(0, 1) : 0;
        const glm::dvec3 target =
            corners[first] + share * (corners[(first + 1) % 3] - corners[first]);
        const double spread = reach_ * random.uniform(0, 1);
        const glm::dvec3 origin = in_double(pack<T>(middle_ + spread * random.direction()));
        return ray_query<T>(origin, target - origin);
    }

    void judge(const Query<T>&, const Answer<T>& answer, RayFigures& figures) const {
        ++figures.rays;
        figures.failures += answer.prim == Flat<T>::none ? 1 : 0;
    }

   private:
    const std::vector<MeshTriangle> triangles_;
    const RayAim aim_;
    glm::dvec3 middle_{0};  ///< of the mesh
    double reach_ = 0;      ///< from there, where rays start
};

/// The rays of edge_escapes.
template <typename T>
class EdgeRays {
   public:
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
    Query<T> start(RandomNumbers& random) const {
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
    void go_on(RandomNumbers& random, Query<T>& query, const Answer<T>& answer) const {
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
    void judge(const Query<T>& query, const Answer<T>& answer, RayFigures& figures) const {
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
    return trial_of(mesh,
                    [=]<typename T>(const FlatScene<T>& flat) { return LeakRays<T>(flat, aim); });
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
    return trial_of(mesh,
                    [=]<typename T>(const FlatScene<T>& flat) { return EdgeRays<T>(flat, side); });
}

}  // namespace rt
