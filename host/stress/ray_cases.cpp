// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "host/stress/case_helpers.h"
#include "host/stress/families.h"
#include "host/stress/meshes.h"
#include "host/stress/ray_trials.h"
#include "host/stress/shape_families.h"
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

RayTrial leak_trial(const Scene& scene, RayAim aim) {
    return both_precisions([=]<typename T>(std::uint64_t rays, const RayCaster& caster) {
        return count_leaks<T>(scene, aim, rays, caster);
    });
}

StressFamily leak_rays(RayAim aim) {
    StressFamily family;
    family.name = aim == RayAim::edges ? "rays-at-edges" : "rays-at-vertices";
    family.parameter = "closed mesh";
    family.why = aim == RayAim::edges ? "edge functions of neighbors round apart"
                                      : "three roundings meet at a vertex";
    const auto add = [&](const char* label, const StressMesh& mesh, glm::dvec3 eye) {
        family.cases.push_back(ray_case(label, static_cast<double>(family.cases.size()),
                                        InQuick::yes, leak_trial(mesh_scene(mesh, eye), aim)));
    };
    add("bumpy-ball", bumpy_mesh(2), glm::dvec3(0));
    add("fan", fan_mesh(250), {0.125, 0.125, 0});
    add("needles", needle_mesh(12, 4, 1e-6), {0.125, 0.125, 0});
    add("tiny-ball", placed(bumpy_mesh(1), 1e-6, {3, 2, 1}), {3, 2, 1});
    add("far-ball", placed(bumpy_mesh(1), 1, {148376, 1234, -223423}), glm::dvec3(0));
    return family;
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
    StressTolerance tolerance;
    tolerance.most_wrong = std::numeric_limits<std::size_t>::max();
    StressFamily family{"t-junctions", "aim", "never watertight; counted, not judged", {}};
    family.cases = {
        ray_case("edges", 0, InQuick::yes, leak_trial(scene, RayAim::edges), tolerance),
        ray_case("vertices", 1, InQuick::no, leak_trial(scene, RayAim::vertices), tolerance)};
    return family;
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
        const Scene scene = sphere_scene(radius, distances * radius);
        return both_precisions([=]<typename T>(std::uint64_t rays, const RayCaster& caster) {
            return count_leaving_failures<T>(scene, shallowest, rays, caster);
        });
    });
}

StressFamily sphere_rays() {
    return outline_family("sphere-rays", [](double radius) {
        const Scene scene = sphere_scene(radius, 1);
        return both_precisions([=]<typename T>(std::uint64_t rays, const RayCaster& caster) {
            return count_sphere_failures<T>(scene, rays, caster);
        });
    });
}

}  // namespace

void add_ray_families(StressFamilies& families) {
    families.push_back(leak_rays(RayAim::edges));
    families.push_back(leak_rays(RayAim::vertices));
    families.push_back(t_junctions());
    families.push_back(
        leaving_spheres("leaving-sphere", 3,
                        "an absolute epsilon is acne on large balls and a hole in small ones"));
    families.push_back(leaving_spheres("leaving-far-sphere", 1000,
                                       "the same with the ball a thousand radii away"));
    families.push_back(sphere_rays());
}

}  // namespace rt
