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

CameraNumbers linear(const Key& a, const Key& b, double share) {
    return (1 - share) * CameraNumbers(a.camera) + share * CameraNumbers(b.camera);
}

/// The tangent at keys[i], per frame: Catmull and Rom 1974, for unequal key spacing.
CameraNumbers slope(const std::vector<Key>& keys, std::size_t i) {
    const Key& before = keys[i == 0 ? 0 : i - 1];
    const Key& after = keys[std::min(i + 1, keys.size() - 1)];
    return 1 / (after.frame - before.frame) *
           (CameraNumbers(after.camera) - CameraNumbers(before.camera));
}

/// The cubic Hermite curve from keys[i] to the next.
CameraNumbers smooth(const std::vector<Key>& keys, std::size_t i, double share) {
    const double frames = keys[i + 1].frame - keys[i].frame;
    const double s = share, rest = 1 - share;
    CameraNumbers view = (1 + 2 * s) * rest * rest * CameraNumbers(keys[i].camera) +
                         s * s * (3 - 2 * s) * CameraNumbers(keys[i + 1].camera) +
                         s * rest * rest * frames * slope(keys, i) -
                         s * s * rest * frames * slope(keys, i + 1);
    // Splines overshoot; the field of view must not.
    const auto [low, high] =
        std::minmax(keys[i].camera.field_of_view.amount, keys[i + 1].camera.field_of_view.amount);
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
    const CameraNumbers view =
        scene.path.is_smooth ? smooth(keys, i, share) : linear(keys[i], *next, share);
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
