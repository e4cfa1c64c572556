// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: whatever the bytes, the NFF reader returns a scene or throws rt::Error, and a
// scene can be flattened and rendered on a thread.
// Build with clang++ -fsanitize=fuzzer,address,undefined; seeds: tests/scenes_nff/.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "host/scene/scene_file.h"
#include "tests/fuzz_model.h"

namespace {

using rt::fuzz::finite;
using rt::fuzz::require;

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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    bool is_read = false;
    try {
        const rt::Scene scene = rt::parse_nff_scene(text, "fuzz.nff");
        is_read = true;
        check_scene(scene);
        rt::fuzz::render(scene);
    } catch (const rt::Error& error) {
        require(error.exit_code() == rt::ExitCode::input ||
                error.exit_code() == rt::ExitCode::limit);
        require(is_read || std::string_view(error.what()).starts_with("fuzz.nff:"));
    }
    return 0;
}
