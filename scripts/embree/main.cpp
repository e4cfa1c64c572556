// SPDX-License-Identifier: Apache-2.0
//
// Times Embree on a mirrorball scene, with the same rays, samples and shading, but Embree's
// tracing. Prints JSON. Started by scripts/compare-embree and scripts/compare-whole.
//
// usage: embree-bench SCENE WIDTHxHEIGHT AA THREADS ROUNDS medium|high [PICTURE.pfm]
//
// Traces and writes one picture with coherent packets, cold, as a renderer does, and prints the
// seconds of each phase; then ROUNDS more in each mode. medium, high: the quality with which Embree
// builds its hierarchy; medium is its default.
#include <embree3/rtcore.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "host/scene/aa_mode.h"
#include "host/scene/scene_file.h"
#include "scripts/embree/tracer.h"

namespace embree_bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::pair<MirrorRays, const char*>, 2> modes{
    {{MirrorRays::coherent, "coherent"}, {MirrorRays::incoherent, "mirror_rays_incoherent"}}};

void write_pfm(const std::string& path, const rt::FlatScene<float>& flat,
               const std::vector<float>& rgb) {
    std::ofstream file(path, std::ios::binary);
    file << "PF\n" << flat.params.width << ' ' << flat.params.height << "\n-1.0\n";
    const std::size_t row = 3 * static_cast<std::size_t>(flat.params.width);
    for (std::size_t y = rgb.size() / row; y-- > 0;) {
        file.write(reinterpret_cast<const char*>(&rgb[y * row]),
                   static_cast<std::streamsize>(row * sizeof(float)));
    }
    if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

rt::Scene scene_of(const std::string& path, const std::string& size, const std::string& aa) {
    rt::Scene scene = rt::load_scene(path);
    int width = 0, height = 0;
    if (std::sscanf(size.c_str(), "%dx%d", &width, &height) != 2) {
        throw std::runtime_error("size: give WIDTHxHEIGHT");
    }
    rt::set_image_size(scene, width, height);
    const auto mode = rt::parse_aa_mode(aa);
    if (!mode) throw std::runtime_error("AA mode: give none or grid:N");
    scene.aa = *mode;
    return scene;
}

rt::FlatScene<float> flat_scene(const rt::Scene& scene) {
    rt::FlattenOptions options;
    options.hierarchies = false;
    options.caster_lists = scene.triangles.size() < rt::bvh_crossover;
    rt::FlatScene<float> flat = rt::flatten<float>(scene, options);
    if (flat.params.grid == 0) throw std::runtime_error("only none and grid:N are traced here");
    if (!flat.cones.empty() || !flat.vertex_normals.empty()) {
        throw std::runtime_error("scenes with cones or vertex normals are not traced here");
    }
    return flat;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The seconds of so many pictures in each mode.
std::map<std::string, std::vector<double>> timed(const rt::FlatScene<float>& flat,
                                                 const EmbreeScene& embree, int threads,
                                                 int rounds) {
    std::map<std::string, std::vector<double>> seconds;
    for (int round = 0; round < rounds; ++round) {
        for (const auto& [mode, name] : modes) {
            seconds[name].push_back(trace(flat, embree, mode, threads).seconds);
        }
    }
    return seconds;
}

int run(const std::vector<std::string>& arguments) {
    if (arguments.size() < 6 || arguments.size() > 7) {
        throw std::runtime_error(
            "usage: embree-bench SCENE WxH AA THREADS ROUNDS medium|high [PICTURE.pfm]");
    }
    const int threads = std::stoi(arguments[3]);
    const RTCBuildQuality quality =
        arguments[5] == "high" ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
    const auto start = std::chrono::steady_clock::now();
    const rt::Scene scene = scene_of(arguments[0], arguments[1], arguments[2]);
    const double loaded = seconds_since(start);
    const rt::FlatScene<float> flat = flat_scene(scene);
    const EmbreeScene embree(flat, threads, quality);
    const double built = seconds_since(start);
    const TracedPicture picture = trace(flat, embree, MirrorRays::coherent, threads);
    const double traced = seconds_since(start);
    if (arguments.size() == 7) write_pfm(arguments[6], flat, picture.rgb);
    const double written = seconds_since(start);
    const Json json{{"embree", RTC_VERSION_STRING},
                    {"load", loaded},
                    {"flatten", built - loaded},
                    {"hierarchy", embree.build_seconds()},
                    {"trace", traced - built},
                    {"write", written - traced},
                    {"rays", picture.rays.total()},
                    {"rounds", timed(flat, embree, threads, std::stoi(arguments[4]))}};
    std::printf("%s\n", json.dump().c_str());
    return 0;
}

}  // namespace
}  // namespace embree_bench

int main(int argc, char** argv) {
    try {
        return embree_bench::run({argv + 1, argv + argc});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "embree-bench: %s\n", error.what());
        return 1;
    }
}
