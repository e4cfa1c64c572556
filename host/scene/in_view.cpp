// SPDX-License-Identifier: Apache-2.0
#include "host/scene/in_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

#include "host/scene/geometry_checks.h"

namespace rt {
namespace {

/// A sphere, or a point where the radius is 0.
struct BoundingSphere {
    glm::dvec3 center{0};
    double radius = 0;
};

/// Points with dot(normal, p) > limit are out of view; normals are of length 1.
struct Side {
    glm::dvec3 normal{0};
    double limit = 0;

    bool hides(const BoundingSphere& sphere) const {
        return glm::dot(normal, sphere.center) - sphere.radius > limit;
    }
};

/// The eye is the origin.
using Sides = std::array<Side, 5>;

Sides sides_of(const Scene::Camera& camera) {
    const glm::dvec3 forward = unit_direction(camera.at - camera.from).value_or(glm::dvec3(0));
    const glm::dvec3 sideways = glm::cross(forward, camera.up);
    const glm::dvec3 right = unit_direction(sideways).value_or(glm::dvec3(0));
    const glm::dvec3 up = glm::cross(right, forward);
    const Scene::Window& w = camera.window;
    if (camera.projection == Scene::Projection::orthographic) {
        return {
            {{-forward, 0}, {right, w.right}, {-right, -w.left}, {up, w.top}, {-up, -w.bottom}}};
    }
    const auto side = [&](const glm::dvec3& axis, double edge) {
        return Side{glm::normalize(axis - edge * forward), 0};
    };
    return {{{-forward, 0},
             side(right, w.right),
             side(-right, -w.left),
             side(up, w.top),
             side(-up, -w.bottom)}};
}

class View {
   public:
    explicit View(const Scene::Camera& camera) : from_(camera.from), sides_(sides_of(camera)) {}

    /// Whether the convex hull of the spheres may be visible.
    template <std::size_t N>
    bool may_show(std::array<BoundingSphere, N> spheres) const {
        for (BoundingSphere& sphere : spheres) sphere.center -= from_;
        return std::ranges::none_of(sides_, [&](const Side& side) {
            return std::ranges::all_of(
                spheres, [&](const BoundingSphere& sphere) { return side.hides(sphere); });
        });
    }

    bool may_show(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const {
        return may_show(std::array{BoundingSphere{a}, BoundingSphere{b}, BoundingSphere{c}});
    }

   private:
    glm::dvec3 from_;
    Sides sides_;
};

bool shows_mesh(const View& view, const Scene::Mesh& mesh) {
    const auto& p = mesh.positions;
    return std::ranges::any_of(mesh.faces, [&](const Scene::Mesh::Face& face) {
        return view.may_show(p[face[0]], p[face[1]], p[face[2]]);
    });
}

}  // namespace

bool is_anything_in_view(const Scene& scene) {
    const View view(scene.camera);
    const auto shows_sphere = [&](const Scene::Sphere& s) {
        return view.may_show(std::array{BoundingSphere{s.center, s.radius}});
    };
    const auto shows_cone = [&](const Scene::Cone& c) {
        return view.may_show(std::array{BoundingSphere{c.base, c.base_radius},
                                        BoundingSphere{c.apex, c.apex_radius}});
    };
    const auto shows_triangle = [&](const Scene::Triangle& t) {
        return view.may_show(t.vertices[0], t.vertices[1], t.vertices[2]);
    };
    return std::ranges::any_of(scene.spheres, shows_sphere) ||
           std::ranges::any_of(scene.cones, shows_cone) ||
           std::ranges::any_of(scene.triangles, shows_triangle) ||
           std::ranges::any_of(scene.meshes,
                               [&](const Scene::Mesh& mesh) { return shows_mesh(view, mesh); });
}

}  // namespace rt
