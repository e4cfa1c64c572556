// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/view_frame.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

namespace rt {

namespace {

/// v / |v| without overflow or underflow on the way.
glm::dvec3 unit(const glm::dvec3& v) {
    const double largest = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
    return glm::normalize(v / largest);
}

double farthest_vertex(const Scene::Triangle& triangle, const glm::dvec3& eye) {
    double distance = 0;
    for (const glm::dvec3& vertex : triangle.vertices) {
        distance = std::max(distance, glm::distance(vertex, eye));
    }
    return distance;
}

double median_distance(const Scene& scene, const glm::dvec3& eye) {
    std::vector<double> distances;
    distances.reserve(scene.spheres.size() + scene.triangles.size());
    for (const auto& sphere : scene.spheres) {
        distances.push_back(std::max(glm::distance(sphere.center, eye), sphere.radius));
    }
    for (const auto& triangle : scene.triangles) {
        distances.push_back(farthest_vertex(triangle, eye));
    }
    if (distances.empty()) return 1;
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    return *middle;
}

}  // namespace

ViewFrame make_view_frame(const Scene& scene) {
    const Scene::Camera& camera = scene.camera;
    ViewFrame frame;
    frame.eye = camera.from;
    frame.forward = unit(camera.at - camera.from);
    frame.right = unit(glm::cross(frame.forward, unit(camera.up)));
    frame.up = glm::cross(frame.right, frame.forward);
    if (camera.projection == Scene::Projection::orthographic) {
        const Scene::Window window = camera_window(camera, scene.width, scene.height);
        frame.eye += frame.right * (0.5 * (window.left + window.right)) +
                     frame.up * (0.5 * (window.bottom + window.top));
    }
    frame.scale = std::ldexp(1.0, -std::ilogb(median_distance(scene, frame.eye)));
    return frame;
}

}  // namespace rt
