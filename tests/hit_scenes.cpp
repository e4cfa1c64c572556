// SPDX-License-Identifier: Apache-2.0
#include "tests/hit_scenes.h"

#include <algorithm>

#include "host/stress/stress_scenes.h"

namespace rt {

void add_triangle(Scene& scene, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    if (glm::length(glm::cross(b - a, c - a)) > 0) scene.triangles.push_back({{{a, b, c}}, {}, 0});
}

void add_floor(Scene& scene, int n, double half, double z) {
    const auto at = [&](int i, int j) {
        return glm::dvec3(half * (2.0 * i / n - 1), half * (2.0 * j / n - 1), z);
    };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            add_triangle(scene, at(i, j), at(i + 1, j), at(i + 1, j + 1));
            add_triangle(scene, at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
}

namespace {

void add_soup(Scene& scene, Random& random, int count, double place, double size) {
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 p = random.in_cube(place);
        const auto corner = [&] { return p + random.in_cube(size); };
        const glm::dvec3 a = corner(), b = corner();
        add_triangle(scene, a, b, corner());
    }
}

void add_mesh(Scene& scene, const Scene::Mesh& shape, const glm::dvec3& center, double size) {
    Scene::Mesh mesh;
    for (const glm::dvec3& p : shape.positions) mesh.positions.push_back(center + size * p);
    mesh.faces = shape.faces;
    mesh.face_materials = {0};
    scene.meshes.push_back(mesh);
}

void add_flake(Scene& scene, const glm::dvec3& center, double radius, int levels) {
    scene.spheres.push_back({center, radius, 0});
    if (levels == 0) return;
    for (int i = 0; i < 6; ++i) {
        glm::dvec3 way(0);
        way[i % 3] = i < 3 ? 1 : -1;
        add_flake(scene, center + 1.5 * radius * way, 0.5 * radius, levels - 1);
    }
}

Scene::Mesh bumpy(Random& random, Scene::Mesh mesh) {
    for (glm::dvec3& vertex : mesh.positions) vertex *= random.uniform(0.8, 1.2);
    return mesh;
}

}  // namespace

const std::vector<HitScene>& hit_scenes() {
    static const std::vector<HitScene> all{
        {"soup", [](Scene& s, Random& r) { add_soup(s, r, 400, 1, 0.3); }},
        {"large soup, small soup",
         [](Scene& s, Random& r) {
             add_soup(s, r, 40, 1, 2);
             add_soup(s, r, 300, 1, 0.01);
         }},
        {"bumpy mesh",
         [](Scene& s, Random& r) {
             add_mesh(s, bumpy(r, ball_mesh(2)), {0.1, 0, 0}, 1);
         }},
        {"sphere flake",
         [](Scene& s, Random&) {
             add_flake(s, {0, 0, 0}, 0.5, 3);
         }},
        {"floor and cloud",
         [](Scene& s, Random& r) {
             add_floor(s, 10, 1);
             add_soup(s, r, 100, 0.5, 0.2);
             for (int i = 0; i < 50; ++i)
                 s.spheres.push_back({r.in_cube(1), r.uniform(0.01, 0.2), 0});
         }},
        {"cones",
         [](Scene& s, Random& r) {
             for (int i = 0; i < 200; ++i) {
                 const double size = r.log_uniform(0.02, 0.5);
                 const glm::dvec3 p = r.in_cube(1);
                 const double ends[] = {r.uniform(0.01, 0.4) * size, r.uniform(0, 0.4) * size};
                 s.cones.push_back({p, p + size * r.unit_vector(), ends[0],
                                    r.index(3) == 0 ? ends[0] : ends[1] * r.index(2), 0});
             }
             for (int i = 0; i < 20; ++i) s.cones.push_back(s.cones[std::size_t(i)]);
         }},
        {"rings without height",
         [](Scene& s, Random& r) {
             for (int i = 0; i < 60; ++i) {
                 const glm::dvec3 base = r.in_cube(1);
                 const double radius = r.uniform(0.1, 1),
                              height = radius * r.log_uniform(1e-9, 0.1);
                 s.cones.push_back({base, base + height * r.unit_vector(), radius,
                                    radius * r.uniform(0, 0.9), 0});
             }
         },
         false},
        {"cones, spheres and soup",
         [](Scene& s, Random& r) {
             for (int i = 0; i < 60; ++i) {
                 const glm::dvec3 p = r.in_cube(1), q = r.in_cube(1);
                 s.cones.push_back({p, q, 0.02, 0.02, 0});
                 s.spheres.push_back({p, 0.05, 0});
             }
             add_soup(s, r, 60, 1, 0.3);
         }},
        {"needles",
         [](Scene& s, Random& r) {
             for (int i = 0; i < 300; ++i) {
                 const glm::dvec3 p = r.in_cube(1), q = r.in_cube(1);
                 add_triangle(s, p, q, q + 1e-5 * r.unit_vector());
             }
         }},
        {"grid",
         [](Scene& s, Random&) {
             for (int k = -2; k <= 2; ++k) add_floor(s, 8, 1, 0.25 * k);
         }},
        {"copies",
         [](Scene& s, Random& r) {
             add_soup(s, r, 60, 1, 0.7);
             const auto once = s.triangles;
             for (int copy = 0; copy < 4; ++copy) {
                 for (auto triangle : once) {
                     std::rotate(triangle.vertices.begin(), triangle.vertices.begin() + copy % 3,
                                 triangle.vertices.end());
                     s.triangles.push_back(triangle);
                 }
             }
             std::shuffle(s.triangles.begin(), s.triangles.end(), std::mt19937(5));
             for (int i = 0; i < 30; ++i) s.spheres.push_back({r.in_cube(1), 0.3, 0});
             for (int i = 29; i >= 0; --i) s.spheres.push_back(s.spheres[std::size_t(i)]);
         }},
        {"coplanar layers",
         [](Scene& s, Random& r) {
             for (int i = 0; i < 300; ++i) {
                 const double z = 1e-7 * r.index(3);
                 const auto corner = [&] {
                     return glm::dvec3(r.uniform(-1, 1), r.uniform(-1, 1), z);
                 };
                 const glm::dvec3 a = corner(), b = corner();
                 add_triangle(s, a, b, corner());
             }
         }},
        {"wide range",
         [](Scene& s, Random& r) {
             for (int i = 0; i < 200; ++i) {
                 const double size = r.log_uniform(1e-5, 1e4);
                 const glm::dvec3 p = size * r.in_cube(2);
                 add_triangle(s, p, p + size * r.unit_vector(), p + size * r.unit_vector());
                 s.spheres.push_back({size * r.in_cube(2), size * r.uniform(0.1, 1), 0});
             }
         }},
    };
    return all;
}

Scene make_scene(const HitScene& made_of) {
    Random random(11);
    Scene scene;
    scene.materials.emplace_back();
    scene.camera.from = {0.25, 0.5, 2};
    made_of.fill(scene, random);
    return scene;
}

}  // namespace rt
