// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

#include "host/stress/wide_shapes.h"

namespace rt::stress {

/// The scene's camera for the reference, in wide reals.
template <typename R>
class WideCamera {
   public:
    explicit WideCamera(const Scene& scene)
        : width_(scene.width),
          height_(scene.height),
          parallel_(scene.camera.projection == Scene::Projection::orthographic) {
        const Scene::Camera& camera = scene.camera;
        from_ = widened<R>(camera.from);
        forward_ = unit(widened<R>(camera.at) - from_);
        right_ = unit(cross(forward_, widened<R>(camera.up)));
        up_ = cross(right_, forward_);
        set_window(camera);
    }

    /// The ray through the point (x, y) of the picture, in pixels from its top left corner.
    WideRay<R> eye_ray(R x, R y) const {
        const R across = left_ + (right_side_ - left_) * x / width_;
        const R upwards = top_ - (top_ - bottom_) * y / height_;
        const Wide3<R> offset = across * right_ + upwards * up_;
        if (parallel_) return {from_ + offset, forward_};
        return {from_, unit(forward_ + offset)};
    }

    /// Whether all eye rays start at `from`.
    bool has_one_eye() const { return !parallel_; }

   private:
    /// The window's sides; a field of view gives square pixels.
    void set_window(const Scene::Camera& camera) {
        using Fixed = Scene::FieldOfView::Fixed;
        const double amount = camera.field_of_view.amount;
        const long double angle = amount * (std::numbers::pi_v<long double> / 360);
        const R half_angle = std::tan(angle);
        switch (camera.field_of_view.fixed) {
            case Fixed::window:
                left_ = camera.window.left, right_side_ = camera.window.right;
                bottom_ = camera.window.bottom, top_ = camera.window.top;
                return;
            case Fixed::horizontal:
                return span(half_angle, half_angle * height_ / width_);
            case Fixed::vertical:
                return span(half_angle * width_ / height_, half_angle);
            case Fixed::view_width:
                return span(R(amount) / 2, R(amount) / 2 * height_ / width_);
            case Fixed::view_height:
                return span(R(amount) / 2 * width_ / height_, R(amount) / 2);
        }
    }

    void span(R half_width, R half_height) {
        left_ = -half_width, right_side_ = half_width;
        bottom_ = -half_height, top_ = half_height;
    }

    R width_, height_;
    bool parallel_;
    Wide3<R> from_, forward_, right_, up_;
    R left_ = -1, right_side_ = 1, bottom_ = -1, top_ = 1;
};

}  // namespace rt::stress
