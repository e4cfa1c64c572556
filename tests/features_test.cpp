// SPDX-License-Identifier: Apache-2.0
//
// Every feature and every two of them alone, and all but one, are built, with warnings as
// errors, and rendered; leaving out changes no bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "host/error.h"
#include "host/flatten/flat_scene.h"
#include "host/render/cl_program.h"
#include "tests/render_helpers.h"

namespace rt::test {
namespace {

/// Enough of a shape that the scene has for a hierarchy.
void add_a_row(Scene& scene) {
    for (int i = 0; i < 30; ++i) {
        const glm::dvec3 p(0.1 * i - 1.5, 0.8 - 0.05 * (i % 5), -0.5);
        if (!scene.spheres.empty()) {
            scene.spheres.push_back({p, 0.06, 0});
        } else if (!scene.cones.empty()) {
            scene.cones.push_back({p, p + glm::dvec3(0, 0.1, 0), 0.06, 0.02, 0});
        } else {
            scene.triangles.push_back(
                {{{p, p + glm::dvec3(0.1, 0, 0), p + glm::dvec3(0, 0.1, 0)}}, {}, 0});
        }
    }
}

/// A small scene that needs exactly these features.
Scene scene_needing(const Features& features) {
    Scene scene;
    scene.camera.from = {0, 0.5, 3};
    scene.camera.window = {-1, 1, -0.75, 0.75};
    scene.width = 32;
    scene.height = 24;
    scene.background = {0.1, 0.2, 0.3};
    scene.ambient_light = {0.3, 0.3, 0.3};
    Scene::Material material;
    material.ambient = material.diffuse = {0.8, 0.6, 0.4};
    material.specular = {0.5, 0.5, 0.5};
    material.shininess = 20;
    if (features.mirrors) material.mirror = {0.3, 0.4, 0.5};
    if (features.glass) {
        material.transmission = {0.6, 0.5, 0.4};
        material.ior = 1.4;
    }
    scene.materials.push_back(material);
    if (features.lights) scene.lights = {{{2, 3, 4}, {1, 1, 1}}, {{-3, 1, 2}, {0.4, 0.5, 0.6}}};
    if (features.spheres) scene.spheres = {{{0, 0.2, 0}, 0.7, 0}, {{0.9, 0, 0.6}, 0.4, 0}};
    if (features.cones) {
        scene.cones = {{{-0.8, -0.9, 0.8}, {-0.5, 0.6, 0.4}, 0.3, 0.1, 0},
                       {{0.9, 0.5, 0.4}, {0.2, 0.9, 0.2}, 0.2, 0.2, 0}};
    }
    if (features.triangles) {
        scene.triangles = {{{{{-3, -1, 3}, {3, -1, 3}, {0, -1, -6}}}, {}, 0},
                           {{{{-1, -1, -1}, {-0.2, -1, 0.2}, {-0.8, 1, 0}}}, {}, 0}};
    }
    if (features.huge_spheres) scene.spheres.push_back({{0, -1e5 - 2, 0}, 1e5, 0});
    if (features.eye_on_surface && features.spheres) {
        scene.spheres.push_back({{0, 0.5, 3.25}, 0.25, 0});
    } else if (features.eye_on_surface && features.cones) {
        scene.cones.push_back({{-0.2, 0.5, 3.25}, {0.2, 0.5, 3.25}, 0.25, 0.25, 0});
    } else if (features.eye_on_surface) {
        scene.triangles.push_back({{{{-2, 0.5, 0}, {2, 0.5, 0}, {0, 0.5, -2}}}, {}, 0});
    }
    if (features.vertex_normals) {
        scene.triangles[1].normals = {{{-0.6, 0, 0.8}, {0.6, 0, 0.8}, {0, 0.6, 0.8}}};
    }
    if (features.hierarchy) add_a_row(scene);
    if (features.sobol) scene.aa = *parse_aa_mode("sobol:4");
    if (features.filters) scene.filter = Filter::tent;
    return scene;
}

/// Whether some scene needs exactly these.
bool is_possible(const Features& features) {
    if (features.vertex_normals && !features.triangles) return false;
    if (features.huge_spheres && !features.spheres) return false;
    const bool any_shape = features.spheres || features.cones || features.triangles;
    if (features.eye_on_surface && !any_shape) return false;
    return any_shape ||
           !(features.hierarchy || features.lights || features.mirrors || features.glass);
}

std::vector<Features> some_combinations() {
    std::vector<Features> combinations;
    for (unsigned bits = 0; bits < 1u << feature_names.size(); ++bits) {
        Features features;
        for (std::size_t i = 0; i < feature_names.size(); ++i) {
            features.*feature_names[i].flag = (bits >> i & 1) != 0;
        }
        const int used = std::popcount(bits), left_out = int(feature_names.size()) - used;
        if ((used <= 2 || left_out <= 1) && is_possible(features)) combinations.push_back(features);
    }
    return combinations;
}

class SomeCombinations : public testing::TestWithParam<Features> {};

TEST_P(SomeCombinations, IsWhatTheSceneNeedsAndGivesTheBitsOfAllFeatures) {
    const Scene scene = scene_needing(GetParam());
    ASSERT_EQ(flatten<float>(scene).features, GetParam());
    const std::uint64_t reference = hash_of(render_on_threads<float>(scene));
    EXPECT_EQ(hash_of(render_on_device<float>(scene, cl_options(Launch::pixel))), reference);
    EXPECT_EQ(hash_of(render_on_device<float>(scene, cl_options(Launch::pixel, true))), reference);
}

INSTANTIATE_TEST_SUITE_P(Features, SomeCombinations, testing::ValuesIn(some_combinations()),
                         [](const auto& info) {
                             std::string name;
                             for (const auto& used : names_of(info.param, true)) name += used + "_";
                             std::replace(name.begin(), name.end(), ' ', '_');
                             return name.empty() ? "nothing" : name.substr(0, name.size() - 1);
                         });

/// Their number is compiled in where a packet holds them; 1 and 4 are in lanes_test.
TEST(RenderPixels, GivesTheSameBitsWithTwoSamples) {
    Features features = no_features();
    features.spheres = features.lights = features.sobol = true;
    Scene scene = scene_needing(features);
    scene.aa = *parse_aa_mode("sobol:2");
    const std::uint64_t reference = hash_of(render_on_threads<float>(scene));
    for (const int lanes : {1, 2, 8}) {
        ClOptions options = cl_options(Launch::pixel);
        options.lanes = lanes;
        EXPECT_EQ(hash_of(render_on_device<float>(scene, options)), reference) << lanes;
    }
}

TEST(BuildOptions, HaveTheNumberOfSamplesOnlyWhereItIsGiven) {
    ProgramOptions options;
    EXPECT_EQ(build_options(test_device(), options).find("RT_SAMPLES"), std::string::npos);
    options.samples = 4;
    EXPECT_NE(build_options(test_device(), options).find(" -DRT_SAMPLES=4"), std::string::npos);
}

std::string entry_points_of(const ProgramOptions& options) {
    const cl::Context context(test_device().handle);
    const cl::Program program = build_program(context, test_device(), render_kernels, options);
    return program.getInfo<CL_PROGRAM_KERNEL_NAMES>();
}

TEST(BuildProgram, HoldsTheEntryPointsThatAreLaunched) {
    ProgramOptions options;
    options.features = no_features();
    options.entries = {true, false, false, false};
    EXPECT_EQ(entry_points_of(options), "render_pixels");
    options.entries = {false, true, false, false};
    EXPECT_EQ(entry_points_of(options), "render_samples;resolve_samples");
    options.entries = {true, false, true, false};
    EXPECT_EQ(entry_points_of(options), "render_pixels;render_listed");
}

TEST(BuildProgram, DeclaresItselfWhatKernelsCallWherePoclWouldReadALongHeader) {
    if (test_device().platform != pocl_platform) GTEST_SKIP();
    const auto expect_own_declarations = [](const char* source, const ProgramOptions& options) {
        const cl::Context context(test_device().handle);
        const cl::Program program = build_program(context, test_device(), source, options);
        const auto used = program.getBuildInfo<CL_PROGRAM_BUILD_OPTIONS>(test_device().handle);
        EXPECT_NE(used.find("RT_DECLARES_BUILTINS"), std::string::npos) << used;
    };
    ProgramOptions options;
    options.warnings_are_errors = true;
    options.lanes = 16;
    expect_own_declarations(render_kernels, options);
    options.entries = {true, false, false, false};
    for (const int lanes : {1, 4}) {
        options.lanes = lanes;
        for (const bool double_precision : {false, true}) {
            options.double_precision = double_precision;
            expect_own_declarations(render_kernels, options);
        }
    }
}

TEST(BuildProgram, LeavesTheDeclarationsToTheCompilerWhereKernelsCallOtherFunctions) {
    const cl::Context context(test_device().handle);
    const char* source = "__kernel void sines(__global float *x) { *x = sin(*x); }";
    const cl::Program program = build_program(context, test_device(), source, {});
    EXPECT_EQ(program.getInfo<CL_PROGRAM_KERNEL_NAMES>(), "sines");
}

TEST(Flatten, LeavesOutLightsThatShineOnNothing) {
    Scene scene = scene_needing(Features{});
    scene.lights.push_back({{0, 5, 0}, {0, 0, 0}});
    EXPECT_EQ(flatten<float>(scene).lights.size(), 2u);
    scene.materials[0].diffuse = scene.materials[0].specular = {0, 0, 0};
    EXPECT_TRUE(flatten<float>(scene).lights.empty());
    EXPECT_FALSE(flatten<float>(scene).features.lights);
}

TEST(Flatten, MirrorsAreNotNeededWithoutBouncesOrWithoutAnyoneWearingThem) {
    Scene scene = scene_needing(Features{});
    EXPECT_TRUE(flatten<float>(scene).features.mirrors);
    scene.max_bounces = 0;
    EXPECT_FALSE(flatten<float>(scene).features.mirrors);
    scene.max_bounces = 8;
    Scene::Material plain = scene.materials[0];
    plain.mirror = {0, 0, 0};
    scene.materials.push_back(plain);
    for (auto& sphere : scene.spheres) sphere.material = 1;
    for (auto& cone : scene.cones) cone.material = 1;
    for (auto& triangle : scene.triangles) triangle.material = 1;
    EXPECT_FALSE(flatten<float>(scene).features.mirrors);
}

TEST(Flatten, RefusesATreeDeeperThanItsStack) {
    Scene scene = scene_needing(Features{});
    scene.max_bounces = f32::RT_TREE_STACK;
    EXPECT_TRUE(flatten<float>(scene).features.glass);
    scene.max_bounces += 1;
    try {
        flatten<double>(scene);
        ADD_FAILURE() << "not refused";
    } catch (const Error& error) {
        EXPECT_EQ(error.exit_code(), ExitCode::limit);
        EXPECT_NE(std::string(error.what()).find("max_bounces"), std::string::npos);
    }
    scene.materials[0].mirror = {0, 0, 0};
    EXPECT_TRUE(flatten<float>(scene).features.glass);
    scene.max_bounces = 0;
    EXPECT_FALSE(flatten<float>(scene).features.glass);
}

}  // namespace
}  // namespace rt::test
