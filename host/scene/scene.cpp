// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene.h"

#include <cmath>
#include <numbers>

namespace rt {
namespace {

/// Half the extent at distance 1 from the eye that a full angle spans.
double half_extent(double degrees) { return std::tan(degrees * (std::numbers::pi / 360.0)); }

Scene::Window centered(double half_width, double half_height) {
    return {-half_width, half_width, -half_height, half_height};
}

}  // namespace

Scene::Window camera_window(const Scene::Camera& camera, int width, int height) {
    using Fixed = Scene::FieldOfView::Fixed;
    const double amount = camera.field_of_view.amount;
    const auto from_width = [&](double half) { return centered(half, half * height / width); };
    const auto from_height = [&](double half) { return centered(half * width / height, half); };
    switch (camera.field_of_view.fixed) {
        case Fixed::window:
            break;
        case Fixed::horizontal:
            return from_width(half_extent(amount));
        case Fixed::vertical:
            return from_height(half_extent(amount));
        case Fixed::view_width:
            return from_width(amount / 2);
        case Fixed::view_height:
            return from_height(amount / 2);
    }
    return camera.window;
}

std::size_t triangle_count(const Scene& scene) {
    std::size_t count = scene.triangles.size();
    for (const Scene::Mesh& mesh : scene.meshes) count += mesh.faces.size();
    return count;
}

void set_image_size(Scene& scene, int width, int height) {
    scene.width = width;
    scene.height = height;
    scene.camera.window = camera_window(scene.camera, width, height);
}

}  // namespace rt
