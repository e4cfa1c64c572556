// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "host/scene/scene.h"
#include "host/scene/scene_file.h"
#include "tests/refusals.h"

namespace rt::test::this_file {
namespace {

Scene scene_with(const std::string& path) {
    return parse_json_scene(R"({"camera": {"from": [0, 0, 5], "at": [0, 0, 0], "fov_degrees": 60},
                               "path": )" +
                                path + "}",
                            "path.json");
}

TEST(CameraPath, IsAtItsKeysAndStaysAtItsEnds) {
    for (const char* kind : {"linear", "catmull-rom"}) {
        const Scene scene = scene_with(
            std::string(R"({"interpolation": ")") + kind +
            R"(", "keys": [{"frame": 1, "from": [1, 0, 5]}, {"frame": 5, "at": [0, 1, 0]},
                           {"frame": 6, "fov_degrees": 20, "up": [1, 1, 0]}]})");
        EXPECT_EQ(camera_at(scene, -3).from, glm::dvec3(1, 0, 5));
        EXPECT_EQ(camera_at(scene, 1).from, glm::dvec3(1, 0, 5));
        EXPECT_EQ(camera_at(scene, 5).from, glm::dvec3(0, 0, 5));
        EXPECT_EQ(camera_at(scene, 5).at, glm::dvec3(0, 1, 0));
        EXPECT_EQ(camera_at(scene, 5).field_of_view.amount, 60);
        EXPECT_EQ(camera_at(scene, 6).up, glm::dvec3(1, 1, 0));
        EXPECT_EQ(camera_at(scene, 99).field_of_view.amount, 20);
    }
}

TEST(CameraPath, LinearIsAStraightLine) {
    const Scene scene = scene_with(
        R"({"interpolation": "linear", "keys": [{"frame": 0, "from": [0, 0, 4]},
            {"frame": 8, "from": [8, 4, 4], "fov_degrees": 20}]})");
    const Scene::Camera camera = camera_at(scene, 2);
    EXPECT_EQ(camera.from, glm::dvec3(2, 1, 4));
    EXPECT_DOUBLE_EQ(camera.field_of_view.amount, 50);
}

TEST(CameraPath, TurntableGoesOnceAround) {
    const Scene scene = scene_with(R"({"turntable": 8})");
    EXPECT_EQ(camera_at(scene, 1).from, glm::dvec3(0, 0, 5));
    EXPECT_EQ(camera_at(scene, 3).from, glm::dvec3(5, 0, 0));
    EXPECT_EQ(camera_at(scene, 7).from, glm::dvec3(-5, 0, 0));
    EXPECT_NEAR(camera_at(scene, 2).from.x, std::sqrt(12.5), 1e-15);
    EXPECT_EQ(scene.path.keys.size(), 8);
    EXPECT_THROW(scene_with(R"({"turntable": 1})"), Error);
    EXPECT_THROW(scene_with(R"({"turntable": 8, "keys": []})"), Error);
}

/// Equally spaced keys on a parabola: central differences are its slopes, so a Catmull-Rom spline
/// between two inner keys is the parabola.
TEST(CameraPath, SplineRunsAlongAParabola) {
    std::string keys;
    for (int frame = 0; frame <= 3; ++frame) {
        keys += (frame == 0 ? "" : ",") + ("{\"frame\": " + std::to_string(10 * frame)) +
                ", \"from\": [" + std::to_string(frame * frame) + ", " + std::to_string(frame) +
                ", 9]}";
    }
    const Scene scene = scene_with("{\"keys\": [" + keys + "]}");
    for (int frame = 10; frame <= 20; ++frame) {
        const double t = frame / 10.0;
        const glm::dvec3 from = camera_at(scene, frame).from;
        EXPECT_NEAR(from.x, t * t, 1e-14) << frame;
        EXPECT_NEAR(from.y, t, 1e-14) << frame;
        EXPECT_NEAR(from.z, 9, 1e-14) << frame;
    }
}

TEST(CameraPath, FieldOfViewDoesNotOvershoot) {
    const Scene scene = scene_with(
        R"({"keys": [{"frame": 0, "fov_degrees": 179}, {"frame": 1, "fov_degrees": 179},
                     {"frame": 2, "fov_degrees": 1}, {"frame": 3, "fov_degrees": 1}]})");
    for (double frame = 0; frame <= 3; frame += 0.05) {
        const double degrees = camera_at(scene, frame).field_of_view.amount;
        EXPECT_GE(degrees, 1) << frame;
        EXPECT_LE(degrees, 179) << frame;
    }
}

TEST(CameraPath, FieldOfViewIsNotRoundedUpTo180Degrees) {
    const Scene scene = scene_with(
        R"({"interpolation": "linear", "keys": [{"frame": 0, "fov_degrees": 179.99999999999997},
            {"frame": 100, "fov_degrees": 179.99999999999997}]})");
    for (int frame = 0; frame <= 100; ++frame) {
        EXPECT_LT(camera_at(scene, frame).field_of_view.amount, 180) << frame;
    }
}

TEST(CameraPath, StandsStillBetweenEqualKeys) {
    for (const char* kind : {"linear", "catmull-rom"}) {
        const Scene scene = scene_with(
            std::string(R"({"interpolation": ")") + kind +
            R"(", "keys": [{"frame": 1, "from": [0.1, 0.7, 1e9]}, {"frame": 90, "from": [0.1, 0.7, 1e9]}]})");
        for (int frame = 1; frame <= 90; ++frame) {
            EXPECT_EQ(camera_at(scene, frame).from, glm::dvec3(0.1, 0.7, 1e9)) << frame;
            EXPECT_EQ(camera_at(scene, frame).up, glm::dvec3(0, 1, 0)) << frame;
        }
    }
}

TEST(CameraPath, MayHaveKeysAnyTimeApart) {
    for (const double gap : {1e-323, 1e-300, 1e-20, 1e20, 1e30}) {
        const Scene scene = scene_with(fmt::format(
            R"({{"keys": [{{"frame": {}, "from": [0, 1e-300, 5]}},
                          {{"frame": {}, "from": [2, 3e-300, 5]}}]}})",
            -gap, gap));
        EXPECT_EQ(camera_at(scene, 0).from.x, 1) << gap;
        EXPECT_DOUBLE_EQ(camera_at(scene, 0).from.y, 2e-300) << gap;
    }
}

TEST(CameraPath, RefusesAViewWithoutADirection) {
    const Scene scene = scene_with(
        R"({"interpolation": "linear", "keys": [{"frame": 0, "from": [0, 0, 5]},
            {"frame": 2, "from": [0, 0, -5]}]})");
    EXPECT_EQ(camera_at(scene, 1.5).from.z, -2.5);
    const Refusal refusal = refusal_of([&] { camera_at(scene, 1); });
    EXPECT_EQ(refusal.exit_code, ExitCode::input);
    EXPECT_NE(refusal.message.find("frame 1"), std::string::npos) << refusal.message;
}

TEST(CameraPath, RefusesASceneWithoutOne) { EXPECT_THROW(camera_at(Scene{}, 1), Error); }

}  // namespace
}  // namespace rt::test::this_file
