// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <map>

#include "host/flatten/flat_scene.h"
#include "host/stress/families.h"
#include "host/stress/many_rays.h"

namespace rt {

namespace {

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
