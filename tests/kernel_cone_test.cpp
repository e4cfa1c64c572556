// SPDX-License-Identifier: Apache-2.0
//
// kernels/cone.cl and cone_surface against 113-bit arithmetic. Tolerances are in roundoffs and
// close to the largest error found.
#include "tests/exact.h"
#include "tests/kernel_runner.h"
#include "tests/test_scenes.h"

namespace rt::this_file {

namespace {

constexpr std::size_t count = 40000;

template <typename T>
using Cone = typename Flat<T>::Cone;

/// The double cone |w x axis| = radius + slope (w.axis) along a ray, in quad: textbook formulas.
template <typename T>
struct ExactCone {
    Quad a, b, k, at, rise, radius, m, length, widest;
    Quad size;  ///< magnitude of the discriminant's terms

    ExactCone(const ProbeRay<T>& ray, const Cone<T>& cone, bool leaving) {
        const Quad3 d = exact(ray.dir), w = exact(ray.origin) - exact(cone.base);
        const Quad3 axis = exact(cone.axis);
        const Quad3 c = cross(d, axis), g = cross(w, axis);
        const Quad slope = cone.slope;
        at = dot(w, axis);
        rise = dot(d, axis);
        radius = Quad(cone.base_radius) + slope * at;
        m = slope * rise;
        length = cone.length;
        a = dot(c, c) - m * m;
        b = dot(g, c) - radius * m;
        k = leaving ? Quad(0) : dot(g, g) - radius * radius;
        widest = std::max(Quad(cone.base_radius), Quad(cone.base_radius) + slope * length);
        size = dot(c, c) * widest * widest;
    }
    Quad discriminant() const { return b * b - a * k; }
    /// How clearly the root at t counts: the smallest relative margin of its height, radius and
    /// distance; negative when it does not count.
    Quad margin(Quad t) const {
        const Quad height = at + t * rise, there = radius + t * m;
        const Quad scale = length * Quad(1e-12);
        Quad least = std::min(height, length - height) / (length + scale);
        least = std::min(least, there / widest);
        return std::min(least, t / std::min(length, widest));
    }
};

/// A ray and a cone for each item.
template <typename T>
struct ConeCases {
    std::vector<ProbeRay<T>> rays;
    std::vector<Cone<T>> cones;
    std::vector<Index<T>> leaving;

    void add(const ProbeRay<T>& ray, const Cone<T>& cone, bool on_it = false) {
        rays.push_back(ray);
        cones.push_back(cone);
        leaving.push_back(on_it ? 1 : 0);
    }
    void add_leaving(const ProbeRay<T>& ray, const Cone<T>& cone) {
        add(ray, cone, true);
        rays.back().self_hit = static_cast<T>(-2 * ExactCone<T>(ray, cone, true).b);
    }
    std::vector<T> device() const {
        return run<T, T>("intersect_cone", rays.size(), rays, cones, leaving);
    }
};

/// Rays aimed at frustums of a given size at distance 1. Hit or miss must be right, except where a
/// root lies within `clear` of an end or of grazing; distances must be right to `bar` roundoffs of
/// the distance plus the frustum's size, divided by the cosine between ray and normal.
template <typename T>
void expect_right_cones(const ConeCases<T>& cases, double clear, double bar, std::size_t least_hits,
                        const std::string& what = "worst") {
    const auto t = cases.device();
    WorstError worst;
    std::size_t hits = 0;
    for (std::size_t i = 0; i < t.size(); ++i) {
        const bool leaving = cases.leaving[i] != 0;
        const ExactCone<T> cone(cases.rays[i], cases.cones[i], leaving);
        const Quad d = cone.discriminant();
        if (magnitude(d) < Quad(clear) * cone.size) continue;
        if (magnitude(cone.a) < Quad(clear)) continue;
        Quad expected = -1, doubt = 1;
        if (d > 0) {
            const Quad s = square_root(d);
            Quad roots[2] = {(-cone.b - s) / cone.a, (-cone.b + s) / cone.a};
            if (roots[0] > roots[1]) std::swap(roots[0], roots[1]);
            for (const Quad root : roots) {
                if (leaving && magnitude(root) < magnitude(cone.b / cone.a) / 2) continue;
                const Quad margin = cone.margin(root);
                doubt = std::min(doubt, magnitude(margin));
                if (margin > 0 && expected < 0) expected = root;
            }
        }
        if (doubt < Quad(clear)) continue;
        ASSERT_EQ(t[i] > 0, expected > 0) << i << " " << what;
        if (t[i] <= 0) continue;
        ++hits;
        // The cosine between ray and normal.
        const Quad slope = cases.cones[i].slope;
        const Quad steep =
            square_root(d) / (cone.radius + cone.m * expected) / square_root(1 + slope * slope);
        const Quad scale = (expected + cone.length) / std::min(steep, Quad(1));
        worst.add(error_in_roundoffs(t[i], expected, scale));
    }
    worst.expect_at_most(bar, what);
    EXPECT_GE(hits, least_hits) << what;
}

struct Shape {
    const char* name;
    double base_radius, apex_radius, length;
};
constexpr Shape shapes[] = {{"cylinder", 1, 1, 2},  {"cone", 1, 0, 2},
                            {"frustum", 0.5, 1, 1}, {"needle", 0.02, 0.02, 2},
                            {"spike", 0.02, 0, 2},  {"disc", 1, 0.2, 0.01},
                            {"widening", 0, 1, 1}};

template <typename T>
ConeCases<T> aimed(Random& random, const Shape& shape, double scale, bool inside) {
    ConeCases<T> cases;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 axis = random.unit_vector(), base = random.in_cube(1);
        const auto cone =
            make_cone<T>(base, scale * shape.base_radius, base + scale * shape.length * axis,
                         scale * shape.apex_radius);
        const double reach = 1.1 * scale * std::max(shape.base_radius, shape.apex_radius);
        const auto point = [&](double least, double most) {
            return base + scale * shape.length * random.uniform(least, most) * axis +
                   reach * random.unit_vector();
        };
        const glm::dvec3 target = point(-0.1, 1.1);
        const glm::dvec3 origin = inside ? point(0, 1) : target + random.unit_vector();
        cases.add(make_ray<T>(origin, inside ? random.unit_vector() : target - origin), cone);
    }
    return cases;
}

KERNEL_SUITE(IntersectCone);
TYPED_TEST(IntersectCone, IsRightForFrustumsNextToTheEye) {
    Random random(1);
    for (const Shape& shape : shapes) {
        expect_right_cones(aimed<TypeParam>(random, shape, 0.5, false), 1e-2, 12, count / 8,
                           shape.name);
    }
}
TYPED_TEST(IntersectCone, IsRightAtAHundredthOfTheDistance) {
    Random random(2);
    for (const Shape& shape : {shapes[0], shapes[1], shapes[2], shapes[5], shapes[6]}) {
        expect_right_cones(aimed<TypeParam>(random, shape, 1e-2, false), 5e-2, 5, count / 16,
                           shape.name);
    }
}
TYPED_TEST(IntersectCone, IsRightFromInside) {
    Random random(3);
    for (const Shape& shape : shapes) {
        for (const double scale : {1e-3, 1.0, 1e3}) {
            if (scale < 1 && shape.base_radius + shape.apex_radius < 0.5) continue;
            expect_right_cones(aimed<TypeParam>(random, shape, scale, true), 5e-2, 32, count / 64,
                               fmt::format("{}_{:g}", shape.name, scale));
        }
    }
}
TYPED_TEST(IntersectCone, IsRightForRaysAlongTheAxis) {
    Random random(4);
    for (const double lean : {0.0, 1e-7, 1e-4, 1e-2}) {
        ConeCases<TypeParam> cones, cylinders;
        for (std::size_t i = 0; i < count / 4; ++i) {
            const double x = random.uniform(-0.9, 0.9), y = random.uniform(-0.4, 0.4);
            const auto ray = make_ray<TypeParam>({x, y, 3}, {lean, 0, -1});
            cones.add(ray, make_cone<TypeParam>({0, 0, 0}, 1, {0, 0, 2}, 0));
            cylinders.add(ray, make_cone<TypeParam>({0, 0, 0}, 1, {0, 0, 2}, 1));
        }
        expect_right_cones(cones, 1e-3, 4, count / 5, fmt::format("cones_{:g}", lean));
        for (const TypeParam t : cylinders.device()) {
            EXPECT_TRUE(lean > 1e-3 || t < 0);
        }
    }
}
TYPED_TEST(IntersectCone, HitsATangentAndMissesTheNextNumber) {
    ConeCases<TypeParam> cases;
    for (const TypeParam y : {TypeParam(1), std::nextafter(TypeParam(1), TypeParam(2))}) {
        ProbeRay<TypeParam> ray = make_ray<TypeParam>({0, 0, 0}, {1, 0, 0});
        ray.origin.y = y;
        cases.add(ray, make_cone<TypeParam>({5, 0, -1}, 1, {5, 0, 1}, 1));
    }
    EXPECT_EQ(cases.device(), (std::vector<TypeParam>{5, -1}));
}
TYPED_TEST(IntersectCone, IsOpenAtTheEndsAndHasOneHalf) {
    const auto cone = make_cone<TypeParam>({0, 0, 0}, 1, {0, 0, 1}, 0);
    ConeCases<TypeParam> cases;
    cases.add(make_ray<TypeParam>({-4, 0, 0.5}, {1, 0, 0}), cone);  // across: at radius 1/2
    cases.add(make_ray<TypeParam>({-4, 0, 1.5}, {1, 0, 0}), cone);  // above the tip: the other half
    cases.add(make_ray<TypeParam>({-4, 0, -0.5}, {1, 0, 0}), cone);
    cases.add(make_ray<TypeParam>({0.5, 0, -1}, {0, 0, 1}), cone);  // in through the base
    cases.add(make_ray<TypeParam>({0.25, 0, -1}, {0, 0, -1}), cone);
    cases.add(make_ray<TypeParam>({4, 0, 0.5}, {1, 0, 0}), cone);
    EXPECT_EQ(cases.device(), (std::vector<TypeParam>{3.5, -1, -1, 1.5, -1, -1}));
}
TYPED_TEST(IntersectCone, LeavingFollowsTheChordItCarries) {
    Random random(5);
    ConeCases<TypeParam> cases;
    const auto cylinder = make_cone<TypeParam>({0, 0, -9}, 5, {0, 0, 9}, 5);
    cases.add_leaving(make_ray<TypeParam>({3, 4, 0}, {-1, 0, 0}), cylinder);
    cases.add_leaving(make_ray<TypeParam>({3, 4, 0}, {1, 0, 0}), cylinder);
    cases.add_leaving(make_ray<TypeParam>({3, 4, 0}, {0, 0, 1}), cylinder);
    EXPECT_EQ(cases.device(), (std::vector<TypeParam>{6, -1, -1}));
    for (const Shape& shape : shapes) {
        ConeCases<TypeParam> leaving;
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec3 axis = random.unit_vector(), base = random.in_cube(1);
            const glm::dvec3 across = glm::normalize(glm::cross(axis, random.unit_vector()));
            const double height = random.uniform(0.05, 0.95);
            const double radius =
                shape.base_radius + height * (shape.apex_radius - shape.base_radius);
            leaving.add_leaving(
                make_ray<TypeParam>(base + height * shape.length * axis + radius * across,
                                    random.unit_vector()),
                make_cone<TypeParam>(base, shape.base_radius, base + shape.length * axis,
                                     shape.apex_radius));
        }
        expect_right_cones(leaving, 1e-2, 14, 100, shape.name);
    }
}
// The origin, rounded a thousand radii from the eye, no longer lies on the cylinder, but
// self_hit still gives the chord accurately.
TYPED_TEST(IntersectCone, LeavingASmallOneFarAwayKeepsTheDigitsOfItsChord) {
    Random random(9);
    ConeCases<TypeParam> cases;
    std::vector<Quad> expected;
    while (expected.size() < count) {
        const glm::dvec3 base = 1000.0 * random.unit_vector(), way = random.unit_vector();
        const auto cone = make_cone<TypeParam>(base, 1, base + 100.0 * way, 1);
        const Quad3 axis = exact(cone.axis), any = exact(random.unit_vector());
        const Quad3 w = Quad(50) * axis + unit(any - dot(any, axis) * axis);
        auto ray = make_ray<TypeParam>({0, 0, 0}, random.unit_vector());
        const Quad3 c = cross(exact(ray.dir), axis), p = exact(cone.base) + w;
        const Quad a = dot(c, c), b = dot(cross(w, axis), c);
        if (b > Quad(-0.1) || a < Quad(0.1)) continue;
        ray.origin = {TypeParam(p.x), TypeParam(p.y), TypeParam(p.z)};
        ray.self_hit = static_cast<TypeParam>(-2 * b);
        cases.add(ray, cone, true);
        expected.push_back(-2 * b / a);
    }
    const auto t = cases.device();
    WorstError worst;
    for (std::size_t i = 0; i < t.size(); ++i) {
        worst.add(error_in_roundoffs(t[i], expected[i], expected[i]));
    }
    worst.expect_at_most(7);
}
TYPED_TEST(IntersectCone, HasTheSameBitsEverywhereOnAnyNumbers) {
    Random random(6);
    const auto any = [&] { return random.any_number<TypeParam>(); };
    ConeCases<TypeParam> cases;
    for (std::size_t i = 0; i < count; ++i) {
        const auto origin = random.any_vector<TypeParam>(), dir = random.any_vector<TypeParam>();
        const auto base = random.any_vector<TypeParam>(), axis = random.any_vector<TypeParam>();
        cases.add({origin, 1, dir, 0, 0}, {base, any(), axis, any(), any(), 0, 0, 0},
                  random.index(4) == 0);
    }
    cases.device();
}

KERNEL_SUITE(Cross3);
TYPED_TEST(Cross3, KeepsItsDigits) {
    Random random(7);
    std::vector<Packed3<TypeParam>> a, b;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 v = random.unit_vector();
        a.push_back(pack<TypeParam>(v));
        b.push_back(pack<TypeParam>(v + random.log_uniform(1e-7, 1) * random.unit_vector()));
    }
    const auto c = run<TypeParam, Packed3<TypeParam>>("cross3", count, a, b);
    WorstError worst;
    for (std::size_t i = 0; i < count; ++i) {
        const Quad3 expected = cross(exact(a[i]), exact(b[i]));
        worst.add(vector_error<TypeParam>(c[i], expected, length(expected)));
    }
    worst.expect_at_most(2);
}

KERNEL_SUITE(ConeSurface);
TYPED_TEST(ConeSurface, HasItsPointWithinTheOffsetAndItsNormalAcross) {
    Random random(8);
    for (const Shape& shape : shapes) {
        for (const double scale : {1e-2, 1.0}) {
            const auto cases = aimed<TypeParam>(random, shape, scale, false);
            const auto t = cases.device();
            const auto surfaces = run<TypeParam, ProbeSurface<TypeParam>>(
                "cone_surface", count, cases.rays, t, cases.cones);
            WorstError off, tilted;
            for (std::size_t i = 0; i < count; ++i) {
                if (t[i] <= 0) continue;
                const auto& cone = cases.cones[i];
                const Quad3 axis = exact(cone.axis);
                const Quad3 w = exact(surfaces[i].point) - exact(cone.base);
                const Quad height = dot(w, axis), distance = length(cross(w, axis));
                const Quad slope = cone.slope, radius = cone.base_radius + slope * height;
                off.add(double(magnitude(distance - radius) / square_root(1 + slope * slope) /
                               Quad(surfaces[i].offset)));
                if (radius < Quad(0.1 * scale * shape.length)) continue;
                const Quad3 hit = exact(cases.rays[i].origin) +
                                  Quad(t[i]) * exact(cases.rays[i].dir) - exact(cone.base);
                const Quad3 radial = unit(hit - dot(hit, axis) * axis);
                tilted.add(vector_error<TypeParam>(surfaces[i].normal, unit(radial - slope * axis),
                                                   1 + 1 / radius));
            }
            const std::string name = fmt::format("{}_{:g}", shape.name, scale);
            off.expect_at_most(1, name + "_off");
            tilted.expect_at_most(3, name + "_tilted");
        }
    }
}
TYPED_TEST(ConeSurface, FacesTheViewerAtTheTip) {
    const std::vector<ProbeRay<TypeParam>> rays{make_ray<TypeParam>({0, 0, 3}, {0, 0, -1})};
    const std::vector<Cone<TypeParam>> cones{make_cone<TypeParam>({0, 0, 0}, 1, {0, 0, 1}, 0)};
    const std::vector<TypeParam> t{2};
    const auto surface =
        run<TypeParam, ProbeSurface<TypeParam>>("cone_surface", 1, rays, t, cones)[0];
    EXPECT_EQ(surface.normal.z, 1);
    EXPECT_EQ(surface.point.z, 1);
}

}  // namespace

}  // namespace rt::this_file
