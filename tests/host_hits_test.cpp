// SPDX-License-Identifier: Apache-2.0
//
// Hierarchies and caster lists change nothing: the same hits, bit for bit, as from testing every
// primitive in the author's order, and the same pictures. MIRRORBALL_TEST_RAYS sets how many rays
// each scene gets.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>

#include "host/flatten/flat_scene.h"
#include "host/parallel.h"
#include "host/render/film.h"
#include "host/render/picture_loop.h"
#include "host/render/threads_renderer.h"
#include "host/scene/json_file.h"
#include "host/stress/meshes.h"
#include "host/trace/closest_hit.h"
#include "tests/test_random.h"
#include "tests/test_shapes.h"

namespace rt {
namespace {

std::size_t ray_count() {
    const char* count = std::getenv("MIRRORBALL_TEST_RAYS");
    return count ? std::strtoul(count, nullptr, 10) : 20000;
}

void add_triangle(Scene& scene, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    if (glm::length(glm::cross(b - a, c - a)) > 0) scene.triangles.push_back({{{a, b, c}}, {}, 0});
}

void add_soup(Scene& scene, Random& random, int count, double place, double size) {
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 p = random.in_cube(place);
        const auto corner = [&] { return p + random.in_cube(size); };
        const glm::dvec3 a = corner(), b = corner();
        add_triangle(scene, a, b, corner());
    }
}

void add_mesh(Scene& scene, const StressMesh& shape, const glm::dvec3& center, double size) {
    Scene::Mesh mesh;
    for (const glm::dvec3& p : shape.vertices) mesh.positions.push_back(center + size * p);
    for (const auto& [a, b, c] : shape.faces) {
        mesh.faces.push_back({std::uint32_t(a), std::uint32_t(b), std::uint32_t(c)});
    }
    mesh.face_materials = {0};
    scene.meshes.push_back(mesh);
}

/// n x n squares of the plane z = 0 about the origin, two triangles each.
void add_floor(Scene& scene, int n, double half, double z = 0) {
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

void add_flake(Scene& scene, const glm::dvec3& center, double radius, int levels) {
    scene.spheres.push_back({center, radius, 0});
    if (levels == 0) return;
    for (int i = 0; i < 6; ++i) {
        glm::dvec3 way(0);
        way[i % 3] = i < 3 ? 1 : -1;
        add_flake(scene, center + 1.5 * radius * way, 0.5 * radius, levels - 1);
    }
}

StressMesh bumpy(Random& random, StressMesh mesh) {
    for (glm::dvec3& vertex : mesh.vertices) vertex *= random.uniform(0.8, 1.2);
    return mesh;
}

struct Subject {
    const char* name;
    std::function<void(Scene&, Random&)> fill;
};

const std::vector<Subject>& subjects() {
    static const std::vector<Subject> all{
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

Scene scene_of(const Subject& subject) {
    Random random(11);
    Scene scene;
    scene.materials.emplace_back();
    scene.camera.from = {0.25, 0.5, 2};
    subject.fill(scene, random);
    return scene;
}

/// A flat scene and, for each of its primitives, the number in the author's order and back.
template <typename T>
struct Numbered {
    using Index = typename Flat<T>::Index;

    FlatScene<T> scene;
    std::vector<Index> place;  ///< of the primitive listed under a number

    explicit Numbered(FlatScene<T> flat)
        : scene(std::move(flat)),
          place(scene.spheres.size() + scene.cones.size() + scene.triangles.size()) {
        for (std::size_t i = 0; i < place.size(); ++i)
            place[std::size_t(listed(Index(i)))] = Index(i);
    }
    Index listed(Index prim) const {
        return prim < 0 || scene.order.empty() ? prim : scene.order[std::size_t(prim)];
    }
};

/// A ray that starts or ends somewhere interesting, in the author's numbering.
template <typename T>
trace::Ray<T> some_ray(const FlatScene<T>& scene, Random& random) {
    const auto vertex = [&]() -> glm::dvec3 {
        if (scene.triangles.empty() || random.index(8) == 0) return random.in_cube(1.2);
        const auto& triangle =
            scene.triangles[std::size_t(random.index(int(scene.triangles.size())))];
        const auto p = in_double(triangle.p0), q = in_double(triangle.p1),
                   r = in_double(triangle.p2);
        const double along = random.coin() ? 0 : random.uniform(0, 1);
        return p + along * (random.coin() ? q - p : r - p);
    };
    const int kind = random.index(8);
    glm::dvec3 origin = random.index(4) == 0 ? glm::dvec3(0) : random.in_cube(1.5);
    glm::dvec3 dir = random.unit_vector();
    if (kind == 0) dir = vertex() - origin;
    if (kind == 1) origin = vertex();
    if (kind == 2) {
        origin = vertex();
        dir = vertex() - origin;
    }
    if (kind == 3 || kind == 4) {  // along one axis, or across it, often in a box's plane
        if (kind == 4) origin = vertex();
        for (int axis = 0; axis < 3; ++axis) {
            if (random.coin()) dir[axis] = random.coin() ? 0.0 : -0.0;
        }
    }
    if (!(glm::length(dir) > 1e-9)) dir = random.unit_vector();
    trace::Ray<T> ray;
    const int count = int(scene.spheres.size() + scene.cones.size() + scene.triangles.size());
    ray.from = random.index(4) == 0 ? random.index(count) : Flat<T>::none;
    if (ray.from >= 0 && ray.from < scene.frame.sphere_count) {  // a ray from a sphere starts on it
        const auto& sphere = scene.spheres[std::size_t(ray.from)];
        const glm::dvec3 normal = random.unit_vector();
        origin = in_double(sphere.center) + double(sphere.radius) * normal;
        ray.chord = static_cast<T>(-2 * double(sphere.radius) * glm::dot(normal, dir));
    }
    const auto cone_index = ray.from - scene.frame.sphere_count;
    if (cone_index >= 0 && cone_index < scene.frame.cone_count) {  // and so does one from a cone
        const auto& cone = scene.cones[std::size_t(cone_index)];
        const double height = random.uniform(0, double(cone.length));
        const glm::dvec3 axis = in_double(cone.axis);
        const glm::dvec3 across = glm::normalize(glm::cross(axis, random.unit_vector()));
        origin = in_double(cone.base) + height * axis +
                 (double(cone.base_radius) + double(cone.slope) * height) * across;
    }
    ray.origin = Vec3<T>(origin);
    ray.dir = trace::normalize3(Vec3<T>(glm::normalize(dir)));
    ray.t_max = static_cast<T>(random.uniform(0.1, 4));
    return ray;
}

template <typename T>
bool same(T a, T b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

template <typename T>
class Hits : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Hits, Precisions);

TYPED_TEST(Hits, AreThoseOfTestingEveryPrimitive) {
    using T = TypeParam;
    for (const Subject& subject : subjects()) {
        SCOPED_TRACE(subject.name);
        const Scene scene = scene_of(subject);
        FlattenOptions all;
        all.hierarchies = false;
        const Numbered<T> plain(flatten<T>(scene, all)), bvh(flatten<T>(scene));
        ASSERT_TRUE(plain.scene.nodes.empty());
        ASSERT_FALSE(bvh.scene.nodes.empty());
        const auto plain_view = trace::view_of(plain.scene), bvh_view = trace::view_of(bvh.scene);
        std::atomic<std::size_t> differ = 0, hits = 0, ties = 0;
        constexpr std::size_t run = 1000;
        for_each_run(ray_count(), run, available_cores(), [&](std::size_t first, std::size_t last) {
            Random random(first + 1);
            for (std::size_t i = first; i < last; ++i) {
                trace::Ray<T> ray = some_ray(plain.scene, random);
                trace::Ray<T> twin = ray;
                if (ray.from >= 0) twin.from = bvh.place[std::size_t(ray.from)];
                const auto a = trace::closest_hit(plain_view, ray);
                const auto b = trace::closest_hit(bvh_view, twin);
                hits += a.prim != Flat<T>::none ? 1 : 0;
                ties += a.tied != 0 ? 1 : 0;
                if (a.prim != bvh.listed(b.prim) || !same(a.t, b.t) || !same(a.u, b.u) ||
                    !same(a.v, b.v) || a.tied != b.tied) {
                    ++differ;
                }
                if (random.coin() && a.prim != Flat<T>::none) {
                    ray.t_max = random.coin() ? a.t : std::nextafter(a.t, T(0));
                    twin.t_max = ray.t_max;
                }
                if (trace::any_hit(plain_view, ray) != trace::any_hit(bvh_view, twin)) ++differ;
            }
        });
        EXPECT_EQ(differ, 0u) << ties << " ties";
        EXPECT_GT(hits, ray_count() / 100);
        this->RecordProperty(std::string(subject.name) + " ties", int(ties));
    }
}

/// Rounding in the frame of a ray grows with its origin's distance from the eye.
TYPED_TEST(Hits, AreThoseOfTestingEveryPrimitiveFromFarAway) {
    using T = TypeParam;
    Scene scene;
    scene.materials.emplace_back();
    add_floor(scene, 8, 1);
    FlattenOptions all;
    all.hierarchies = false;
    const Numbered<T> plain(flatten<T>(scene, all)), bvh(flatten<T>(scene));
    const auto plain_view = trace::view_of(plain.scene), bvh_view = trace::view_of(bvh.scene);
    Random random(21);
    std::size_t differ = 0, hits = 0;
    for (std::size_t i = 0; i < ray_count(); ++i) {
        const auto& triangles = plain.scene.triangles;
        const auto& triangle = triangles[std::size_t(random.index(int(triangles.size())))];
        const glm::dvec3 way = random.unit_vector();
        trace::Ray<T> ray{};
        ray.origin = Vec3<T>(in_double(triangle.p0) - 1000.0 * way);
        ray.dir = trace::normalize3(Vec3<T>(in_double(triangle.p0)) - ray.origin);
        ray.from = Flat<T>::none;
        const auto a = trace::closest_hit(plain_view, ray), b = trace::closest_hit(bvh_view, ray);
        differ += a.prim != bvh.listed(b.prim) || !same(a.t, b.t) || a.tied != b.tied ? 1 : 0;
        ray.t_max = a.prim == Flat<T>::none ? T(2000) : a.t;
        differ += trace::any_hit(plain_view, ray) != trace::any_hit(bvh_view, ray) ? 1 : 0;
        hits += a.prim != Flat<T>::none ? 1 : 0;
    }
    EXPECT_EQ(differ, 0u);
    EXPECT_GT(hits, ray_count() / 4);
}

/// 0 times infinity, on one axis after the other.
TYPED_TEST(Hits, AreFoundAlongTheSideOfABox) {
    using T = TypeParam;
    for (int axis = 0; axis < 3; ++axis) {
        trace::Ray<T> ray{};
        ray.dir = Vec3<T>(T(0.5));
        ray.dir[axis] = 0;
        for (const T side : {T(0), T(1)}) {
            trace::BoxRay<T> box_ray = trace::make_box_ray(ray);
            box_ray.low_origin[axis] = box_ray.high_origin[axis] = side;
            const typename Flat<T>::BvhNode unit{{0, 0, 0}, 0, {1, 1, 1}, 1};
            EXPECT_EQ(trace::enter_box(box_ray, unit), T(0)) << axis;
        }
    }
}

template <typename T>
std::uint64_t picture_hash(const Scene& scene, const FlattenOptions& options) {
    static const StopFlag never_stop = 0;
    const FlatScene<T> flat = flatten<T>(scene, options);
    const auto renderer = make_threads_renderer(flat, {});
    const Rect region{0, 0, scene.width, scene.height};
    const Rect tile = renderer->tile_size(scene.width);
    TileQueue queue(make_tiles(region, tile.width, tile.height), never_stop);
    Film<T> film(scene.width, scene.height);
    render_all(*renderer, scene.aa, queue, region, film);
    return hash_of(film);
}

std::vector<std::filesystem::path> scene_files() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(MIRRORBALL_SCENES_DIR)) {
        const std::string name = entry.path().filename().string();
        if (name.ends_with(".json") && !name.ends_with(".schema.json")) files.push_back(entry);
    }
    return files;
}

TYPED_TEST(Hits, GiveThePicturesOfEveryTriangleCasting) {
    for (const auto& file : scene_files()) {
        SCOPED_TRACE(file.filename());
        const Scene scene = load_json_scene(file.string());
        FlattenOptions everything;
        everything.caster_lists = false;
        EXPECT_EQ(picture_hash<TypeParam>(scene, {}), picture_hash<TypeParam>(scene, everything));
    }
}

/// The triangles that may cast a shadow, by light.
std::vector<std::vector<int>> casters(const Scene& scene) {
    const FlatScene<float> flat = flatten<float>(scene);
    std::vector<std::vector<int>> lists;
    for (const auto& light : flat.lights) {
        lists.emplace_back();
        for (int k = 0; k < light.caster_count; ++k) {
            const bool all = light.caster_count == flat.frame.triangle_count;
            lists.back().push_back(all ? k : flat.casters[std::size_t(light.first_caster + k)]);
        }
    }
    return lists;
}

TEST(ShadowCasters, AreThePyramidAloneInThePapersScene) {
    const auto lists =
        casters(load_json_scene(std::string(MIRRORBALL_SCENES_DIR) + "/cornell-box.json"));
    ASSERT_EQ(lists.size(), 2u);
    for (const auto& list : lists) EXPECT_EQ(list.size(), 3u);
}

/// A floor at z = 0 seen and lit from above, and what `more` puts there.
Scene floor_scene(const std::vector<Scene::Triangle>& more) {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].diffuse = {1, 1, 1};
    scene.camera.from = {0, -3, 2};
    scene.lights.push_back({{1, 1, 3}, {1, 1, 1}});
    add_floor(scene, 1, 1);
    scene.triangles.insert(scene.triangles.end(), more.begin(), more.end());
    return scene;
}

// Listing takes time in the number of triangles squared.
TEST(ShadowCasters, AreNotListedAmongManyTrianglesWithoutAHierarchyEither) {
    Scene scene = floor_scene({});
    FlattenOptions options;
    options.hierarchies = false;
    EXPECT_NE(flatten<float>(scene, options).lights[0].caster_count, 2);
    for (int i = 0; i < 100; ++i) add_floor(scene, 1, 1);
    const FlatScene<float> flat = flatten<float>(scene, options);
    EXPECT_EQ(flat.lights[0].caster_count, flat.frame.triangle_count);
    EXPECT_TRUE(flat.casters.empty());
}

TEST(ShadowCasters, LeaveOutAFloorUnlessInDoubt) {
    using Lists = std::vector<std::vector<int>>;
    EXPECT_EQ(casters(floor_scene({})), Lists{{}});
    const Scene::Triangle above{{{{0, 0, 1}, {0.5, 0, 1}, {0, 0.5, 1}}}, {}, 0};
    EXPECT_EQ(casters(floor_scene({above})), Lists{{2}});
    const Scene::Triangle below{{{{0, 0, -1}, {0.5, 0, -1}, {0, 0.5, -1}}}, {}, 0};
    EXPECT_EQ(casters(floor_scene({below})), (Lists{{0, 1}}));
    const Scene::Triangle leaning{{{{-1, 1, 0}, {1, 1, 0}, {0, 0, 1}}}, {}, 0};  // over the floor
    EXPECT_EQ(casters(floor_scene({leaning})), (Lists{{2}}));
    Scene scene = floor_scene({leaning});
    scene.lights[0].position = {0, 0, 0.25};  // beneath it: first steps lead through
    EXPECT_EQ(casters(scene), (Lists{{0, 1, 2}}));
    scene = floor_scene({});
    scene.lights[0].position = {0, 0, 0.001};
    EXPECT_EQ(casters(scene), (Lists{{0, 1}}));
    scene = floor_scene({});
    scene.camera.from.z = -2;
    EXPECT_EQ(casters(scene), (Lists{{0, 1}}));
    scene = floor_scene({});
    scene.spheres.push_back({{0, 0, 0.5}, 0.5, 0});
    EXPECT_EQ(casters(scene), Lists{{}});
    scene.spheres[0].radius = 0.6;
    EXPECT_EQ(casters(scene), (Lists{{0, 1}}));
}

}  // namespace
}  // namespace rt
