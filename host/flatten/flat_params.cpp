// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/flat_params.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "host/flatten/flat_shapes.h"

namespace rt {

namespace {

/// Half a pixel's size on the view plane. Pixels are exactly square unless the author gave a
/// window: otherwise rays on a picture's diagonal would miss edges there by 1e-16.
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
template <typename LaunchParams>
void set_sampling(const Scene& scene, LaunchParams& params) {
    const bool is_sobol = scene.aa.pattern == AaMode::Pattern::sobol;
    params.sampling = is_sobol ? f32::RT_SAMPLES_SOBOL : f32::RT_SAMPLES_GRID;
    params.grid = is_sobol ? 0 : scene.aa.count;
    params.samples = scene.aa.samples();
    params.seed = scene.sampling_seed;
    switch (scene.filter) {
        case Filter::box:
            params.filter = f32::RT_FILTER_BOX;
            break;
        case Filter::tent:
            params.filter = f32::RT_FILTER_TENT;
            break;
        case Filter::gaussian:
            params.filter = f32::RT_FILTER_GAUSSIAN;
            break;
        case Filter::mitchell:
            params.filter = f32::RT_FILTER_MITCHELL;
            break;
    }
}

}  // namespace

template <typename T>
typename Flat<T>::LaunchParams flatten_params(const ViewFrame& view, const Scene& scene) {
    const Scene::Window window = camera_window(scene.camera, scene.width, scene.height);
    const glm::dvec2 step = half_pixel(scene, window);
    const glm::dvec3 dx = view.right * step.x;
    const glm::dvec3 dy = view.up * step.y;
    typename Flat<T>::LaunchParams params{};
    if (scene.camera.projection == Scene::Projection::perspective) {
        const glm::dvec3 middle = view.forward + view.right * (0.5 * (window.left + window.right)) +
                                  view.up * (0.5 * (window.bottom + window.top));
        params.direction = pack<T>(middle);
        params.direction_low = pack_low<T>(middle);
        params.direction_dx = pack<T>(dx);
        params.direction_dx_low = pack_low<T>(dx);
        params.direction_dy = pack<T>(dy);
        params.direction_dy_low = pack_low<T>(dy);
    } else {
        params.direction = pack<T>(view.forward);
        params.direction_low = pack_low<T>(view.forward);
        params.origin_dx = pack<T>(dx * view.scale);
        params.origin_dy = pack<T>(dy * view.scale);
    }
    params.width = scene.width;
    params.height = scene.height;
    set_sampling(scene, params);
    params.max_bounces = scene.max_bounces;
    params.background = pack<T>(scene.background);
    params.ambient_light = pack<T>(scene.ambient_light);
    return params;
}

template f32::LaunchParams flatten_params<float>(const ViewFrame&, const Scene&);
template f64::LaunchParams flatten_params<double>(const ViewFrame&, const Scene&);

}  // namespace rt
