// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/view_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "host/base/parallel.h"
#include "host/flatten/flat_shapes.h"

namespace rt {

namespace {

/// v / |v| without intermediate overflow or underflow.
glm::dvec3 unit(const glm::dvec3& v) {
    const double largest = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
    return glm::normalize(v / largest);
}

/// |v|, for any finite v.
double length_of(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 1e-150 && length < 1e150 ? length : std::hypot(v.x, v.y, v.z);
}

double farthest_vertex(const TriangleList::Corners& corners, const glm::dvec3& eye) {
    double distance = 0;
    for (const glm::dvec3& corner : corners) distance = std::max(distance, length_of(corner - eye));
    return distance;
}

double farthest_rim(const Scene::Cone& cone, const glm::dvec3& eye) {
    return std::max({length_of(cone.base - eye), length_of(cone.apex - eye), cone.base_radius,
                     cone.apex_radius});
}

/// The distance to the sphere's surface, but not 0 if the eye lies on it.
double surface_distance(const Scene::Sphere& sphere, const glm::dvec3& eye) {
    const double distance = std::abs(length_of(sphere.center - eye) - sphere.radius);
    return std::max(distance, 0x1p-30 * sphere.radius);
}

/// How many distances lie in [2^k, 2^(k + 1)), for every k.
class Octaves {
   public:
    void add(double distance) {
        ++counts_[static_cast<std::size_t>(std::clamp(std::ilogb(distance), lowest, -lowest) -
                                           lowest)];
    }
    void add(const Octaves& other) {
        for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
    }
    /// The k of the median; 0 if there are no distances.
    int median() const {
        std::uint64_t total = 0;
        for (const std::uint64_t count : counts_) total += count;
        if (total == 0) return 0;
        std::uint64_t below = 0;
        for (std::size_t i = 0;; ++i) {
            below += counts_[i];
            if (below > total / 2) return static_cast<int>(i) + lowest;
        }
    }

   private:
    static constexpr int lowest = -1022;
    std::array<std::uint64_t, 1 - 2 * lowest> counts_{};
};

Octaves distance_octaves(const Scene& scene, const TriangleList& triangles, const glm::dvec3& eye,
                         int threads) {
    Octaves octaves;
    for (const auto& sphere : scene.spheres) {
        octaves.add(surface_distance(sphere, eye));
    }
    for (const auto& cone : scene.cones) octaves.add(farthest_rim(cone, eye));
    constexpr std::size_t run = 1 << 15;
    const auto count = static_cast<std::size_t>(triangles.size());
    std::vector<Octaves> parts((count + run - 1) / run);
    for_each_run(count, run, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            parts[first / run].add(farthest_vertex(triangles.corners(i), eye));
        }
    });
    for (const Octaves& part : parts) octaves.add(part);
    return octaves;
}

/// Half a pixel's size on the view plane. Pixels are exactly square unless the author gave a
/// window: otherwise rays on a picture's diagonal would miss edges there by 1e-16.
glm::dvec2 half_pixel(const Scene& scene, const Scene::Window& window) {
    using Fixed = Scene::FieldOfView::Fixed;
    const double x = (window.right - window.left) / (2.0 * scene.width);
    const double y = (window.top - window.bottom) / (2.0 * scene.height);
    const Fixed fixed = scene.camera.field_of_view.fixed;
    if (fixed == Fixed::window) return {x, y};
    if (fixed == Fixed::horizontal || fixed == Fixed::view_width) return {x, x};
    return {y, y};
}

/// Adaptive and edges modes begin with one sample a pixel.
template <typename LaunchParams>
void set_sampling(const Scene& scene, LaunchParams& params) {
    const bool is_sobol = scene.aa.pattern == AaMode::Pattern::sobol;
    params.sampling = is_sobol ? f32::RT_SAMPLES_SOBOL : f32::RT_SAMPLES_GRID;
    params.grid = is_sobol ? 0 : scene.aa.count;
    params.samples = scene.aa.samples();
    params.seed = scene.sampling_seed;
    using Real = decltype(params.tolerance);
    params.tolerance = scene.aa.finds_edges() ? static_cast<Real>(scene.aa.threshold) : Real(0);
    params.threshold = scene.aa.refines() ? static_cast<Real>(scene.aa.threshold) : Real(0);
    constexpr int filters[] = {f32::RT_FILTER_BOX, f32::RT_FILTER_TENT, f32::RT_FILTER_GAUSSIAN,
                               f32::RT_FILTER_MITCHELL};  // in the order of Filter
    params.filter = filters[static_cast<std::size_t>(scene.filter)];
}

}  // namespace

ViewFrame make_view_frame(const Scene& scene, const TriangleList& triangles, int threads) {
    const Scene::Camera& camera = scene.camera;
    ViewFrame frame;
    frame.eye = camera.from;
    frame.forward = unit(camera.at - camera.from);
    frame.right = unit(glm::cross(frame.forward, unit(camera.up)));
    frame.up = glm::cross(frame.right, frame.forward);
    frame.is_perspective = camera.projection == Scene::Projection::perspective;
    if (!frame.is_perspective) {
        const Scene::Window window = camera_window(camera, scene.width, scene.height);
        frame.eye += frame.right * (0.5 * (window.left + window.right)) +
                     frame.up * (0.5 * (window.bottom + window.top));
    }
    const Octaves octaves = distance_octaves(scene, triangles, frame.eye, threads);
    frame.scale = std::ldexp(1.0, -octaves.median());
    return frame;
}

std::vector<glm::dvec3> eye_ray_origins(const ViewFrame& view, const Scene& scene) {
    const Scene::Camera& camera = scene.camera;
    if (camera.projection == Scene::Projection::perspective) return {camera.from};
    const Scene::Window window = camera_window(camera, scene.width, scene.height);
    std::vector<glm::dvec3> origins;
    for (const double x : {window.left, window.right}) {
        for (const double y : {window.bottom, window.top}) {
            origins.push_back(camera.from + view.right * x + view.up * y);
        }
    }
    return origins;
}

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
