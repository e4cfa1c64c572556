// SPDX-License-Identifier: Apache-2.0
//
// The edges mode: which pixels it opens, what they hold, and what it misses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "host/explain/pixel_facts.h"
#include "host/render/estimate.h"
#include "tests/render_helpers.h"
#include "tests/whole_film.h"

namespace rt::test::this_file {
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

/// How many pixels of a row have more samples than the one at their corner.
int open_in_row(const Scene& scene, int y) {
    const auto samples = samples_of(scene);
    const auto row = samples.begin() + std::ptrdiff_t{y} * scene.width;
    return static_cast<int>(std::count_if(row, row + scene.width, [](auto n) { return n > 1; }));
}

TEST(Edges, OpensThePixelsOnASilhouette) {
    Scene scene = flat_world();
    add_triangle(scene, {10.3, -99, 0}, {10.3, 99, 0}, {-500, 0, 0});
    EXPECT_EQ(open_in_row(scene, size / 2), 1);
    EXPECT_GT(samples_of(scene)[std::size_t{size} * 20 + 10], 17u);  // .3 of it is white
}

TEST(Edges, OpensNoPixelsInsideASurface) {
    Scene scene = flat_world("edges:0.00025");
    scene.materials[0].diffuse = {0.5, 0.5, 0.5};
    scene.lights.push_back({{24, 60, 40}, {1, 1, 1}});  // 0.005 from pixel to pixel, no more edges
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
    Scene scene = flat_world("edges:0.008");  // too little contrast for the Laplacian: 48 T
    scene.materials[0].diffuse = {0.5, 0.5, 0.5};
    scene.lights.push_back({{60, 24, 30}, {1, 1, 1}});
    add_triangle(scene, {-500, -500, 0}, {500, -500, 0}, {0, 900, 0});
    const std::uint64_t without = all_samples(scene);
    add_triangle(scene, {24.4, -500, 20}, {24.4, 500, 20}, {-900, 0, 20});
    EXPECT_GE(all_samples(scene), without + 16 * size);
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
    add_triangle(scene, {10.3, -99, 0}, {10.3, 99, 0}, {-500, 0, 0});  // contrast 0.5 < sqrt(200) T
    EXPECT_EQ(all_samples(scene), std::uint64_t{size} * size);
}

/// A bar 0.3 pixel wide, almost upright, lies between corners in some 17 rows after another.
TEST(Edges, FollowsThinShapesBetweenCorners) {
    Scene scene = flat_world("edges:0.003");
    add_triangle(scene, {20.1, -1, 0}, {20.4, -1, 0}, {22.1, 49, 0});
    add_triangle(scene, {20.4, -1, 0}, {22.4, 49, 0}, {22.1, 49, 0});
    const auto samples = samples_of(scene);
    int open = 0;
    for (int y = 0; y < size; ++y) {
        const double middle = 20.25 + 2 * (size - y + 0.5) / 50;
        open += samples[static_cast<std::size_t>(y * size) + static_cast<std::size_t>(middle)] > 1;
    }
    EXPECT_GE(open, 22);  // 14 at corners, and a few rows up and down from these
}

/// The scene, half a pixel to the lower left.
Scene at_corners(Scene scene) {
    Scene::Window window = camera_window(scene.camera, scene.width, scene.height);
    const double x = (window.right - window.left) / (2 * scene.width);
    const double y = (window.top - window.bottom) / (2 * scene.height);
    window = {window.left - x, window.right - x, window.bottom - y, window.top - y};
    scene.camera.window = window;
    scene.camera.field_of_view = {};
    return scene;
}

TEST(Edges, SettledPixelsAreTheMeansOfTheirCornersLessTheirCurvature) {
    for (const char* stem : {"cornell-box", "glass"}) {
        Scene scene = load_named_scene(stem);
        set_image_size(scene, 64, 48);
        scene.aa = *parse_aa_mode("none");
        const Film<float> corners = render_on_threads<float>(at_corners(scene));
        scene.aa = *parse_aa_mode("edges:0.002");
        const Film<float> film = render_on_threads<float>(scene);
        const auto samples = samples_of(scene);
        int settled = 0, alike = 0;
        for (std::size_t y = 2; y < 47; ++y) {
            for (std::size_t x = 1; x < 62; ++x) {
                if (samples[64 * y + x] > 1) continue;
                for (std::size_t i = 3 * (64 * y + x); i < 3 * (64 * y + x) + 3; ++i) {
                    const auto at = [&](int right, int down) {
                        return double{corners.rgb[i + std::size_t(3 * (right + 64 * down))]};
                    };
                    const double inner = at(0, 0) + at(1, 0) + at(0, -1) + at(1, -1);
                    const double outer = at(-1, 0) + at(2, 0) + at(-1, -1) + at(2, -1) + at(0, 1) +
                                         at(1, 1) + at(0, -2) + at(1, -2);
                    ++settled;
                    alike += std::abs(film.rgb[i] - (14 * inner - outer) / 48) < 2e-6;
                }
            }
        }
        EXPECT_GT(settled, 1500) << stem;
        EXPECT_GT(alike, settled * 2 / 3) << stem;  // the others lie next to edges
    }
}

using Polygon = std::vector<glm::dvec2>;

/// The part of a polygon where `axis` is at least `limit` times `sign` (Sutherland and Hodgman).
Polygon clipped(const Polygon& polygon, int axis, double sign, double limit) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 from = polygon[i], to = polygon[(i + 1) % polygon.size()];
        const double before = sign * (from[axis] - limit), after = sign * (to[axis] - limit);
        if (before >= 0) kept.push_back(from);
        if (before * after < 0) kept.push_back(from + before / (before - after) * (to - from));
    }
    return kept;
}

double area_in_pixel(Polygon polygon, int x, int y) {
    polygon = clipped(clipped(polygon, 0, 1, x), 0, -1, x + 1);
    polygon = clipped(clipped(polygon, 1, 1, size - y - 1), 1, -1, size - y);
    double twice = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return std::abs(twice) / 2;
}

struct Coverage {
    double rmse, worst;  // of open pixels, as shares of white
    double samples;      // in an open pixel
};

Coverage coverage(const Polygon& triangle, const char* aa) {
    Scene scene = flat_world(aa);
    add_triangle(scene, {triangle[0], 0}, {triangle[1], 0}, {triangle[2], 0});
    const Film<float> film = render_on_threads<float>(scene);
    const auto samples = samples_of(scene);
    Coverage found{};
    int open = 0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const auto i = static_cast<std::size_t>(y * size + x);
            const double error = film.rgb[3 * i] / 0.5 - area_in_pixel(triangle, x, y);
            if (samples[i] == 1) continue;
            ++open;
            found.samples += samples[i] - 1;
            found.rmse += error * error;
            found.worst = std::max(found.worst, std::abs(error));
        }
    }
    found.samples /= open;
    found.rmse = std::sqrt(found.rmse / open);
    return found;
}

const Polygon slanted{{3.3, 4.2}, {44.6, 9.1}, {20.7, 41.9}};
const Polygon thin{{3.3, 4.2}, {43.1, 30.4}, {44.6, 34.2}};

/// A pixel is done at a squared error of 26 T^2, of white that is 0.5 bright.
TEST(Edges, OpenPixelsCoverWhatTheirPolygonsDo) {
    for (const auto& [aa, tolerance] :
         {std::pair{"edges:0.001", 1e-3}, {"edges:0.0001", 1e-4}, {"edges:0.00001", 1e-5}}) {
        const Coverage found = coverage(slanted, aa);
        EXPECT_LT(found.rmse, 2 * std::sqrt(26.0) * tolerance) << aa;
        EXPECT_LT(found.worst, 100 * tolerance) << aa;
    }
}

/// In one pixel the tip lies between all first samples.
TEST(Edges, FindsThinTipsOnFurtherLines) {
    const Coverage found = coverage(thin, "edges:0.00001");
    EXPECT_LT(found.rmse, 2e-3);
    EXPECT_LT(found.worst, 0.02);
}

/// Point samples cost 20 times as much.
TEST(Edges, EachDigitDoublesTheSamplesAtAnEdge) {
    const double first = coverage(slanted, "edges:0.001").samples;
    const double second = coverage(slanted, "edges:0.0001").samples;
    EXPECT_GT(second, 1.5 * first);
    EXPECT_LT(second, 2.2 * first);
    EXPECT_LT(coverage(slanted, "edges:0.00001").samples, 2.2 * second);
}

class Rounds : public testing::TestWithParam<const char*> {};

/// Packets hold lanes that meet glass and lanes that do not; margins of tiles overlap.
TEST_P(Rounds, HaveTheSameBitsAndRaysInAnyPacketAndTile) {
    Scene scene = load_named_scene("glass");
    set_image_size(scene, 60, 44);
    scene.aa = *parse_aa_mode(GetParam());
    const FlatScene<float> flat = flatten<float>(scene);
    const auto render = [&](int lanes, int width, int height) {
        ThreadsOptions options;
        options.kernels.lanes = lanes;
        RayCounts rays;
        const Film<float> film = whole_film(*make_threads_renderer(flat, options), scene.width,
                                            scene.height, {0, 0, width, height}, &rays);
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
        EXPECT_LT(edges.rmse, 2e-3) << stem;
        EXPECT_LT(edges.rmse, sobol.rmse) << stem;
        EXPECT_LT(edges.samples, 8) << stem;
    }
}

}  // namespace
}  // namespace rt::test::this_file
