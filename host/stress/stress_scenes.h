// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <glm/vec3.hpp>
#include <numbers>
#include <vector>

#include "host/scene/scene.h"

namespace rt {

// Scenes that the families vary. Coordinates are multiples of 1/64, so that integer shifts up to
// 1e9 are exact.

/// Four balls (one a mirror), a pyramid, a floor that mirrors a little, two lights, five bounces.
Scene still_life();

/// The same with a glass ball, a glass cube that mirrors a little, a cone, a tube and a frustum.
Scene glass_still_life();

/// A camera, matt and shiny materials, two lights, a small picture; nothing in it.
Scene bare_scene();

/// A small picture of a shape to be added about the origin, in material 0, which is shiny on both
/// sides; the eye 1 before it. The view is at most 120 degrees high.
Scene shape_scene(double fov_degrees);

/// What add_shape(scene, middle) adds, in material 0, this far from the eye; and three specks that
/// keep the scale of the scene at 1. The shape comes first.
Scene scene_to_aim_at(double distance,
                      const std::function<void(Scene&, const glm::dvec3& middle)>& add_shape);

inline double degrees(double radians) { return radians * 180 / std::numbers::pi; }

void set_view(Scene& scene, glm::dvec3 from, glm::dvec3 at, double fov_degrees);

/// An orthographic view, `height` scene units high.
void set_orthographic(Scene& scene, glm::dvec3 from, glm::dvec3 at, double height);

/// Index of a new material: ambient and diffuse of a color, specular 0.5 with shininess 50.
int add_matt(Scene& scene, glm::dvec3 color, double specular = 0.5, double shininess = 50);

/// Index of a new material that mirrors, with a little light of its own.
int add_mirror(Scene& scene, double mirror, double ambient = 0.05);

/// Index of a new material that lets light through, with a little light of its own.
int add_glass(Scene& scene, double ior, double transmission = 0.875, double mirror = 0,
              double ambient = 0);

void add_sphere(Scene& scene, glm::dvec3 center, double radius, int material);
void add_triangle(Scene& scene, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, int material);

/// The side of a frustum, open at both ends.
void add_cone(Scene& scene, glm::dvec3 base, double base_radius, glm::dvec3 apex,
              double apex_radius, int material);

/// Two triangles; a, b, c, d counterclockwise seen from the front, the diagonal from a to c.
void add_quad(Scene& scene, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 d, int material);

/// A level square about (center.x, y, center.z), its front up.
void add_floor(Scene& scene, glm::dvec3 center, double half_side, int material);

/// A box with its sides along the axes, fronts out.
void add_box(Scene& scene, glm::dvec3 low, glm::dvec3 high, int material);

/// Every length of the scene times the factor.
void scale_scene(Scene& scene, double factor);

void shift_scene(Scene& scene, glm::dvec3 by);

}  // namespace rt
