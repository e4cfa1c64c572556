// SPDX-License-Identifier: Apache-2.0
//
// intersect_triangle of kernels/intersect.cl, against integer and 113-bit arithmetic. Tolerances
// are in roundoffs.
#include "tests/exact.h"
#include "tests/kernel_runner.h"
#include "tests/probe_types.h"
#include "tests/test_random.h"
#include "tests/test_shapes.h"

namespace rt::this_file {

namespace {

template <typename T>
using Triangle = typename Flat<T>::Triangle;
template <typename T>
using Hit = ProbeHit<T>;

template <typename T>
struct TriangleCases {
    std::vector<ProbeRay<T>> rays;
    std::vector<Triangle<T>> triangles;

    void add(const ProbeRay<T>& ray, const Triangle<T>& triangle) {
        rays.push_back(ray);
        triangles.push_back(triangle);
    }
    std::vector<Hit<T>> device() const {
        return run<T, Hit<T>>("intersect_triangle", rays.size(), rays, triangles);
    }
};

KERNEL_SUITE(IntersectTriangle);

/// A ray along axis `axis` and a triangle on small integers: everything but the division is exact.
struct IntegerCase {
    long ray[3], vertex[3][3];
    int axis, sense;

    long across(int i, int k) const {
        return vertex[i][(axis + 1 + k) % 3] - ray[(axis + 1 + k) % 3];
    }
    /// Twice the area that vertices i, j and the ray span.
    long edge(int i, int j) const {
        return across(i, 0) * across(j, 1) - across(i, 1) * across(j, 0);
    }
};

IntegerCase random_integers(Random& random) {
    IntegerCase c;
    c.axis = random.index(3);
    c.sense = random.coin() ? 1 : -1;
    for (int k = 0; k < 3; ++k) c.ray[k] = k == c.axis ? -20 * c.sense : random.index(9) - 4;
    for (auto& vertex : c.vertex) {
        for (long& x : vertex) x = random.index(9) - 4;
    }
    return c;
}

template <typename T>
void add_integers(TriangleCases<T>& cases, const IntegerCase& c) {
    const auto point = [](const long(&x)[3]) { return glm::dvec3(x[0], x[1], x[2]); };
    const glm::dvec3 dir(c.axis == 0 ? c.sense : 0, c.axis == 1 ? c.sense : 0,
                         c.axis == 2 ? c.sense : 0);
    cases.add(make_ray<T>(point(c.ray), dir),
              make_triangle<T>(point(c.vertex[0]), point(c.vertex[1]), point(c.vertex[2])));
}

TYPED_TEST(IntersectTriangle, OnIntegersHitsInsidesEdgesAndVerticesAndNothingElse) {
    Random random(1);
    TriangleCases<TypeParam> cases;
    const auto integers = many(60000, [&] { return random_integers(random); });
    for (const IntegerCase& c : integers) add_integers(cases, c);
    const auto hits = cases.device();
    int on_edge = 0;
    for (std::size_t i = 0; i < integers.size(); ++i) {
        const IntegerCase& c = integers[i];
        const long w[3] = {c.edge(1, 2), c.edge(2, 0), c.edge(0, 1)};
        const long sum = w[0] + w[1] + w[2];
        const bool mixed = std::min({w[0], w[1], w[2]}) < 0 && std::max({w[0], w[1], w[2]}) > 0;
        const bool hit = sum != 0 && !mixed;
        ASSERT_EQ(hits[i].t > 0, hit) << i;
        if (!hit) continue;
        on_edge += w[0] * w[1] * w[2] == 0;
        const Quad plane = Quad(w[0] * c.vertex[0][c.axis] + w[1] * c.vertex[1][c.axis] +
                                w[2] * c.vertex[2][c.axis]) /
                           sum;
        ASSERT_LE(relative_error(hits[i].t, plane * c.sense + 20), 3) << i;
        ASSERT_LE(error_in_roundoffs(hits[i].u, Quad(w[1]) / sum, 1), 2) << i;
        ASSERT_LE(error_in_roundoffs(hits[i].v, Quad(w[2]) / sum, 1), 2) << i;
    }
    EXPECT_GT(on_edge, 2000);
}

/// Rays at and around triangles of height `height` and base 1, from at least 5 degrees above.
template <typename T>
TriangleCases<T> triangles_of_height(Random& random, double height) {
    TriangleCases<T> cases;
    while (cases.rays.size() < 40000) {
        const glm::dvec3 base = random.unit_vector(), p0 = random.in_cube(1);
        const glm::dvec3 side = glm::normalize(glm::cross(base, random.unit_vector()));
        const glm::dvec3 p1 = p0 + base;
        const glm::dvec3 p2 = p0 + random.uniform(0.1, 0.9) * base + height * side;
        const glm::dvec3 target =
            p0 + random.uniform(-0.2, 1.2) * base + height * random.uniform(-0.2, 1.2) * side;
        const glm::dvec3 dir = random.unit_vector();
        if (std::fabs(glm::dot(dir, glm::cross(base, side))) < std::sin(5 * M_PI / 180)) continue;
        const glm::dvec3 origin = target - random.uniform(1, 3) * dir;
        cases.add(make_ray<T>(origin, dir), make_triangle<T>(p0, p1, p2));
    }
    return cases;
}

/// Hit or miss must be right wherever the ray clears the edges by `margin` roundoffs, and distances
/// must be within `bar` roundoffs.
template <typename T>
void expect_right_triangles(double height, double margin, double bar) {
    Random random(static_cast<std::uint64_t>(1 / height));
    const auto cases = triangles_of_height<T>(random, height);
    const auto hits = cases.device();
    WorstError distance, weight;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const ExactHit right = exact_hit(cases.rays[i], cases.triangles[i]);
        const auto& [wa, wb, wc] = right.weight;
        const Quad least = std::min({wa, wb, wc});
        const Quad clear = margin * Quad(Flat<T>::roundoff) / height;
        const bool hit = hits[i].t > 0;
        ASSERT_TRUE(hit == (least > 0) || magnitude(least) <= clear) << i;
        if (!hit || least < 0) continue;
        distance.add(relative_error(hits[i].t, right.t));
        weight.add(error_in_roundoffs(hits[i].u, wb, 1 / height));
        weight.add(error_in_roundoffs(hits[i].v, wc, 1 / height));
    }
    distance.expect_at_most(bar, "distance");
    weight.expect_at_most(margin, "weights_times_height");
}

TYPED_TEST(IntersectTriangle, IsRightForOrdinaryTriangles) {
    expect_right_triangles<TypeParam>(0.7, 25, 12);
}
TYPED_TEST(IntersectTriangle, IsRightForNeedlesOfAspectAThousand) {
    expect_right_triangles<TypeParam>(1e-3, 25, 12);
}
TYPED_TEST(IntersectTriangle, IsRightForNeedlesOfAspectAMillion) {
    expect_right_triangles<TypeParam>(1e-6, 25, 12);
}
TYPED_TEST(IntersectTriangle, SeesBothFacesAndNothingBehindOrWithoutArea) {
    const auto ray = make_ray<TypeParam>({0.25, 0.25, 2}, {0, 0, -1});
    TriangleCases<TypeParam> cases;
    cases.add(ray, make_triangle<TypeParam>({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
    cases.add(ray, make_triangle<TypeParam>({0, 0, 0}, {0, 1, 0}, {1, 0, 0}));
    cases.add(ray, make_triangle<TypeParam>({0, 0, 4}, {1, 0, 4}, {0, 1, 4}));
    cases.add(ray, make_triangle<TypeParam>({0, 0, 0}, {0.5, 0.5, 0}, {1, 1, 0}));
    cases.add(ray, make_triangle<TypeParam>({0.25, 0.25, 0}, {0.25, 0.25, 0}, {0.25, 0.25, 0}));
    const auto hits = cases.device();
    EXPECT_EQ(hits[0].t, 2);
    EXPECT_EQ(hits[1].t, 2);
    for (std::size_t i = 2; i < 5; ++i) EXPECT_FALSE(hits[i].t > 0) << i;
}
TYPED_TEST(IntersectTriangle, HasTheSameBitsEverywhereOnAnyNumbers) {
    Random random(4);
    TriangleCases<TypeParam> cases;
    for (int i = 0; i < 60000; ++i) {
        Triangle<TypeParam> triangle{};
        triangle.p0 = random.any_vector<TypeParam>();
        triangle.p1 = random.any_vector<TypeParam>();
        triangle.p2 = random.any_vector<TypeParam>();
        cases.add({random.any_vector<TypeParam>(), 1, random.any_vector<TypeParam>(), 0, 0},
                  triangle);
    }
    cases.device();
}

}  // namespace

}  // namespace rt::this_file
