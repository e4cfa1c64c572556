// SPDX-License-Identifier: Apache-2.0
//
// host/flatten/view_frame.h: what an eye ray is made of.
#include <gtest/gtest.h>

#include "host/flatten/flat_scene.h"
#include "tests/refusals.h"

namespace rt::this_file {
namespace {

TEST(FlattenFrame, HasPixelsThatAreSquareToTheLastBitWhicheverSideTheFieldOfViewSpans) {
    using Fixed = Scene::FieldOfView::Fixed;
    for (const Fixed fixed : {Fixed::horizontal, Fixed::vertical}) {
        Scene scene;
        scene.camera.from = {0, 0, 2};
        scene.camera.at = {0, 0, 1};
        scene.camera.field_of_view = {fixed, 60};
        for (int i = 0; i < 1000; ++i) {
            scene.width = 100 + 7 * i;
            scene.height = 90 + 11 * i;
            const auto params = flatten<double>(scene).params;
            ASSERT_EQ(params.direction_dx.x, params.direction_dy.y) << scene.width;
            ASSERT_EQ(params.direction_dx.y, 0);
            ASSERT_EQ(params.direction_dy.x, 0);
        }
    }
}

TEST(FlattenFrame, HasTheAuthorsWindowWhateverItsShape) {
    Scene scene;
    scene.camera.field_of_view.fixed = Scene::FieldOfView::Fixed::window;
    scene.camera.window = {-2, 2, -1, 1};
    scene.width = scene.height = 8;
    const auto params = flatten<double>(scene).params;
    EXPECT_EQ(params.direction_dx.x, 0.25);
    EXPECT_EQ(params.direction_dy.y, 0.125);
}

TEST(FlattenFrame, RefusesRadiiWhoseSquaresOverflow) {
    Scene scene;
    scene.camera.from = {0, 0, 5};
    scene.materials.resize(1);
    for (const double x : {-1.5, 0.0, 1.5}) scene.spheres.push_back({{x, 0, 0}, 0.5, 0});
    Scene with_cone = scene;
    scene.spheres.push_back({{1, 2, 0}, 1e25, 0});
    for (const auto& [base, apex] : {std::pair(1e25, 1.0), {1.0, 1e25}}) {
        with_cone.cones = {{{0, -1, 0}, {0, 1, 0}, base, apex, 0}};
        EXPECT_EQ(refusal_of([&] { flatten<float>(with_cone); }).exit_code, ExitCode::input);
        flatten<double>(with_cone);
    }
    EXPECT_NE(refusal_of([&] { flatten<float>(scene); }).message.find("precision double"),
              std::string::npos);
    flatten<double>(scene);
}

TEST(FlattenFrame, RefusesTrianglesWhoseAreasOverflow) {
    const auto triangle = [](double size) {
        return Scene::Triangle{{{{-size, -size, 0}, {size, -size, 0}, {0, size, 0}}}, {}, 0};
    };
    for (const double small : {1e-70, 1e-80}) {
        Scene scene;
        scene.camera.from = {0, 0, 5 * small};
        scene.materials.resize(1);
        scene.triangles.assign(5, triangle(small));
        scene.triangles.push_back(triangle(3));
        if (small < 1e-75) {
            EXPECT_EQ(refusal_of([&] { flatten<double>(scene); }).exit_code, ExitCode::input);
        } else {
            EXPECT_NE(flatten<double>(scene).triangles.back().normal.z, 0);
        }
    }
}

}  // namespace
}  // namespace rt::this_file
