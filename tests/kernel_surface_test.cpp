// SPDX-License-Identifier: Apache-2.0
//
// kernels/surface.cl and hit_surface.cl: points, normals and the offset of secondary rays against
// 113-bit geometry. Tolerances are in roundoffs.
#include <algorithm>

#include "tests/exact.h"
#include "tests/kernel_runner.h"
#include "tests/test_scenes.h"

namespace rt::this_file {

namespace {

constexpr std::size_t count = 30000;

template <typename T>
using Sphere = typename Flat<T>::Sphere;
template <typename T>
using Triangle = typename Flat<T>::Triangle;
template <typename T>
using VertexNormals = typename Flat<T>::VertexNormals;
template <typename T>
using Hit = ProbeHit<T>;

/// The origins of rays that leave towards `sides`.
template <typename T>
std::vector<Packed3<T>> offset_origins(const std::vector<ProbeSurface<T>>& surfaces,
                                       const std::vector<Packed3<T>>& sides) {
    return run<T, Packed3<T>>("offset_origin", surfaces.size(), surfaces, sides);
}

/// Where a ray meets a ball in front of its origin, rounded; 0 where it does not.
template <typename T>
T ball_distance(const ProbeRay<T>& ray, const Sphere<T>& sphere) {
    const SphereRoots roots = exact_roots(ray, sphere);
    if (roots.depth < 0) return 0;
    return static_cast<T>(roots.near > 0 ? roots.near : roots.far);
}

/// Where a ray meets a triangle, rounded; t is not positive where it does not.
template <typename T>
Hit<T> triangle_hit(const ProbeRay<T>& ray, const Triangle<T>& triangle) {
    const auto& [t, weight] = exact_hit(ray, triangle);
    if (!(weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0)) return {};
    return {T(t), T(weight[1]), T(weight[2]), 0, 0};
}

/// Rays that hit balls of all sizes and positions, from outside and from inside, and their hits.
template <typename T>
struct BallHits {
    std::vector<ProbeRay<T>> rays;
    std::vector<Sphere<T>> spheres;
    std::vector<T> t;
    std::vector<Packed3<T>> sides;

    BallHits() = default;
    explicit BallHits(Random& random) {
        while (rays.size() < count) {
            const double r = random.log_uniform(1e-3, 1e3);
            const glm::dvec3 center = random.log_uniform(1, 1e3) * random.unit_vector();
            const glm::dvec3 origin = center + r * random.uniform(0, 3) * random.unit_vector();
            const glm::dvec3 target = center + r * random.uniform(0, 1) * random.unit_vector();
            offer(random, origin, target, center, r);
        }
    }
    /// Adds the ray if it hits the ball. Directions and centers get low parts.
    void offer(Random& random, const glm::dvec3& origin, const glm::dvec3& target,
               const glm::dvec3& center, double r) {
        constexpr double low = 0.4 * Flat<T>::roundoff;
        auto ray = make_ray<T>(origin, target - origin);
        ray.dir_low = pack<T>(low * random.unit_vector());
        ray.origin_low = pack<T>(low * glm::length(origin) * random.unit_vector());
        auto sphere = make_sphere<T>(center, r);
        sphere.center_low = pack<T>(low * center * random.unit_vector());
        const T distance = ball_distance(ray, sphere);
        if (!(distance > 0)) return;
        rays.push_back(ray);
        spheres.push_back(sphere);
        t.push_back(distance);
        sides.push_back(pack<T>(random.unit_vector()));
    }
    std::vector<ProbeSurface<T>> surfaces() const {
        return run<T, ProbeSurface<T>>("sphere_surface", count, rays, t, spheres);
    }
};

/// Where the line with its low part meets the sphere with its low part, near t.
template <typename T>
struct TrueHit {
    Quad r, half_chord;  ///< the latter 0 where the line misses
    Quad3 to_origin;     ///< from the center
    Quad3 normal;

    TrueHit(const ProbeRay<T>& ray, const Sphere<T>& sphere, T t) : r(sphere.radius) {
        const Quad3 dir = unit(exact(ray.dir) + exact(ray.dir_low));
        to_origin = exact(ray.origin) + exact(ray.origin_low) - exact(sphere.center) -
                    exact(sphere.center_low);
        const Quad b = -dot(to_origin, dir);
        const Quad3 closest = to_origin + b * dir;
        const Quad squared = r * r - dot(closest, closest);
        half_chord = squared > 0 ? sqrt(squared) : Quad(0);
        normal = unit(closest + (Quad(t) < b ? -half_chord : half_chord) * dir);
    }
};

KERNEL_SUITE(SphereSurface);
TYPED_TEST(SphereSurface, HasItsPointOnTheSphereAndTheNormalThere) {
    Random random(1);
    const BallHits<TypeParam> hits(random);
    const auto surfaces = hits.surfaces();
    WorstError normal, low, bound;
    for (std::size_t i = 0; i < count; ++i) {
        const TrueHit<TypeParam> hit(hits.rays[i], hits.spheres[i], hits.t[i]);
        if (hit.half_chord > 0) {
            const Quad unit_of_error = (length(hit.to_origin) + hit.r) / hit.half_chord;
            normal.add(vector_error<TypeParam>(surfaces[i].normal, hit.normal, unit_of_error));
        }
        const Quad3 c = exact(hits.spheres[i].center), p = exact(surfaces[i].point);
        ASSERT_LE(magnitude(length(p - c) - hit.r), Quad(surfaces[i].offset)) << i;
        const Quad3 from_center = p + exact(surfaces[i].point_low) - c;
        low.add(error_in_roundoffs<TypeParam>(
            TypeParam(length(from_center - exact(hits.spheres[i].center_low)) - hit.r), 0, hit.r));
        bound.add(error_in_roundoffs(surfaces[i].offset, 0, hit.r + length(p) + length(c)));
    }
    normal.expect_at_most(2, "normal");
    low.expect_at_most(4, "point with its low part");
    bound.expect_at_most(5, "offset");
}

// However small the ball is relative to its distance from the eye; a point origin + t dir would be
// off by a roundoff of the distance, ten thousand of the radius.
TYPED_TEST(SphereSurface, OfASmallBallFarFromTheEyeKeepsItsNormal) {
    Random random(6);
    BallHits<TypeParam> hits;
    while (hits.rays.size() < count) {
        const double distance = random.log_uniform(1e-2, 1e2);
        const double r = distance * random.log_uniform(1e-4, 1e-2);
        const glm::dvec3 center = distance * random.unit_vector();
        hits.offer(random, {0, 0, 0}, center + r * random.uniform(0, 1) * random.unit_vector(),
                   center, r);
    }
    const auto surfaces = hits.surfaces();
    WorstError normal;
    for (std::size_t i = 0; i < count; ++i) {
        const TrueHit<TypeParam> hit(hits.rays[i], hits.spheres[i], hits.t[i]);
        if (!(hit.half_chord > 0)) continue;
        normal.add(vector_error<TypeParam>(surfaces[i].normal, hit.normal, hit.r / hit.half_chord));
    }
    normal.expect_at_most(4, "normal");
}

KERNEL_SUITE(OffsetOrigin);
TYPED_TEST(OffsetOrigin, LiesOutsideOrInsideTheSphereAsAsked) {
    Random random(2);
    const BallHits<TypeParam> hits(random);
    const auto surfaces = hits.surfaces();
    const auto origins = offset_origins<TypeParam>(surfaces, hits.sides);
    for (std::size_t i = 0; i < count; ++i) {
        const Quad out = dot(exact(hits.sides[i]), exact(surfaces[i].geometric));
        const Quad3 from_center = exact(origins[i]) - exact(hits.spheres[i].center);
        const Quad r = hits.spheres[i].radius;
        ASSERT_EQ(dot(from_center, from_center) > r * r, out > 0) << i;
        ASSERT_LE(magnitude(length(from_center) - r),
                  2 * Quad(surfaces[i].offset) +
                      4 * Quad(Flat<TypeParam>::roundoff) * length(exact(origins[i])));
    }
}

// An offset too small to change the rounded point still moves it by one ulp.
TYPED_TEST(OffsetOrigin, MovesEvenWhereTheOffsetIsRoundedAway) {
    Random random(12);
    std::vector<ProbeSurface<TypeParam>> surfaces;
    std::vector<Packed3<TypeParam>> sides;
    for (std::size_t i = 0; i < count; ++i) {
        ProbeSurface<TypeParam> surface{};
        surface.point = pack<TypeParam>(random.in_cube(1));
        surface.geometric = pack<TypeParam>(random.unit_vector());
        surface.offset = Flat<TypeParam>::roundoff * TypeParam(1e-6);
        surfaces.push_back(surface);
        sides.push_back(pack<TypeParam>(random.unit_vector()));
    }
    const auto origins = offset_origins<TypeParam>(surfaces, sides);
    for (std::size_t i = 0; i < count; ++i) {
        const Quad3 normal = exact(surfaces[i].geometric);
        const Quad3 step = exact(origins[i]) - exact(surfaces[i].point);
        ASSERT_EQ(dot(step, normal) > 0, dot(exact(sides[i]), normal) > 0) << i;
        ASSERT_NE(dot(step, normal), 0) << i;
    }
}

/// Rays that hit triangles of sides about `size`, from within `reach`.
template <typename T>
struct TriangleHits {
    std::vector<ProbeRay<T>> rays;
    std::vector<Hit<T>> hits;
    std::vector<Triangle<T>> triangles;
    std::vector<Packed3<T>> sides;

    TriangleHits(Random& random, double size, double reach) {
        while (rays.size() < count) {
            const double scale = random.log_uniform(1e-3, 1e3);
            const glm::dvec3 p = scale * reach * random.in_cube(1);
            const auto along = [&] { return scale * size * random.unit_vector(); };
            const glm::dvec3 e1 = along(), e2 = along();
            // The triangle surrounds p, so that a large one is seen from nearby.
            const glm::dvec3 p0 = p - random.uniform(0.1, 0.4) * e1 - random.uniform(0.1, 0.4) * e2;
            const auto triangle = make_triangle<T>(p0, p0 + e1, p0 + e2);
            const glm::dvec3 origin = p + scale * reach * random.unit_vector();
            const auto ray = make_ray<T>(
                origin, p - origin + 0.1 * scale * std::min(size, reach) * random.unit_vector());
            const Hit<T> hit = triangle_hit(ray, triangle);
            if (!(hit.t > 0)) continue;
            rays.push_back(ray);
            hits.push_back(hit);
            triangles.push_back(triangle);
            sides.push_back(pack<T>(random.unit_vector()));
        }
    }
    std::vector<ProbeSurface<T>> surfaces(const std::vector<VertexNormals<T>>& normals) const {
        return run<T, ProbeSurface<T>>("triangle_surface", count, rays, hits, triangles, normals);
    }
};

/// The height of p above the plane of the rounded vertices, on the triangle normal's side.
template <typename T>
Quad above(const Packed3<T>& p, const Triangle<T>& t) {
    const Quad3 a = exact(t.p0);
    const Quad3 n = unit(cross(exact(t.p1) - a, exact(t.p2) - a));
    const Quad height = dot(exact(p) - a, n);
    return dot(n, exact(t.normal)) > 0 ? height : -height;
}

KERNEL_SUITE(TriangleSurface);
TYPED_TEST(TriangleSurface, LiesWithinItsOffsetOfThePlaneAndRaysStartOnTheAskedSide) {
    Random random(3);
    const TriangleHits<TypeParam> cases(random, 1, 2);
    const auto surfaces = cases.surfaces({});
    const auto origins = offset_origins<TypeParam>(surfaces, cases.sides);
    for (std::size_t i = 0; i < count; ++i) {
        const auto& triangle = cases.triangles[i];
        ASSERT_LE(magnitude(above<TypeParam>(surfaces[i].point, triangle)),
                  Quad(surfaces[i].offset))
            << i;
        const Quad up = dot(exact(cases.sides[i]), exact(triangle.normal));
        const Quad height = above<TypeParam>(origins[i], triangle);
        ASSERT_EQ(height > 0, up > 0) << i;
        ASSERT_LE(magnitude(height), 3 * Quad(surfaces[i].offset)) << i;
    }
}
TYPED_TEST(TriangleSurface, OnAWallSeenFromNearKeepsToThePlanesEquation) {
    Random random(4);
    const TriangleHits<TypeParam> cases(random, 8192, 2);
    const auto surfaces = cases.surfaces({});
    const auto origins = offset_origins<TypeParam>(surfaces, cases.sides);
    std::size_t projected = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto& triangle = cases.triangles[i];
        const Quad3 n = exact(triangle.normal);
        const Quad reach = length(exact(cases.rays[i].origin)) + cases.hits[i].t;
        const Quad off = dot(n, exact(surfaces[i].point)) - triangle.plane;
        ASSERT_LE(magnitude(off), Quad(surfaces[i].offset)) << i;
        const double bound = error_in_roundoffs(surfaces[i].offset, 0, reach);
        ASSERT_LE(bound, 65) << i;
        projected += bound < 17;
        ASSERT_EQ(dot(n, exact(origins[i])) > triangle.plane, dot(n, exact(cases.sides[i])) > 0)
            << i;
    }
    EXPECT_GT(projected, count * 9 / 10);
}
TYPED_TEST(TriangleSurface, TakesTheFacesNormalOrTheBlendAndItsSide) {
    Random random(5);
    TriangleHits<TypeParam> cases(random, 1, 2);
    std::vector<VertexNormals<TypeParam>> normals;
    for (std::size_t i = 0; i < count; i += 2) {
        cases.triangles[i].smooth = static_cast<Index<TypeParam>>(normals.size());
        const auto any = [&] { return pack<TypeParam>(random.unit_vector()); };
        normals.push_back({any(), 0, any(), 0, any(), 0});
    }
    const auto surfaces = cases.surfaces(normals);
    for (std::size_t i = 0; i < count; ++i) {
        const Quad3 face = exact(cases.triangles[i].normal), shading = exact(surfaces[i].normal);
        const Quad3 geometric = exact(surfaces[i].geometric);
        ASSERT_EQ(magnitude(dot(geometric, face)), dot(face, face));
        ASSERT_GE(dot(geometric, shading), Quad(-4) * Flat<TypeParam>::roundoff);
        const bool is_face = dot(shading - face, shading - face) == 0;
        ASSERT_EQ(is_face, i % 2 == 1) << i;
    }
}

KERNEL_SUITE(BlendedNormal);
TYPED_TEST(BlendedNormal, IsTheUnitBlendOfTheVertices) {
    Random random(6);
    const auto any = [&] { return pack<TypeParam>(random.unit_vector()); };
    const auto normals =
        many(count, [&]() -> VertexNormals<TypeParam> { return {any(), 0, any(), 0, any(), 0}; });
    const auto faces = many(count, any);
    const auto u = many(count, [&] { return static_cast<TypeParam>(random.uniform(0, 0.6)); });
    const auto v = many(count, [&] { return static_cast<TypeParam>(random.uniform(0, 0.4)); });
    const auto blends =
        run<TypeParam, Packed3<TypeParam>>("blended_normal", count, normals, faces, u, v);
    WorstError worst;
    for (std::size_t i = 0; i < count; ++i) {
        const Quad3 blend = (1 - Quad(u[i]) - v[i]) * exact(normals[i].n0) +
                            Quad(u[i]) * exact(normals[i].n1) + Quad(v[i]) * exact(normals[i].n2);
        worst.add(vector_error<TypeParam>(blends[i], unit(blend), 1 + 1 / length(blend)));
    }
    worst.expect_at_most(1.5);
}
TYPED_TEST(BlendedNormal, IsTheFacesWhereTheBlendVanishes) {
    const Packed3<TypeParam> x{1, 0, 0}, back{-1, 0, 0}, zero{0, 0, 0}, face{0, 0, 1};
    const std::vector<VertexNormals<TypeParam>> normals{{x, 0, back, 0, x, 0},
                                                        {zero, 0, zero, 0, zero, 0}};
    const std::vector<Packed3<TypeParam>> faces(2, face);
    const std::vector<TypeParam> u(2, TypeParam(0.5)), v(2, 0);
    EXPECT_TRUE(same_bits<TypeParam>(
        run<TypeParam, Packed3<TypeParam>>("blended_normal", 2, normals, faces, u, v), faces));
}

KERNEL_SUITE(IsOnEdge);
TYPED_TEST(IsOnEdge, IsWithin64RoundoffsOfATrianglesEdge) {
    using T = TypeParam;
    Random random(8);
    const auto scene = crowd<T>(random);
    const Index<T> triangle = scene.params.sphere_count;
    const T in = T(65) * Flat<T>::roundoff, on = T(63) * Flat<T>::roundoff;
    const T third = T(1) / T(3);
    const std::vector<Hit<T>> hits{{1, third, third, triangle, 0},     {1, in, third, triangle, 0},
                                   {1, on, third, triangle, 0},        {1, third, 0, triangle, 0},
                                   {1, T(0.25), T(0.75), triangle, 0}, {1, 0, 0, 0, 0}};
    const auto device = run<T, Index<T>>("is_on_edge", hits.size(), scene, hits);
    EXPECT_EQ(device, (std::vector<Index<T>>{0, 0, 1, 1, 1, 0}));
}

/// How far from a hit point towards the triangle's incenter the point must move to clear the edges.
template <typename T>
Quad3 way_clear_of_edges(const Triangle<T>& triangle, const ProbeRay<T>& ray, const Hit<T>& hit,
                         const Quad3& point) {
    const Quad3 p0 = exact(triangle.p0), p1 = exact(triangle.p1), p2 = exact(triangle.p2);
    const Quad a = length(p2 - p1), b = length(p0 - p2), c = length(p1 - p0);
    const Quad radius = length(cross(p1 - p0, p2 - p0)) / (a + b + c);
    Quad size = length(exact(ray.origin)) + hit.t, farthest = 0;
    for (const Quad3& p : {p0, p1, p2}) {
        for (const Quad x : {p.x, p.y, p.z}) farthest = std::max(farthest, x < 0 ? -x : x);
    }
    const Quad cosine = dot(exact(triangle.normal), exact(ray.dir));
    const Quad sine = cosine < 0 ? -cosine : cosine, least = Quad(1) / 128;
    const Quad roundoff = Flat<T>::roundoff, weights[] = {1 - Quad(hit.u) - hit.v, hit.u, hit.v};
    const Quad nearest = std::min({weights[0], weights[1], weights[2]});
    if (nearest * std::max(sine, least) >= 4096 * roundoff) return {};
    const Quad3 sides[] = {p2 - p1, p0 - p2, p1 - p0};
    Quad share = 0;
    for (int i = 0; i < 3; ++i) {
        const Quad across = length(cross(sides[i], exact(ray.dir))) / length(sides[i]);
        const Quad away =
            32 * roundoff * std::min(size, farthest) / (radius * std::max(sine / across, least));
        share = std::max(share, std::min(away, Quad(1) / 64) - 2 * weights[i]);
    }
    return share * (1 / (a + b + c) * (a * p0 + b * p1 + c * p2) - point);
}

KERNEL_SUITE(SurfaceAt);
TYPED_TEST(SurfaceAt, IsThePrimitivesSurfaceMovedOffTiesAndEdges) {
    Random random(7);
    const auto scene = crowd<TypeParam>(random);
    auto rays = rays_about<TypeParam>(random, 20000);
    auto hits = run<TypeParam, Hit<TypeParam>>("closest_hit", rays.size(), scene, rays);
    for (std::size_t i = 0; i < hits.size(); i += 5) {  // some begin next to the surface
        if (!std::isfinite(hits[i].t)) continue;
        const auto way = double(hits[i].t) * (1 - 64 * double(Flat<TypeParam>::roundoff));
        rays[i].origin = pack<TypeParam>(in_double(rays[i].origin) + way * in_double(rays[i].dir));
    }
    hits = run<TypeParam, Hit<TypeParam>>("closest_hit", rays.size(), scene, rays);
    for (std::size_t i = 0; i < hits.size(); ++i) {
        hits[i].prim = std::max<Index<TypeParam>>(hits[i].prim, 0);
        if (i % 7 == 0) hits[i].u = TypeParam(63) * Flat<TypeParam>::roundoff;  // on an edge
    }
    const auto own = run<TypeParam, ProbeSurface<TypeParam>>("primitive_surface", rays.size(),
                                                             scene, rays, hits);
    const auto moved =
        run<TypeParam, ProbeSurface<TypeParam>>("surface_at", rays.size(), scene, rays, hits);
    const auto on_edge = run<TypeParam, Index<TypeParam>>("is_on_edge", rays.size(), scene, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!std::isfinite(hits[i].t)) continue;
        const bool touches = hits[i].tied != 0 || on_edge[i] != 0;
        Quad back = touches ? Quad(8) * own[i].offset : Quad(0);
        const Quad reach = hits[i].t + length(exact(rays[i].origin));
        const Quad tie =
            std::max(32 * Quad(Flat<TypeParam>::roundoff) * reach, Quad(hits[i].behind));
        if (hits[i].tied != 0) back += tie;
        back = std::min(back, Quad(hits[i].t) / 2);
        Quad3 expected = exact(own[i].point) - back * exact(rays[i].dir);
        if (hits[i].prim >= scene.params.sphere_count) {
            const auto& triangle =
                scene.triangles[std::size_t(hits[i].prim - scene.params.sphere_count)];
            expected = expected + way_clear_of_edges<TypeParam>(triangle, rays[i], hits[i],
                                                                exact(own[i].point));
        }
        ASSERT_LE(vector_error<TypeParam>(moved[i].point, expected, 8), 1) << i;
    }
}

KERNEL_SUITE(SpawnRay);
TYPED_TEST(SpawnRay, CarriesTheChordOfItsSphere) {
    Random random(21);
    const BallHits<TypeParam> hits(random);
    const auto surfaces = hits.surfaces();
    const std::vector<Index<TypeParam>> prims(surfaces.size(), 3);
    const auto rays = run<TypeParam, ProbeRay<TypeParam>>("spawn_ray", surfaces.size(), surfaces,
                                                          hits.sides, hits.sides, prims);
    WorstError worst;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Quad radius = hits.spheres[i].radius;
        const Quad chord = -2 * radius * dot(exact(surfaces[i].normal), exact(hits.sides[i]));
        worst.add(error_in_roundoffs(rays[i].self_hit, chord, hits.spheres[i].radius));
        ASSERT_EQ(rays[i].from, 3);
    }
    worst.expect_at_most(5);
}
TYPED_TEST(SpawnRay, CarriesWhatItsStartIsOffThePointLeft) {
    Random random(22);
    const BallHits<TypeParam> hits(random);
    const auto surfaces = hits.surfaces();
    const auto origins = offset_origins<TypeParam>(surfaces, hits.sides);
    const std::vector<Index<TypeParam>> prims(surfaces.size(), 3);
    const auto rays = run<TypeParam, ProbeRay<TypeParam>>("spawn_ray", surfaces.size(), surfaces,
                                                          origins, hits.sides, prims);
    WorstError worst;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Quad3 left = exact(surfaces[i].point) + exact(surfaces[i].point_low);
        const Quad3 expected = left - exact(origins[i]);
        worst.add(vector_error<TypeParam>(rays[i].origin_low, expected, length(expected)));
    }
    worst.expect_at_most(1);
}

}  // namespace

}  // namespace rt::this_file
