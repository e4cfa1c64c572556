// SPDX-License-Identifier: Apache-2.0
//
// host/flatten/view_frame.h: what an eye ray is made of.
#include <gtest/gtest.h>

#include "host/flatten/flat_scene.h"

namespace rt {
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

}  // namespace
}  // namespace rt
