// SPDX-License-Identifier: Apache-2.0
//
// Each feature alone is built for the device, with warnings as errors, and rendered; leaving
// features out changes no bit. switches_test renders every possible set natively.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "host/flatten/flat_scene.h"
#include "host/opencl/cl_renderer.h"
#include "host/opencl/opencl.h"
#include "tests/feature_scenes.h"
#include "tests/refusals.h"
#include "tests/render_helpers.h"

namespace rt::test::this_file {
namespace {

/// No features, each one that a scene can need alone, and all.
std::vector<Features> lone_features() {
    std::vector<Features> sets;
    for (unsigned bits = 0; bits < 1u << feature_names.size(); ++bits) {
        const Features features = Features(bits);
        const std::size_t used = std::popcount(bits);
        if ((used <= 1 || used == feature_names.size()) && is_possible(features)) {
            sets.push_back(features);
        }
    }
    return sets;
}

class OneFeatureAlone : public testing::TestWithParam<Features> {};

TEST_P(OneFeatureAlone, IsWhatTheSceneNeedsAndGivesTheBitsOfAllFeatures) {
    const Scene scene = scene_needing(GetParam());
    ASSERT_EQ(flatten<float>(scene).features, GetParam());
    const std::uint64_t reference = hash_of(render_on_threads<float>(scene));
    ClOptions options = cl_options(Launch::pixel);
    options.kernels.cl_options = "-Werror";
    EXPECT_EQ(hash_of(render_on_device<float>(scene, options)), reference);
    EXPECT_EQ(hash_of(render_on_device<float>(scene, cl_options(Launch::pixel, true))), reference);
}

std::string set_name(const testing::TestParamInfo<Features>& info) {
    std::string name;
    for (const auto& used : names_of(info.param, true)) name += used + "_";
    std::replace(name.begin(), name.end(), ' ', '_');
    return name.empty() ? "nothing" : name.substr(0, name.size() - 1);
}

INSTANTIATE_TEST_SUITE_P(Features, OneFeatureAlone, testing::ValuesIn(lone_features()), set_name);

/// The number of samples is compiled in if a packet holds them; 1 and 4 are in lanes_test.
TEST(RenderPixels, GivesTheSameBitsWithTwoSamples) {
    Features features;
    features[feature::spheres] = features[feature::lights] = features[feature::sobol] = true;
    Scene scene = scene_needing(features);
    scene.aa = *parse_aa_mode("sobol:2");
    const std::uint64_t reference = hash_of(render_on_threads<float>(scene));
    for (const int lanes : {1, 2, 8}) {
        ClOptions options = cl_options(Launch::pixel);
        options.kernels.lanes = lanes;
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
    const cl::Context context(handle_of(test_device()));
    const cl::Program program = build_program(context, test_device(), render_kernels, options);
    return program.getInfo<CL_PROGRAM_KERNEL_NAMES>();
}

TEST(BuildProgram, HoldsTheEntryPointsThatAreLaunched) {
    ProgramOptions options;
    options.features = Features();
    options.entries = {true, false, false};
    EXPECT_EQ(entry_points_of(options), "render_pixels;sum_counts");
    options.entries = {false, true, false};
    EXPECT_EQ(entry_points_of(options), "render_samples;resolve_samples;sum_counts");
    options.entries = {false, false, false, true};
    EXPECT_EQ(entry_points_of(options), "render_centers;render_round;sum_counts");
    options.entries = {false, false, false, false, true};
    options.features[feature::edges] = true;
    EXPECT_EQ(entry_points_of(options), "render_centers;render_round;sum_counts");
}

TEST(BuildProgram, DeclaresItselfWhatKernelsCallWherePoclWouldReadALongHeader) {
    if (test_device().platform != pocl_platform) GTEST_SKIP();
    const auto expect_own_declarations = [](const char* source, const ProgramOptions& options) {
        const cl::Context context(handle_of(test_device()));
        const cl::Program program = build_program(context, test_device(), source, options);
        const auto used = program.getBuildInfo<CL_PROGRAM_BUILD_OPTIONS>(handle_of(test_device()));
        EXPECT_NE(used.find("RT_DECLARES_BUILTINS"), std::string::npos) << used;
    };
    ProgramOptions options;
    options.more = "-Werror -cl-opt-disable";  // takes half the time
    options.lanes = packet_lanes<float>(0, test_device());
    expect_own_declarations(render_kernels, options);
    options.entries = {true, false, false};
    for (const int lanes : {1, 4}) {
        options.lanes = lanes;
        for (const Precision precision : {Precision::float32, Precision::float64}) {
            options.precision = precision;
            expect_own_declarations(render_kernels, options);
        }
    }
}

TEST(BuildProgram, LeavesTheDeclarationsToTheCompilerWhereKernelsCallOtherFunctions) {
    const cl::Context context(handle_of(test_device()));
    const char* source = "__kernel void sines(__global float *x) { *x = sin(*x); }";
    const cl::Program program = build_program(context, test_device(), source, {});
    EXPECT_EQ(program.getInfo<CL_PROGRAM_KERNEL_NAMES>(), "sines");
}

TEST(Flatten, LeavesOutLightsThatShineOnNothing) {
    Scene scene = scene_needing(every_feature);
    scene.lights.push_back({{0, 5, 0}, {0, 0, 0}});
    EXPECT_EQ(flatten<float>(scene).lights.size(), 2u);
    scene.materials[0].diffuse = scene.materials[0].specular = {0, 0, 0};
    EXPECT_TRUE(flatten<float>(scene).lights.empty());
    EXPECT_FALSE(flatten<float>(scene).features[feature::lights]);
}

TEST(Flatten, MirrorsAreNotNeededWithoutBouncesOrWithoutAnyoneWearingThem) {
    Scene scene = scene_needing(every_feature);
    EXPECT_TRUE(flatten<float>(scene).features[feature::mirrors]);
    scene.max_bounces = 0;
    EXPECT_FALSE(flatten<float>(scene).features[feature::mirrors]);
    scene.max_bounces = 8;
    Scene::Material plain = scene.materials[0];
    plain.mirror = {0, 0, 0};
    scene.materials.push_back(plain);
    for (auto& sphere : scene.spheres) sphere.material = 1;
    for (auto& cone : scene.cones) cone.material = 1;
    for (auto& triangle : scene.triangles) triangle.material = 1;
    EXPECT_FALSE(flatten<float>(scene).features[feature::mirrors]);
}

TEST(Flatten, RefusesATreeDeeperThanItsStack) {
    Scene scene = scene_needing(every_feature);
    scene.max_bounces = f32::RT_TREE_STACK;
    EXPECT_TRUE(flatten<float>(scene).features[feature::glass]);
    scene.max_bounces += 1;
    const auto [code, message] = refusal_of([&] { flatten<double>(scene); });
    EXPECT_EQ(code, ExitCode::limit);
    EXPECT_NE(message.find("max_bounces"), message.npos);
    scene.materials[0].mirror = {0, 0, 0};
    EXPECT_TRUE(flatten<float>(scene).features[feature::glass]);
    scene.max_bounces = 0;
    EXPECT_FALSE(flatten<float>(scene).features[feature::glass]);
}

}  // namespace
}  // namespace rt::test::this_file
