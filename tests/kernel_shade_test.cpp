// SPDX-License-Identifier: Apache-2.0
//
// kernels/shade.cl against the local light formula evaluated in 113 bits (the power in long
// double).
#include <algorithm>

#include "tests/exact.h"
#include "tests/kernel_runner.h"
#include "tests/test_scenes.h"

namespace rt::this_file {

namespace {

constexpr std::size_t count = 20000;

template <typename T>
using Counts = typename Flat<T>::RayCounts;
template <typename T>
using Results = std::tuple<std::vector<Packed3<T>>, std::vector<Counts<T>>>;

template <typename T>
typename Flat<T>::Material any_material(Random& random, double shininess) {
    const auto color = [&] { return pack<T>(random.in_cube(0.5) + glm::dvec3(0.5)); };
    typename Flat<T>::Material material{};
    material.ambient = color();
    material.diffuse = color();
    material.specular = color();
    material.mirror = color();
    material.shininess = static_cast<T>(shininess);
    return material;
}

constexpr double powers[] = {0, 1e-3, 1, 10, 100, 1e4, 1e6};

/// Surfaces of all orientations within the unit cube, lit from near their mirror direction, so that
/// highlights show at every shininess.
template <typename T>
struct Surfaces {
    std::vector<ProbeSurface<T>> surfaces;
    std::vector<Packed3<T>> to_eye;
    std::vector<Index<T>> prims;
    glm::dvec3 light{3, 4, 5};

    explicit Surfaces(Random& random) : prims(count, Flat<T>::none) {
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec3 n = random.unit_vector(), p = random.in_cube(1);
            const glm::dvec3 l = glm::normalize(light - p);
            const glm::dvec3 mirrored = 2 * glm::dot(n, l) * n - l;
            const glm::dvec3 e =
                glm::normalize(mirrored + random.log_uniform(1e-5, 2) * random.unit_vector());
            const auto material = static_cast<Index<T>>(random.index(int(std::size(powers))));
            const auto normal = pack<T>(n);
            surfaces.push_back({pack<T>(p), T(0x1p-20), normal, material, normal, 0});
            to_eye.push_back(pack<T>(e));
        }
    }
};

/// A scene without primitives, one material for each power, and lights.
template <typename T>
FlatScene<T> lights_alone(Random& random, const std::vector<glm::dvec3>& positions) {
    FlatScene<T> scene{};
    for (const double power : powers) scene.materials.push_back(any_material<T>(random, power));
    for (const glm::dvec3& p : positions) {
        scene.lights.push_back({pack<T>(p), 0, pack<T>({0.9, 0.5, 0.3}), 0});
    }
    scene.params.ambient_light = {T(0.25), T(0.5), 1};
    count_primitives(scene);
    return scene;
}

/// max(0, n.h)^p, with the vectors normalized in 113 bits.
Quad exact_lobe(Quad3 n, Quad3 l, Quad3 e, long double power) {
    if (power == 0) return 1;
    const Quad cosine = dot(unit(n), unit(unit(l) + unit(e)));
    if (!(cosine > 0)) return 0;
    return std::exp(power * std::log1p(static_cast<long double>(cosine - 1)));
}

/// How much one roundoff of the vectors changes the lobe: sqrt(power) on its flank, amplified by
/// cancellation in the half vector of nearly opposite vectors.
Quad lobe_condition(Quad3 l, Quad3 e, double power) {
    return (1 + std::sqrt(power)) * (1 + 1 / length(unit(l) + unit(e)));
}

/// Ii (kd max(0, n.l) + ks max(0, n.h)^p); 0 for a light behind the surface.
template <typename T>
Quad3 exact_light(const FlatScene<T>& scene, std::size_t light, const ProbeSurface<T>& s,
                  const Packed3<T>& to_eye) {
    const auto& material = scene.materials[static_cast<std::size_t>(s.material)];
    const Quad3 n = exact(s.normal);
    const Quad3 l = unit(exact(scene.lights[light].position) - exact(s.point));
    const Quad cosine = dot(unit(n), l);
    if (!(cosine > 0)) return {0, 0, 0};
    const Quad3 reflected =
        cosine * exact(material.diffuse) +
        exact_lobe(n, l, exact(to_eye), material.shininess) * exact(material.specular);
    const Quad3 intensity = exact(scene.lights[light].intensity);
    return {intensity.x * reflected.x, intensity.y * reflected.y, intensity.z * reflected.z};
}

KERNEL_SUITE(IsBlack);
TYPED_TEST(IsBlack, IsTrueForZerosAlone) {
    const TypeParam least = std::numeric_limits<TypeParam>::denorm_min();
    const std::vector<Packed3<TypeParam>> colors{
        {0, 0, 0}, {-TypeParam(0), 0, 0}, {0, 0, least}, {0, 1, 0}, {-1, 1, 0}};
    const auto black = run<TypeParam, Index<TypeParam>>("is_black", colors.size(), colors);
    EXPECT_EQ(black, (std::vector<Index<TypeParam>>{1, 1, 0, 0, 0}));
}

KERNEL_SUITE(SpecularLobe);
TYPED_TEST(SpecularLobe, IsThePowerOfTheHalfAngle) {
    Random random(1);
    const Surfaces<TypeParam> given(random);
    const auto n = for_each_item(count, [&](std::size_t i) { return given.surfaces[i].normal; });
    const auto l = for_each_item(count, [&](std::size_t i) {
        const glm::dvec3 away = given.light - in_double(given.surfaces[i].point);
        return pack<TypeParam>(glm::normalize(away));
    });
    for (const double power : powers) {
        const std::vector<TypeParam> shininess(count, static_cast<TypeParam>(power));
        const auto lobes =
            run<TypeParam, TypeParam>("specular_lobe", count, n, l, given.to_eye, shininess);
        const long double rounded = shininess[0];
        WorstError worst;
        for (std::size_t i = 0; i < count; ++i) {
            const Quad3 to_light = exact(l[i]), to_eye = exact(given.to_eye[i]);
            const Quad lobe = exact_lobe(exact(n[i]), to_light, to_eye, rounded);
            worst.add(error_in_roundoffs(lobes[i], lobe, lobe_condition(to_light, to_eye, power)));
        }
        worst.expect_at_most(1.25, fmt::format("exponent_{:g}", power));
    }
}
TYPED_TEST(SpecularLobe, IsNothingForOppositeVectorsExceptToThePowerZero) {
    const std::vector<Packed3<TypeParam>> n(2, {0, 0, 1}), l(2, {1, 0, 0}), e(2, {-1, 0, 0});
    const std::vector<TypeParam> powers{1, 0}, expected{0, 1};
    EXPECT_EQ((run<TypeParam, TypeParam>("specular_lobe", 2, n, l, e, powers)), expected);
}

KERNEL_SUITE(LightContribution);
TYPED_TEST(LightContribution, IsTheFormulaAndOneShadowRayInFront) {
    Random random(2);
    const Surfaces<TypeParam> given(random);
    const auto scene = lights_alone<TypeParam>(random, {given.light});
    const auto origins =
        for_each_item(count, [&](std::size_t i) { return given.surfaces[i].point; });
    const auto [light, counts] = run<TypeParam, Packed3<TypeParam>, Counts<TypeParam>>(
        "light_contribution", count, scene, given.surfaces, origins, given.to_eye, given.prims);
    WorstError worst;
    for (std::size_t i = 0; i < count; ++i) {
        const Quad3 right = exact_light(scene, 0, given.surfaces[i], given.to_eye[i]);
        const auto& material =
            scene.materials[static_cast<std::size_t>(given.surfaces[i].material)];
        const Quad3 away = exact(scene.lights[0].position) - exact(origins[i]);
        const Quad cosine = dot(exact(given.surfaces[i].geometric), unit(away));
        if (magnitude(cosine) < 8 * Quad(Flat<TypeParam>::roundoff)) continue;  // either is right
        ASSERT_EQ(counts[i].shadow, cosine > 0 ? 1u : 0u) << i;
        const Quad scale = lobe_condition(away, exact(given.to_eye[i]), material.shininess);
        worst.add(vector_error<TypeParam>(light[i], right, scale));
    }
    worst.expect_at_most(2);
}
/// The contribution of a light at (0, 0, z) to a surface at the origin facing up, below a ball of
/// radius 1 at (0, 0, 4).
template <typename T>
Results<T> light_at_height(double z) {
    Random random(3);
    auto scene = lights_alone<T>(random, {{0, 0, z}});
    scene.spheres = {make_sphere<T>({0, 0, 4}, 1)};
    count_primitives(scene);
    const Packed3<T> up{0, 0, 1}, zero{0, 0, 0};
    const std::vector<ProbeSurface<T>> surface{{zero, 0, up, 2, up, 0}};
    const std::vector<Index<T>> prim{Flat<T>::none};
    return run<T, Packed3<T>, Counts<T>>("light_contribution", 1, scene, surface, std::vector{zero},
                                         std::vector{up}, prim);
}
TYPED_TEST(LightContribution, IsShadowedByWhatLiesBetweenAndNothingElse) {
    struct Case {
        double height;
        bool lit;
        std::uint64_t rays;
    };
    // Behind, on the surface, in front of the ball, on it, in it, beyond it.
    for (const auto& [z, lit, rays] : {Case{-1, false, 0}, Case{0, false, 0}, Case{2, true, 1},
                                       Case{3, true, 1}, Case{4, false, 1}, Case{6, false, 1}}) {
        const auto [light, counts] = light_at_height<TypeParam>(z);
        EXPECT_EQ(light[0].x > 0, lit) << z;
        EXPECT_EQ(counts[0].shadow, rays) << z;
        EXPECT_FALSE(std::isnan(light[0].x)) << z;
    }
}

KERNEL_SUITE(Shade);
TYPED_TEST(Shade, AddsAmbientAndEveryLight) {
    Random random(4);
    const Surfaces<TypeParam> given(random);
    const auto scene = lights_alone<TypeParam>(random, {given.light, {-4, 3, 4}, {0, 0, -6}});
    const auto [color, counts] = run<TypeParam, Packed3<TypeParam>, Counts<TypeParam>>(
        "shade", count, scene, given.surfaces, given.to_eye, given.prims);
    // Shadow rays start 2^-20 off the surface: from there, the formula is exact.
    const auto up =
        for_each_item(count, [&](std::size_t i) { return given.surfaces[i].geometric; });
    const auto origins =
        run<TypeParam, Packed3<TypeParam>>("offset_origin", count, given.surfaces, up);
    WorstError worst;
    for (std::size_t i = 0; i < count; ++i) {
        auto s = given.surfaces[i];
        s.point = origins[i];
        const auto& material = scene.materials[static_cast<std::size_t>(s.material)];
        const Quad3 a = exact(material.ambient), i_a = exact(scene.params.ambient_light);
        Quad3 right{a.x * i_a.x, a.y * i_a.y, a.z * i_a.z};
        bool graze = false;
        Quad scale = 1;
        for (std::size_t k = 0; k < 3; ++k) {
            right = right + exact_light(scene, k, s, given.to_eye[i]);
            const Quad3 away = unit(exact(scene.lights[k].position) - exact(s.point));
            scale += lobe_condition(away, exact(given.to_eye[i]), material.shininess);
            graze |= magnitude(dot(exact(s.normal), away)) < 8 * Quad(Flat<TypeParam>::roundoff);
        }
        if (graze) continue;
        worst.add(vector_error<TypeParam>(color[i], right, scale));
    }
    worst.expect_at_most(1.25);
}
TYPED_TEST(Shade, HasTheSameBitsEverywhereAmongShadows) {
    Random random(5);
    const Surfaces<TypeParam> given(random);
    auto scene = crowd<TypeParam>(random);
    const auto lights = lights_alone<TypeParam>(random, {given.light, {-4, 3, 4}});
    scene.lights = lights.lights;
    scene.materials = lights.materials;
    scene.params.ambient_light = lights.params.ambient_light;
    count_primitives(scene);
    const auto [color, counts] = run<TypeParam, Packed3<TypeParam>, Counts<TypeParam>>(
        "shade", count, scene, given.surfaces, given.to_eye, given.prims);
    const auto lit = std::count_if(counts.begin(), counts.end(),
                                   [](const auto& used) { return used.shadow > 0; });
    EXPECT_GT(lit, std::ptrdiff_t(count) / 4);
}

}  // namespace

}  // namespace rt::this_file
