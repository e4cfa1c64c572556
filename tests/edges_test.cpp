// SPDX-License-Identifier: Apache-2.0
//
// The edges mode: which pixels it opens, what they hold, and what it misses.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include "host/explain/pixel_facts.h"
#include "host/render/estimate.h"
#include "tests/render_helpers.h"

namespace rt::test {
namespace {

constexpr int size = 48;

/// White things lit from above, one unit a pixel, in front of a black background. Pixel (x, y) of
/// the picture shows x to x + 1 and size - y - 1 to size - y.
Scene flat_world(const char* aa = "edges:0.001") {
    Scene scene;
    scene.camera.projection = Scene::Projection::orthographic;
    scene.camera.from = {size / 2.0, size / 2.0, 100};
    scene.camera.at = {size / 2.0, size / 2.0, 0};
    scene.camera.field_of_view = {Scene::FieldOfView::Fixed::view_height, size};
    set_image_size(scene, size, size);
    scene.ambient_light = {1, 1, 1};
    scene.aa = *parse_aa_mode(aa);
    Scene::Material material;
    material.ambient = {0.5, 0.5, 0.5};
    material.two_sided = true;
    scene.materials.push_back(material);
    return scene;
}

void add_triangle(Scene& scene, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    scene.triangles.push_back({{a, b, c}, {}, 0});
}

std::vector<std::uint32_t> samples_of(const Scene& scene) {
    const StopFlag never = 0;
    return pixel_work<float>(scene, {0, 0, scene.width, scene.height}, never).samples;
}

std::uint64_t all_samples(const Scene& scene) {
    const auto samples = samples_of(scene);
    return std::accumulate(samples.begin(), samples.end(), std::uint64_t{0});
}

/// How many pixels of a row have more samples than the one at their center.
int open_in_row(const Scene& scene, int y) {
    const auto samples = samples_of(scene);
    const auto row = samples.begin() + std::ptrdiff_t{y} * scene.width;
    return static_cast<int>(std::count_if(row, row + scene.width, [](auto n) { return n > 1; }));
}

TEST(Edges, OpensThePixelsAtASilhouette) {
    Scene scene = flat_world();
    add_triangle(scene, {10.3, -99, 0}, {10.3, 99, 0}, {-500, 0, 0});
    EXPECT_EQ(open_in_row(scene, size / 2), 2);
    const auto samples = samples_of(scene);
    EXPECT_GT(samples[std::size_t{size} * 20 + 10], 100u);  // .3 of it is white
    EXPECT_LT(samples[std::size_t{size} * 20 + 9], 40u);    // all its samples agree
}

TEST(Edges, OpensNoPixelsInsideASurface) {
    Scene scene = flat_world();
    scene.materials[0].diffuse = {0.5, 0.5, 0.5};
    scene.lights.push_back({{24, 60, 40}, {1, 1, 1}});  // 0.01 from pixel to pixel, no more edges
    const glm::dvec3 a{-9, -9, -3}, b{60, -9, 1}, c{60, 60, 5.5}, d{-9, 60, 1.5};  // in a plane
    add_triangle(scene, a, b, c);
    add_triangle(scene, a, c, d);
    EXPECT_EQ(all_samples(scene), std::uint64_t{size} * size);
    scene.triangles.clear();
    const glm::dvec3 folded{60, 60, 3};
    add_triangle(scene, a, b, folded);
    add_triangle(scene, a, folded, d);
    EXPECT_GT(all_samples(scene), std::uint64_t{size} * size + 16 * size);
}

/// A plane behind another of the same direction and material is another surface; a light tells them
/// apart, or there is nothing to see.
TEST(Edges, OpensPixelsWhereOnePlaneEndsBeforeAnother) {
    Scene scene = flat_world("edges:0.02");  // too little contrast for the Laplacian: 24 T
    scene.materials[0].diffuse = {0.5, 0.5, 0.5};
    scene.lights.push_back({{60, 24, 30}, {1, 1, 1}});
    add_triangle(scene, {-500, -500, 0}, {500, -500, 0}, {0, 900, 0});
    const std::uint64_t without = all_samples(scene);
    add_triangle(scene, {24.4, -500, 20}, {24.4, 500, 20}, {-900, 0, 20});
    EXPECT_GT(all_samples(scene), without + 16 * size);
}

TEST(Edges, OpensPixelsAtTheEdgeOfAShadow) {
    Scene scene = flat_world("edges:0.03");  // as above
    scene.materials[0].diffuse = {0.5, 0.5, 0.5};
    scene.lights.push_back({{24, 24, 300}, {1, 1, 1}});
    add_triangle(scene, {-500, -500, 0}, {500, -500, 0}, {0, 900, 0});
    const std::uint64_t without = all_samples(scene);
    add_triangle(scene, {27, 22, 200}, {29, 22, 200}, {28, 26, 200});  // behind the eye
    EXPECT_GT(all_samples(scene), without + 16 * 8);
}

TEST(Edges, LeavesEdgesAloneThatAreNotWorthTheirSamples) {
    Scene scene = flat_world("edges:0.2");
    add_triangle(scene, {10.3, -99, 0}, {10.3, 99, 0}, {-500, 0, 0});  // contrast 0.5 < sqrt(32) T
    EXPECT_EQ(all_samples(scene), std::uint64_t{size} * size);
}

/// A bar 0.3 pixel wide, almost upright, meets no center in some 17 rows after another.
TEST(Edges, FollowsThinShapesBetweenCenters) {
    Scene scene = flat_world("edges:0.003");
    add_triangle(scene, {20.1, -1, 0}, {20.4, -1, 0}, {22.1, 49, 0});
    add_triangle(scene, {20.4, -1, 0}, {22.4, 49, 0}, {22.1, 49, 0});
    const auto samples = samples_of(scene);
    int open = 0;
    for (int y = 0; y < size; ++y) {
        for (int x = 20; x < 23; ++x) {
            open += samples[static_cast<std::size_t>(y * size + x)] > 1;
        }
    }
    EXPECT_GT(open, 54);  // 50 next to centers
}

TEST(Edges, OpenPixelsHaveTheBitsOfSobolAndTheRestAMean) {
    for (const char* stem : {"cornell-box", "glass"}) {
        Scene scene = load_named_scene(stem);
        set_image_size(scene, 64, 48);
        const auto rendered_in = [&scene](const std::string& aa) {
            scene.aa = *parse_aa_mode(aa);
            return render_on_threads<float>(scene);
        };
        const Film<float> centers = rendered_in("none"), film = rendered_in("edges:0.002");
        const auto samples = samples_of(scene);
        std::map<std::uint32_t, Film<float>> sobol;
        std::size_t settled = 0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const float* const rgb = &film.rgb[3 * i];
            if (samples[i] > 1) {
                const std::uint32_t n = samples[i] - 1;
                if (!sobol.contains(n)) sobol.emplace(n, rendered_in(fmt::format("sobol:{}", n)));
                EXPECT_TRUE(std::equal(rgb, rgb + 3, &sobol.at(n).rgb[3 * i])) << stem << ' ' << i;
                continue;
            }
            const std::size_t x = i % 64, y = i / 64;
            if (x == 0 || y == 0 || x == 63 || y == 47) continue;
            ++settled;
            for (std::size_t c = 0; c < 3; ++c) {
                const auto at = [&](std::size_t pixel) {
                    return double{centers.rgb[3 * pixel + c]};
                };
                const double sides = at(i - 1) + at(i + 1) + at(i - 64) + at(i + 64);
                EXPECT_NEAR(rgb[c], at(i) + (sides - 4 * at(i)) / 24, 1e-6) << stem << ' ' << i;
            }
        }
        EXPECT_GT(sobol.size(), 2u) << stem;
        EXPECT_GT(settled, 500u) << stem;
    }
}

class Rounds : public testing::TestWithParam<const char*> {};

/// Packets hold lanes that meet glass and lanes that do not; margins of tiles overlap.
TEST_P(Rounds, HaveTheSameBitsAndRaysInAnyPacketAndTile) {
    Scene scene = load_named_scene("glass");
    set_image_size(scene, 60, 44);
    scene.aa = *parse_aa_mode(GetParam());
    const FlatScene<float> flat = flatten<float>(scene);
    const Rect whole{0, 0, scene.width, scene.height};
    const auto render = [&](int lanes, int width, int height) {
        ThreadsOptions options;
        options.kernels.lanes = lanes;
        const StopFlag never = 0;
        TileQueue queue(make_tiles(whole, width, height), never);
        Film<float> film(scene.width, scene.height);
        make_threads_renderer(flat, options)->render(queue, whole, film);
        const RayCounts rays = queue.rays();
        return std::tuple(hash_of(film), rays.primary, rays.shadow, rays.mirror, rays.transmitted);
    };
    const auto expected = render(0, 60, 44);
    for (const int lanes : {1, 4, 16}) EXPECT_EQ(render(lanes, 60, 44), expected) << lanes;
    EXPECT_EQ(render(0, 17, 5), expected);
    EXPECT_EQ(render(0, 1, 44), expected);
}

/// More packets in rows than in squares, and more than a launch may have.
TEST_P(Rounds, HaveTheSameBitsWhereALaunchIsNarrow) {
    Scene scene = load_named_scene("single-sphere");
    set_image_size(scene, 1, 65536);
    scene.aa = *parse_aa_mode(GetParam());
    EXPECT_EQ(hash_of(render_on_device<float>(scene)), hash_of(render_on_threads<float>(scene)));
}

INSTANTIATE_TEST_SUITE_P(Modes, Rounds, testing::Values("edges:0.01", "adaptive:0.05"));

struct Reached {
    double rmse, samples;
};

Reached reached(const char* stem, const char* aa) {
    Scene scene = load_named_scene(stem);
    set_image_size(scene, 120, 120);
    scene.aa = *parse_aa_mode("sobol:512");
    scene.sampling_seed = 7;
    const Film<float> reference = render_on_threads<float>(scene);
    scene.aa = *parse_aa_mode(aa);
    scene.sampling_seed = 0;
    const double rmse = film_error(render_on_threads<float>(scene), reference).rmse;
    return {rmse, static_cast<double>(all_samples(scene)) / (120 * 120)};
}

TEST(Edges, ReachesItsToleranceWithFewSamples) {
    for (const char* stem : {"cornell-box", "cones", "meshes"}) {
        const Reached edges = reached(stem, "edges:0.001"), sobol = reached(stem, "sobol:32");
        EXPECT_LT(edges.rmse, 1.5e-3) << stem;
        EXPECT_LT(edges.rmse, sobol.rmse) << stem;
        EXPECT_LT(edges.samples, 16) << stem;
    }
}

}  // namespace
}  // namespace rt::test
