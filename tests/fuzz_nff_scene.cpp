// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: whatever the bytes, the NFF reader returns a scene or throws rt::Error, and a
// scene can be flattened and rendered on a thread.
// Build with clang++ -fsanitize=fuzzer,address,undefined; seeds: tests/scenes_nff/.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string_view>

#include "host/base/error.h"
#include "host/flatten/flat_scene.h"
#include "host/render/film.h"
#include "host/render/threads_renderer.h"
#include "host/render/tile_queue.h"
#include "host/scene/scene.h"
#include "host/scene/scene_file.h"

namespace {

constexpr std::size_t most_primitives = 200;

/// Traps on a bug in the reader, as opposed to an error in the text.
void require(bool condition) {
    if (!condition) __builtin_trap();
}

bool finite(glm::dvec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check_scene(const rt::Scene& scene) {
    const int materials = static_cast<int>(scene.materials.size());
    const auto known = [&](int material) { return material >= 0 && material < materials; };
    for (const rt::Scene::Sphere& sphere : scene.spheres) {
        require(sphere.radius > 0 && finite(sphere.center) && known(sphere.material));
    }
    for (const rt::Scene::Cone& cone : scene.cones) {
        require(cone.base_radius >= 0 && cone.apex_radius >= 0 && cone.base != cone.apex);
        require(cone.base_radius + cone.apex_radius > 0 && known(cone.material));
    }
    for (const rt::Scene::Triangle& triangle : scene.triangles) {
        for (const glm::dvec3& vertex : triangle.vertices) require(finite(vertex));
        require(known(triangle.material));
    }
    for (const rt::Scene::Material& material : scene.materials) require(material.ior > 0);
}

void render(rt::Scene scene) {
    if (scene.spheres.size() + scene.cones.size() + scene.triangles.size() > most_primitives)
        return;
    constexpr int side = 8;
    rt::set_image_size(scene, side, side);
    scene.aa = rt::grid_aa(1);
    const rt::FlatScene<float> flat = rt::flatten<float>(scene);
    const auto renderer = rt::make_threads_renderer(flat, {1, rt::Schedule::tiles});
    const rt::Rect whole{0, 0, side, side};
    rt::Film<float> film(side, side);
    const rt::StopFlag stop = 0;
    rt::TileQueue queue(rt::make_tiles(whole, side, side), stop);
    renderer->render(queue, whole, film);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    bool is_read = false;
    try {
        const rt::Scene scene = rt::parse_nff_scene(text, "fuzz.nff");
        is_read = true;
        check_scene(scene);
        render(scene);
    } catch (const rt::Error& error) {
        require(error.exit_code() == rt::ExitCode::input ||
                error.exit_code() == rt::ExitCode::limit);
        require(is_read || std::string_view(error.what()).starts_with("fuzz.nff:"));
    }
    return 0;
}
