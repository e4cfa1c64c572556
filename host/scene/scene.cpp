// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/scene/geometry.h"

namespace rt {
namespace {

/// Half the extent at distance 1 from the eye that a full angle spans.
double half_extent(double degrees) { return std::tan(degrees * (std::numbers::pi / 360.0)); }

Scene::Window centered(double half_width, double half_height) {
    return {-half_width, half_width, -half_height, half_height};
}

using Key = Scene::CameraPath::Key;

/// Adds `factor` times `slope` times the way from one camera to another to the numbers that are
/// interpolated.
void add_way(Scene::Camera& view, double factor, double slope, const Scene::Camera& start,
             const Scene::Camera& end) {
    view.from += factor * (slope * (end.from - start.from));
    view.at += factor * (slope * (end.at - start.at));
    view.up += factor * (slope * (end.up - start.up));
    const double amount = end.field_of_view.amount - start.field_of_view.amount;
    view.field_of_view.amount += factor * (slope * amount);
}

/// Between keys[i] and the next: a straight line, or a cubic Hermite curve with the tangents of
/// Catmull and Rom 1974, for unequal key spacing. Where the camera stands still it is the same to
/// the last bit.
Scene::Camera between(const std::vector<Key>& keys, std::size_t i, double share, bool is_smooth) {
    const double frames = keys[i + 1].frame - keys[i].frame;
    const double s = share, rest = 1 - share;
    const Key &start = keys[i], &end = keys[i + 1];
    Scene::Camera view = start.camera;
    add_way(view, is_smooth ? s * s * (3 - 2 * s) : s, 1, start.camera, end.camera);
    const auto add_tangent = [&](double factor, std::size_t at) {
        const Key& before = keys[at == 0 ? 0 : at - 1];
        const Key& after = keys[std::min(at + 1, keys.size() - 1)];
        const double slope = frames / (after.frame - before.frame);
        add_way(view, factor, slope, before.camera, after.camera);
    };
    if (is_smooth) {
        add_tangent(s * rest * rest, i);
        add_tangent(-s * s * rest, i + 1);
    }
    // Splines and rounding overshoot; the field of view must not.
    const double one = start.camera.field_of_view.amount, other = end.camera.field_of_view.amount;
    double& amount = view.field_of_view.amount;
    amount = std::clamp(amount, std::min(one, other), std::max(one, other));
    return view;
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

std::string name_of_file(const std::string& path) {
    return printable(std::filesystem::path(path).stem().string());
}

Scene::Camera camera_at(const Scene& scene, double frame) {
    const std::vector<Key>& keys = scene.path.keys;
    if (keys.empty()) {
        throw Error(ExitCode::input, scene.name +
                                         ": no camera path; add \"path\" to the scene "
                                         "(docs/scene-format.md), or leave out --frames");
    }
    const auto next = std::upper_bound(keys.begin(), keys.end(), frame,
                                       [](double f, const Key& key) { return f < key.frame; });
    if (next == keys.begin()) return keys.front().camera;
    if (next == keys.end()) return keys.back().camera;
    const auto i = static_cast<std::size_t>(next - keys.begin()) - 1;
    const double share = (frame - keys[i].frame) / (next->frame - keys[i].frame);
    if (share == 0) return keys[i].camera;
    const Scene::Camera camera = between(keys, i, share, scene.path.is_smooth);
    if (const auto mistake = find_axes_mistake(camera.from, camera.at, camera.up)) {
        throw Error(ExitCode::input, fmt::format("{}: the camera's path at frame {}: {}",
                                                 scene.name, frame, mistake->message));
    }
    return camera;
}

}  // namespace rt
