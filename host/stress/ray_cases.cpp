// SPDX-License-Identifier: Apache-2.0
#include <glm/geometric.hpp>
#include <limits>

#include "host/stress/families.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

/// The mesh alone, the eye in its middle or far from it.
Scene mesh_scene(const StressMesh& mesh, glm::dvec3 eye) {
    Scene scene = bare_scene();
    add_mesh(scene, mesh, add_matt(scene, glm::dvec3(0.5)));
    set_view(scene, eye, eye + glm::dvec3(0, 0, -1), 60);
    return scene;
}

StressFamily leak_rays(const char* name, const char* why, RayAim aim) {
    const auto at = [=](const StressMesh& mesh, glm::dvec3 eye) {
        return ray_case(leaks(mesh_scene(mesh, eye), aim));
    };
    const StressMesh far = placed(bumpy_mesh(1), 1, {148376, 1234, -223423});
    return listed(
        {name, "closed mesh", why},
        {{"bumpy-ball", InQuick::yes, at(bumpy_mesh(2), glm::dvec3(0))},
         {"fan", InQuick::yes, at(fan_mesh(250), {0.125, 0.125, 0})},
         {"needles", InQuick::yes, at(needle_mesh(12, 4, 1e-6), {0.125, 0.125, 0})},
         {"tiny-ball", InQuick::yes, at(placed(bumpy_mesh(1), 1e-6, {3, 2, 1}), {3, 2, 1})},
         {"far-ball", InQuick::yes, at(far, glm::dvec3(0))}});
}

/// An octahedron with a T-junction: a vertex on one side of an edge and none on the other. Such a
/// mesh is closed on paper only, so its leaks are counted, not judged.
StressFamily t_junctions() {
    StressMesh mesh = fan_mesh(4);
    const int middle = static_cast<int>(mesh.vertices.size());
    const auto [a, b, c] = mesh.faces[0];
    const auto vertex = [&](int i) { return mesh.vertices[static_cast<std::size_t>(i)]; };
    mesh.vertices.push_back(vertex(b) + 0.3 * (vertex(c) - vertex(b)));
    mesh.faces[0] = {a, b, middle};
    mesh.faces.push_back({a, middle, c});
    const Scene scene = mesh_scene(mesh, {0.125, 0.125, 0});
    const StressTolerance any{.most_wrong = std::numeric_limits<std::size_t>::max()};
    return listed({"t-junctions", "aim", "never watertight; counted, not judged"},
                  {{"edges", InQuick::yes, ray_case(leaks(scene, RayAim::edges), any)},
                   {"vertices", InQuick::no, ray_case(leaks(scene, RayAim::vertices), any)}});
}

/// Slanted, so that no coordinate is exact.
StressMesh slanted(StressMesh mesh) {
    const glm::dvec3 x = glm::normalize(glm::dvec3(5, 3, -2));
    const glm::dvec3 y = glm::normalize(glm::cross(x, glm::dvec3(1, -4, 2)));
    const glm::dvec3 z = glm::cross(x, y);
    for (auto& p : mesh.vertices) p = p.x * x + p.y * y + p.z * z;
    return mesh;
}

StressFamily leaving_edges() {
    std::vector<LabeledCase> cases;
    const auto add = [&](const std::string& label, const StressMesh& mesh, glm::dvec3 eye) {
        const Scene scene = mesh_scene(mesh, eye);
        for (const MeshSide side : {MeshSide::inside, MeshSide::outside}) {
            RayTrial trial = edge_escapes(scene, side);
            trial.rays = 1'000'000;
            cases.push_back({label + (side == MeshSide::inside ? "-inside" : "-outside"),
                             InQuick::yes, ray_case(trial)});
        }
    };
    add("box", box_mesh(), {0.5, -0.25, 0.99});
    add("slanted-box", slanted(box_mesh()), {3, 2, 1});
    for (const int degrees : {1, 3, 10, 30, 60, 90, 120, 150, 170, 179}) {
        add(fmt::format("wedge-{}", degrees), slanted(wedge_mesh(degrees)), {0.5, 0.25, 0.125});
    }
    add("ball", ball_mesh(2), {0.125, 0.25, 0.5});
    add("fine-ball", ball_mesh(4), {0, 0, 3});
    return listed({"leaving-edges", "closed mesh, side",
                   "secondary rays from an edge start beyond the neighboring face"},
                  cases);
}

/// A sphere this far from the eye.
Scene sphere_scene(double radius, double distance) {
    return scene_to_aim_at(distance, [=](Scene& scene, const glm::dvec3& middle) {
        add_sphere(scene, middle, radius, 0);
    });
}

/// A point at that distance is rounded by `distances` times u of the radius, which tilts a chord.
StressFamily leaving_spheres(const char* name, double distances, const char* why) {
    const double shallowest = distances > 10 ? 0.1 : 1e-3;
    return leaving_family(name, why, 1e-3, [=](double radius) {
        return leaving_sphere(sphere_scene(radius, distances * radius), shallowest);
    });
}

}  // namespace

StressFamilies ray_families() {
    return {
        leak_rays("rays-at-edges", "edge functions of neighboring triangles round differently",
                  RayAim::edges),
        leak_rays("rays-at-vertices", "three roundings meet at a vertex", RayAim::vertices),
        t_junctions(),
        leaving_edges(),
        leaving_spheres("leaving-sphere", 3,
                        "an absolute epsilon causes acne on large balls and holes in small ones"),
        leaving_spheres("leaving-far-sphere", 1000, "the same with the ball a thousand radii away"),
        outline_family("sphere-rays",
                       [](double radius) { return past_sphere(sphere_scene(radius, 1)); })};
}

}  // namespace rt
