// SPDX-License-Identifier: Apache-2.0
#include "host/scene/camera_path.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/base/error.h"
#include "host/scene/geometry_checks.h"

namespace rt {

namespace {

using Key = Scene::CameraPath::Key;

/// A camera's interpolated numbers, with vector arithmetic.
struct CameraNumbers {
    glm::dvec3 from, at, up;
    double amount;  ///< of the field of view

    explicit CameraNumbers(const Scene::Camera& camera)
        : from(camera.from), at(camera.at), up(camera.up), amount(camera.field_of_view.amount) {}

    CameraNumbers& operator+=(const CameraNumbers& other) {
        from += other.from;
        at += other.at;
        up += other.up;
        amount += other.amount;
        return *this;
    }

    CameraNumbers& operator*=(double factor) {
        from *= factor;
        at *= factor;
        up *= factor;
        amount *= factor;
        return *this;
    }
};

CameraNumbers operator+(CameraNumbers a, const CameraNumbers& b) { return a += b; }
CameraNumbers operator*(double factor, CameraNumbers view) { return view *= factor; }
CameraNumbers operator-(const CameraNumbers& a, const CameraNumbers& b) { return a + -1.0 * b; }

/// The tangent at keys[i] times `frames`: Catmull and Rom 1974, for unequal key spacing.
CameraNumbers tangent(const std::vector<Key>& keys, std::size_t i, double frames) {
    const Key& before = keys[i == 0 ? 0 : i - 1];
    const Key& after = keys[std::min(i + 1, keys.size() - 1)];
    return frames / (after.frame - before.frame) *
           (CameraNumbers(after.camera) - CameraNumbers(before.camera));
}

/// Between keys[i] and the next: a straight line, or a cubic Hermite curve. Where the camera stands
/// still it is the same to the last bit.
CameraNumbers between(const std::vector<Key>& keys, std::size_t i, double share, bool is_smooth) {
    const double frames = keys[i + 1].frame - keys[i].frame;
    const double s = share, rest = 1 - share;
    const CameraNumbers start(keys[i].camera), end(keys[i + 1].camera);
    CameraNumbers view = start + (is_smooth ? s * s * (3 - 2 * s) : s) * (end - start);
    if (is_smooth) {
        view += s * rest * rest * tangent(keys, i, frames);
        view += -s * s * rest * tangent(keys, i + 1, frames);
    }
    // Splines and rounding overshoot; the field of view must not.
    const auto [low, high] = std::minmax(start.amount, end.amount);
    view.amount = std::clamp(view.amount, low, high);
    return view;
}

}  // namespace

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
    const CameraNumbers view = between(keys, i, share, scene.path.is_smooth);
    Scene::Camera camera = scene.camera;
    camera.from = view.from;
    camera.at = view.at;
    camera.up = view.up;
    camera.field_of_view.amount = view.amount;
    if (const auto mistake = find_axes_mistake(camera.from, camera.at, camera.up)) {
        throw Error(ExitCode::input, fmt::format("{}: the camera's path at frame {}: {}",
                                                 scene.name, frame, mistake->message));
    }
    return camera;
}

}  // namespace rt
