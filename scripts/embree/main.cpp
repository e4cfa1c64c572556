// SPDX-License-Identifier: Apache-2.0
//
// Times Embree on a mirrorball scene, with the same rays, samples and shading, but Embree's
// tracing. Prints JSON. Started by scripts/compare-embree.
//
// usage: embree-bench SCENE WIDTHxHEIGHT AA THREADS ROUNDS|once medium|high [PICTURE.pfm]
//
// medium, high: the quality with which Embree builds its hierarchy; medium is its default.
// once: traces one picture with coherent packets, cold, as a renderer does; prints the seconds of
// each phase.
#include <embree3/rtcore.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "host/scene/aa_mode.h"
#include "host/scene/scene_file.h"
#include "scripts/embree/kernel_flops.h"
#include "scripts/embree/lanes.h"
#include "scripts/embree/tracer.h"

namespace embree_bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::pair<Mode, const char*>, 4> modes{{{Mode::coherent, "coherent16"},
                                                             {Mode::incoherent, "incoherent16"},
                                                             {Mode::mixed, "mixed16"},
                                                             {Mode::single, "single"}}};

constexpr int sums_at_once = 16;  ///< enough to hide a multiply-add's latency

template <std::size_t... i>
float multiply_adds(std::int64_t rounds, std::index_sequence<i...>) {
    Reals sums[] = {reals(static_cast<float>(i))...};
    const Reals factor = reals(0.999f), addend = reals(0.001f);
    for (std::int64_t round = 0; round < rounds; ++round) {
        ((sums[i] = sums[i] * factor + addend), ...);
    }
    const Reals total = (sums[i] + ...);
    return total[0];
}

/// The floating-point operations a second of that many threads that do nothing but multiply-adds.
double peak_flops(int threads) {
    constexpr std::int64_t rounds = 20'000'000;
    std::vector<float> results(static_cast<std::size_t>(threads));
    std::vector<std::thread> pool;
    const auto start = std::chrono::steady_clock::now();
    for (float& result : results) {
        pool.emplace_back([&result] {
            result = multiply_adds(rounds, std::make_index_sequence<sums_at_once>());
        });
    }
    for (std::thread& thread : pool) thread.join();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    return 2.0 * lanes * sums_at_once * static_cast<double>(rounds) * threads / taken.count();
}

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

void check(const rt::FlatScene<float>& flat) {
    if (flat.params.grid == 0) throw std::runtime_error("only none and grid:N are traced here");
    if (!flat.cones.empty() || !flat.vertex_normals.empty()) {
        throw std::runtime_error("scenes with cones or vertex normals are not traced here");
    }
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// One picture, as a renderer's whole process makes it.
int run_once(const std::vector<std::string>& arguments, int threads, RTCBuildQuality quality) {
    const auto start = std::chrono::steady_clock::now();
    const rt::Scene scene = scene_of(arguments[0], arguments[1], arguments[2]);
    const double loaded = seconds_since(start);
    rt::FlattenOptions options;
    options.hierarchies = false;
    options.caster_lists = scene.triangles.size() < rt::triangle_crossover;
    const rt::FlatScene<float> flat = rt::flatten<float>(scene, options);
    check(flat);
    const EmbreeScene embree(flat, threads, quality);
    const double built = seconds_since(start);
    const TracedPicture picture = trace(flat, embree, Mode::coherent, threads);
    const double traced = seconds_since(start);
    if (arguments.size() == 7) write_pfm(arguments[6], flat, picture.rgb);
    const Json json{{"load", loaded},
                    {"flatten", built - loaded},
                    {"hierarchy", embree.build_seconds()},
                    {"trace", traced - built},
                    {"write", seconds_since(start) - traced}};
    std::printf("%s\n", json.dump().c_str());
    return 0;
}

/// Scenes that mirrorball tests one primitive after the other: their work can be counted.
bool is_countable(const rt::FlatScene<float>& flat) {
    return flat.spheres.size() < rt::sphere_crossover &&
           flat.triangles.size() < rt::triangle_crossover;
}

int run(const std::vector<std::string>& arguments) {
    if (arguments.size() < 6 || arguments.size() > 7) {
        throw std::runtime_error(
            "usage: embree-bench SCENE WxH AA THREADS ROUNDS|once medium|high [PICTURE.pfm]");
    }
    const int threads = std::stoi(arguments[3]);
    const RTCBuildQuality quality =
        arguments[5] == "high" ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
    if (arguments[4] == "once") return run_once(arguments, threads, quality);
    const int rounds = std::stoi(arguments[4]);
    rt::FlattenOptions options;
    options.hierarchies = false;
    const rt::Scene scene = scene_of(arguments[0], arguments[1], arguments[2]);
    options.caster_lists = scene.triangles.size() < rt::triangle_crossover;
    const rt::FlatScene<float> flat = rt::flatten<float>(scene, options);
    check(flat);
    const EmbreeScene embree(flat, threads, quality);
    trace(flat, embree, Mode::coherent, threads);  // warms up
    std::map<std::string, std::vector<double>> seconds;
    TracedPicture picture;
    for (int round = 0; round < rounds; ++round) {
        for (const auto& [mode, name] : modes) {
            picture = trace(flat, embree, mode, threads);
            seconds[name].push_back(picture.seconds);
        }
    }
    if (rounds == 0) picture = trace(flat, embree, Mode::coherent, threads);
    if (arguments.size() == 7) write_pfm(arguments[6], flat, picture.rgb);
    Json json{{"format", "mirrorball-embree"},
              {"version", 1},
              {"embree", RTC_VERSION_STRING},
              {"scene", arguments[0]},
              {"size", arguments[1]},
              {"aa", arguments[2]},
              {"threads", threads},
              {"build_seconds", embree.build_seconds()},
              {"rays",
               {{"primary", picture.rays.primary},
                {"shadow", picture.rays.shadow},
                {"mirror", picture.rays.mirror},
                {"total", picture.rays.total()}}},
              {"seconds", seconds}};
    if (rounds > 0) {
        json["peak_flops"] = peak_flops(threads);
    } else {
        json["flops"] = is_countable(flat) ? Json(kernel_flops(flat, threads)) : Json(nullptr);
    }
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
