// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <glm/vec3.hpp>

#include "host/scene/scene.h"

namespace rt {

// Scenes that the families vary. Coordinates are multiples of 1/64, so that integer shifts up to
// 1e9 are exact.

/// Four balls (one a mirror), a pyramid, a slightly reflective floor, two lights, five bounces.
Scene still_life();

/// It with glass balls, a slightly reflective glass box, a cone, a tube and a frustum.
Scene glass_still_life();

/// A camera, two lights, a small picture; no materials or objects.
Scene bare_scene(int width = 160, int height = 120);

/// A scene with the shape that add_shape(scene, middle) adds in material 0, this far from the eye,
/// and three specks that keep the scene's scale at 1. The shape comes first.
Scene scene_to_aim_at(double distance,
                      const std::function<void(Scene&, const glm::dvec3& middle)>& add_shape);

void set_view(Scene& scene, glm::dvec3 from, glm::dvec3 at, double fov_degrees);

/// An orthographic view, `height` scene units high.
void set_orthographic(Scene& scene, glm::dvec3 from, glm::dvec3 at, double height);

/// Index of a new material with this color as ambient and diffuse.
int add_matt(Scene& scene, glm::dvec3 color, double specular = 0.5, double shininess = 50);

/// Index of a new mirror material with a little ambient light.
int add_mirror(Scene& scene, double mirror, double ambient = 0.05);

/// Index of a new transparent material with a little ambient light.
int add_glass(Scene& scene, double ior, double transmission = 0.875, double mirror = 0,
              double ambient = 0);

void add_sphere(Scene& scene, glm::dvec3 center, double radius, int material);
void add_triangle(Scene& scene, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, int material);

/// The side of a frustum, open at both ends.
void add_cone(Scene& scene, glm::dvec3 base, double base_radius, glm::dvec3 apex,
              double apex_radius, int material);

/// Two triangles; a, b, c, d counterclockwise seen from the front, the diagonal from a to c.
void add_quad(Scene& scene, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 d, int material);

/// A horizontal square around `center`, facing up.
void add_floor(Scene& scene, glm::dvec3 center, double half_side, int material);

/// An axis-aligned box, facing outwards.
void add_box(Scene& scene, glm::dvec3 low, glm::dvec3 high, int material);

/// The scene with every length multiplied by the factor.
Scene scaled(Scene scene, double factor);

Scene shifted(Scene scene, glm::dvec3 by);

// Meshes of positions and faces.

/// An icosahedron (20 faces) on the unit sphere, each face split in four `times` times.
Scene::Mesh ball_mesh(int times);

/// The same with its vertices moved in and out by up to a fifth, at random.
Scene::Mesh bumpy_mesh(int times);

/// Two hubs joined to the same rim of `spokes` points: closed, thin at the hubs.
Scene::Mesh fan_mesh(int spokes);

/// A fan whose rim points come in clusters `gap` wide: needles of length 1 among wide triangles.
Scene::Mesh needle_mesh(int clusters, int needles, double gap);

/// A prism along z over a triangle: two sides of length 1 that meet at this angle.
Scene::Mesh wedge_mesh(double degrees);

/// A box from -1 to 1.
Scene::Mesh box_mesh();

/// Scaled, then moved.
Scene::Mesh placed(Scene::Mesh mesh, double scale, glm::dvec3 to);

void add_mesh(Scene& scene, const Scene::Mesh& mesh, int material);

}  // namespace rt
