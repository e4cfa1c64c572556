// SPDX-License-Identifier: Apache-2.0
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "host/scene/scene_file.h"
#include "host/stress/families.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

/// A ball of 80 faces with the normals of the sphere, seen from outside.
Scene smooth_ball(double mirror) {
    Scene scene = bare_scene();
    const int skin = add_matt(scene, {0.75, 0.5, 0.25}, 0.25, 20);
    scene.materials.back().mirror = glm::dvec3(mirror);
    add_floor(scene, {0, -1.25, 0}, 12, add_matt(scene, glm::dvec3(0.5)));
    const std::size_t first = scene.triangles.size();
    add_mesh(scene, ball_mesh(1), skin);
    for (std::size_t i = first; i < scene.triangles.size(); ++i) {
        const auto& v = scene.triangles[i].vertices;
        scene.triangles[i].normals = {glm::normalize(v[0]), glm::normalize(v[1]),
                                      glm::normalize(v[2])};
    }
    set_view(scene, {0, 0.5, 5}, {0, 0, 0}, 40);
    return scene;
}

/// A disk of 32 triangles with normals leaning far outwards: mirror rays near its rim would go
/// below.
Scene leaning_mirror() {
    Scene scene = bare_scene();
    const int mirror = add_mirror(scene, 0.75);
    add_floor(scene, {0, -2, 0}, 12, add_matt(scene, {0.875, 0.25, 0.125}));
    const Scene::Mesh fan = fan_mesh(32);
    for (const auto& [a, b, c] : fan.faces) {
        if (a != 0) continue;  // only the upper half, flattened
        const auto flat = [&](auto i) {
            const glm::dvec3 p = fan.positions[i];
            return glm::dvec3(3 * p.x, 0, 3 * p.z);
        };
        const auto lean = [&](auto i) {
            const glm::dvec3 p = flat(i);
            return glm::normalize(glm::dvec3(p.x, 1.25, p.z));
        };
        add_triangle(scene, flat(a), flat(b), flat(c), mirror);
        scene.triangles.back().normals = {lean(a), lean(b), lean(c)};
    }
    add_sphere(scene, {0, 1.5, -4}, 1.5, add_matt(scene, {0.125, 0.25, 0.875}));
    set_view(scene, {0, 1, 7}, {0, 0, 0}, 40);
    return scene;
}

/// One triangle with these normals, parsed like a scene file, which normalizes them.
Scene triangle_with_normals(const char* normals) {
    const std::string text = fmt::format(
        R"({{"camera": {{"from": [0, 0, 4], "at": [0, 0, 0], "fov_degrees": 40}},
"image": {{"width": 80, "height": 60, "aa": "none"}}, "background": [0.25, 0.375, 0.5],
"ambient_light": 0.25, "lights": [{{"position": [2, 3, 4], "intensity": 0.5}}],
"materials": {{"skin": {{"ambient": 0.5, "diffuse": 0.5, "specular": 0.25, "shininess": 20,
"mirror": 0.25, "two_sided": true}}}},
"triangles": [{{"vertices": [[-1, -1, 0], [1, -1, 0.25], [0, 1, -0.25]], "normals": {},
"material": "skin"}}]}})",
        normals);
    return parse_json_scene(text, "normals.json");
}

/// Everything is the same gray, in front of a glaring blue background. A leak is a wrong pixel.
Scene gray_scene(int width, int height, int grid) {
    Scene scene = bare_scene(width, height);
    scene.aa.count = grid;
    scene.lights.clear();
    scene.ambient_light = glm::dvec3(1);
    scene.background = {0, 0, 4};
    add_matt(scene, glm::dvec3(0.5));
    return scene;
}

/// The correct picture of such a scene is the inside of one big ball.
StressCase leak_case(const Scene& scene) {
    Scene ball = gray_scene(scene.width, scene.height, 1);
    add_sphere(ball, ball.camera.from, 100, 0);
    return seen_as(ball, picture_case(scene, {.most_wrong_at_edges = 0}));
}

StressCase inside_mesh(const Scene::Mesh& mesh, glm::dvec3 eye, glm::dvec3 at) {
    Scene scene = gray_scene(160, 120, 2);
    add_mesh(scene, mesh, 0);
    set_view(scene, eye, at, 100);
    return leak_case(scene);
}

/// A bumpy sheet over a lattice whose vertices and diagonals lie exactly on pixel rays.
Scene lattice_scene(int cells, bool perspective, double height, unsigned seed) {
    Scene scene = gray_scene(2 * cells, 2 * cells, 1);
    std::mt19937 engine(seed);
    std::uniform_int_distribution<int> level(-8, 8);
    const int n = cells + 3;
    std::vector<glm::dvec3> points;
    // `2 cells` pixels span as many units, so pixel centers lie at odd multiples of 0.5.
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const double x = 2 * i - n + 0.5, y = 2 * j - n + 0.5;
            const double z = height * level(engine) / 8;
            const double along = perspective ? 1 + z / 64 : 1;
            points.push_back({x * along, y * along, perspective ? -64 * along + 64 : z});
        }
    }
    const auto at = [&](int i, int j) { return points[static_cast<std::size_t>(j * n + i)]; };
    for (int j = 0; j + 1 < n; ++j) {
        for (int i = 0; i + 1 < n; ++i) {
            add_quad(scene, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), 0);
        }
    }
    if (perspective) {
        set_view(scene, {0, 0, 64}, {0, 0, 0}, 10);
        scene.camera.field_of_view.fixed = Scene::FieldOfView::Fixed::window;
        const double side = cells / 64.0;
        scene.camera.window = {-side, side, -side, side};
    } else {
        set_orthographic(scene, {0, 0, 64}, {0, 0, 0}, 2 * cells);
    }
    return scene;
}

/// A wall of squares at several depths seen along an axis; rays run along the sides of BVH boxes.
Scene box_wall(int axis, bool rounded) {
    Scene scene = gray_scene(64, 64, 1);
    const double step = rounded ? 1.0 / 3 : 1;
    const int n = 10;
    const auto turned = [&](glm::dvec3 p) {
        return axis == 0 ? glm::dvec3(p.z, p.x, p.y) : (axis == 1 ? glm::dvec3(p.y, p.z, p.x) : p);
    };
    const auto face = [&](glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 d) {
        add_quad(scene, turned(a), turned(b), turned(c), turned(d), 0);
    };
    for (int j = -n; j < n; ++j) {
        for (int i = -n; i < n; ++i) {
            const double x0 = i * step, x1 = (i + 1) * step, y0 = j * step, y1 = (j + 1) * step;
            const double z = ((i * 7 + j * 3) % 4) * step / 2;
            face({x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z});
        }
    }
    const double side = 16 * step;
    scene.camera.up = turned({0, 1, 0});
    set_orthographic(scene, turned({step / 8, step / 8, 8}), turned({step / 8, step / 8, 0}), side);
    return scene;
}

/// The mesh alone, the eye in its middle or far from it.
Scene mesh_scene(const Scene::Mesh& mesh, glm::dvec3 eye) {
    Scene scene = bare_scene();
    add_mesh(scene, mesh, add_matt(scene, glm::dvec3(0.5)));
    set_view(scene, eye, eye + glm::dvec3(0, 0, -1), 60);
    return scene;
}

StressFamily leak_rays(const char* name, const char* why, RayAim aim) {
    const auto at = [=](const Scene::Mesh& mesh, glm::dvec3 eye) {
        return ray_case(leaks(mesh_scene(mesh, eye), aim));
    };
    const Scene::Mesh far = placed(bumpy_mesh(1), 1, {148376, 1234, -223423});
    return listed({name, "closed mesh", why},
                  {{"bumpy-ball", quick(at(bumpy_mesh(2), glm::dvec3(0)))},
                   {"fan", quick(at(fan_mesh(250), {0.125, 0.125, 0}))},
                   {"needles", quick(at(needle_mesh(12, 4, 1e-6), {0.125, 0.125, 0}))},
                   {"tiny-ball", quick(at(placed(bumpy_mesh(1), 1e-6, {3, 2, 1}), {3, 2, 1}))},
                   {"far-ball", quick(at(far, glm::dvec3(0)))}});
}

/// An octahedron with a T-junction: a vertex on one side of an edge and none on the other. Such a
/// mesh is closed on paper only, so its leaks are counted, not judged.
StressFamily t_junctions() {
    Scene::Mesh mesh = fan_mesh(4);
    auto& points = mesh.positions;
    const auto middle = static_cast<std::uint32_t>(points.size());
    const auto [a, b, c] = mesh.faces[0];
    points.push_back(points[b] + 0.3 * (points[c] - points[b]));
    mesh.faces[0] = {a, b, middle};
    mesh.faces.push_back({a, middle, c});
    const Scene scene = mesh_scene(mesh, {0.125, 0.125, 0});
    const StressTolerance any{.most_wrong = std::numeric_limits<std::size_t>::max()};
    return listed({"t-junctions", "aim", "never watertight; counted, not judged"},
                  {{"edges", quick(ray_case(leaks(scene, RayAim::edges), any))},
                   {"vertices", ray_case(leaks(scene, RayAim::vertices), any)}});
}

/// Slanted, so that no coordinate is exact.
Scene::Mesh slanted(Scene::Mesh mesh) {
    const glm::dvec3 x = glm::normalize(glm::dvec3(5, 3, -2));
    const glm::dvec3 y = glm::normalize(glm::cross(x, glm::dvec3(1, -4, 2)));
    const glm::dvec3 z = glm::cross(x, y);
    for (auto& p : mesh.positions) p = p.x * x + p.y * y + p.z * z;
    return mesh;
}

StressFamily leaving_edges() {
    std::vector<LabeledCase> cases;
    const auto add = [&](const std::string& label, const Scene::Mesh& mesh, glm::dvec3 eye) {
        const Scene scene = mesh_scene(mesh, eye);
        for (const MeshSide side : {MeshSide::inside, MeshSide::outside}) {
            RayTrial trial = edge_escapes(scene, side);
            trial.rays = 1'000'000;
            cases.push_back({label + (side == MeshSide::inside ? "-inside" : "-outside"),
                             quick(ray_case(trial))});
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

StressFamilies mesh_families() {
    const auto with = [](const char* normals) {
        return picture_case(triangle_with_normals(normals));
    };
    const auto lattice = [](int cells, bool perspective, double height, unsigned seed) {
        return leak_case(lattice_scene(cells, perspective, height, seed));
    };
    const auto along = [](int axis, bool rounded) { return leak_case(box_wall(axis, rounded)); };
    const glm::dvec3 far(148376, 1234, -223423);
    return {
        listed(
            {"vertex-normals", "normals",
             "normals that cancel, oppose or lack length divide 0 by 0"},
            {{"ordinary", with("[[-0.3, 0, 1], [0.3, 0, 1], [0, 0.3, 1]]")},
             {"sum-to-zero",
              quick(with(
                  "[[1, 0, 0], [-0.5, 0.8660254037844386, 0], [-0.5, -0.8660254037844386, 0]]"))},
             {"opposing", quick(with("[[0, 0, 1], [0, 0, -1], [0, 0, 1]]"))},
             {"scaled-1e-3", with("[[-3e-4, 0, 1e-3], [3e-4, 0, 1e-3], [0, 3e-4, 1e-3]]")},
             {"scaled-1e3", with("[[-300, 0, 1e3], [300, 0, 1e3], [0, 300, 1e3]]")},
             {"scaled-1e-30-and-1e30",
              quick(with("[[-3e-31, 0, 1e-30], [3e29, 0, 1e30], [0, 0.3, 1]]"))},
             {"in-the-plane", with("[[1, 0, 0], [1, 0, 0], [1, 0, 0]]")},
             {"behind", with("[[0.1, 0, -1], [0, 0.1, -1], [0, 0, -1]]")}}),
        listed({"smooth-mesh", "mesh",
                "mirror rays about blended normals dive under the face they leave"},
               {{"ball", picture_case(smooth_ball(0))},
                {"mirror-ball", quick(picture_case(smooth_ball(0.5)))},
                {"leaning-mirror", quick(picture_case(leaning_mirror()))}}),
        listed(
            {"mesh-from-inside", "mesh", "rays slip between two triangles that share an edge"},
            {{"bumpy-ball", quick(inside_mesh(bumpy_mesh(2), {0.125, 0.0625, 0.25}, {0, 0, -1}))},
             {"fan", inside_mesh(fan_mesh(250), {0.0625, 0.125, 0.0625}, {0, 1, 0.001})},
             {"needles", quick(inside_mesh(needle_mesh(12, 4, 1e-6), {0.0625, 0.125, 0.0625},
                                           {0.25, 0.25, -1}))},
             {"tiny-ball", inside_mesh(placed(bumpy_mesh(2), 1e-6, {3, 2, 1}), {3, 2, 1},
                                       {3 + 1e-6, 2 + 2e-7, 1})},
             {"far-ball",
              inside_mesh(placed(bumpy_mesh(2), 1, far), far, far + glm::dvec3(1, 0.25, 0))}}),
        listed({"on-pixel-rays", "lattice",
                "edge functions are 0 on vertices that lie on the rays themselves"},
               {{"parallel-flat", quick(lattice(16, false, 0, 1))},
                {"parallel-bumpy", lattice(16, false, 2, 2)},
                {"perspective-flat", lattice(16, true, 0, 3)},
                {"perspective-bumpy", quick(lattice(16, true, 2, 4))},
                {"perspective-128x128", lattice(64, true, 2, 5)}}),
        // Pixel centers lie at multiples of a quarter of a square: every fourth exactly on a side.
        listed({"axis-parallel", "axis",
                "0 times infinity in the test of a box whose side the ray runs in"},
               {{"z", quick(along(2, false))},
                {"x", along(0, false)},
                {"y", along(1, false)},
                {"z-thirds", along(2, true)}})};
}

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
