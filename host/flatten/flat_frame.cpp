// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/flat_frame.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "host/flatten/flat_shapes.h"

namespace rt {

namespace {

/// Half a pixel's sides on the view plane. Pixels are square, to the last bit, unless the author
/// gave a window: else rays on a picture's diagonal would miss edges that lie there by 1e-16.
glm::dvec2 half_pixel(const Scene& scene, const Scene::Window& window) {
    using Fixed = Scene::FieldOfView::Fixed;
    const double x = (window.right - window.left) / (2.0 * scene.width);
    const double y = (window.top - window.bottom) / (2.0 * scene.height);
    switch (scene.camera.field_of_view.fixed) {
        case Fixed::window:
            return {x, y};
        case Fixed::horizontal:
        case Fixed::view_width:
            return {x, x};
        case Fixed::vertical:
        case Fixed::view_height:
            return {y, y};
    }
    return {x, y};
}

/// An adaptive mode begins with one sample a pixel.
template <typename Frame>
void set_sampling(const Scene& scene, Frame& frame) {
    frame.grid = scene.aa.pattern == AaMode::Pattern::sobol ? 0 : scene.aa.count;
    frame.samples = scene.aa.samples();
    frame.seed = scene.sampling_seed;
    switch (scene.filter) {
        case Filter::box:
            frame.filter = f32::RT_FILTER_BOX;
            break;
        case Filter::tent:
            frame.filter = f32::RT_FILTER_TENT;
            break;
        case Filter::gaussian:
            frame.filter = f32::RT_FILTER_GAUSSIAN;
            break;
        case Filter::mitchell:
            frame.filter = f32::RT_FILTER_MITCHELL;
            break;
    }
}

}  // namespace

template <typename T>
typename Flat<T>::Frame flatten_frame(const ViewFrame& view, const Scene& scene) {
    const Scene::Window window = camera_window(scene.camera, scene.width, scene.height);
    const glm::dvec2 step = half_pixel(scene, window);
    const glm::dvec3 dx = view.right * step.x;
    const glm::dvec3 dy = view.up * step.y;
    typename Flat<T>::Frame frame{};
    if (scene.camera.projection == Scene::Projection::perspective) {
        const glm::dvec3 middle = view.forward + view.right * (0.5 * (window.left + window.right)) +
                                  view.up * (0.5 * (window.bottom + window.top));
        frame.direction = pack<T>(middle);
        frame.direction_low = pack_low<T>(middle);
        frame.direction_dx = pack<T>(dx);
        frame.direction_dx_low = pack_low<T>(dx);
        frame.direction_dy = pack<T>(dy);
        frame.direction_dy_low = pack_low<T>(dy);
    } else {
        frame.direction = pack<T>(view.forward);
        frame.direction_low = pack_low<T>(view.forward);
        frame.origin_dx = pack<T>(dx * view.scale);
        frame.origin_dy = pack<T>(dy * view.scale);
    }
    frame.width = scene.width;
    frame.height = scene.height;
    set_sampling(scene, frame);
    frame.max_bounces = scene.max_bounces;
    frame.background = pack<T>(scene.background);
    frame.ambient_light = pack<T>(scene.ambient_light);
    return frame;
}

template f32::Frame flatten_frame<float>(const ViewFrame&, const Scene&);
template f64::Frame flatten_frame<double>(const ViewFrame&, const Scene&);

}  // namespace rt
