// SPDX-License-Identifier: Apache-2.0
//
// The kernels compiled as C++, one lane wide, on numbers that count what is done to them.
#include "scripts/embree/kernel_flops.h"

#include <atomic>
#include <bit>
#include <cfloat>
#include <climits>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <thread>
#include <vector>

#include "host/render/picture_loop.h"
#include "host/render/threads_renderer.h"

#pragma GCC optimize("fp-contract=off")  // strict arithmetic, whatever the others are built with

namespace embree_bench {

namespace {

thread_local std::int64_t flops = 0;

/// A float whose operations are counted.
struct Counted {
    float value;

    Counted() = default;
    Counted(float v) : value(v) {}

    friend Counted operator-(Counted a) { return {-a.value}; }
    friend Counted operator+(Counted a, Counted b) { return counted(1, a.value + b.value); }
    friend Counted operator-(Counted a, Counted b) { return counted(1, a.value - b.value); }
    friend Counted operator*(Counted a, Counted b) { return counted(1, a.value * b.value); }
    friend Counted operator/(Counted a, Counted b) { return counted(1, a.value / b.value); }
    friend Counted fma(Counted a, Counted b, Counted c) {
        return counted(2, std::fma(a.value, b.value, c.value));
    }
    friend Counted sqrt(Counted a) { return counted(1, std::sqrt(a.value)); }
    friend Counted fabs(Counted a) { return {std::fabs(a.value)}; }
    Counted& operator+=(Counted b) { return *this = *this + b; }

    friend bool operator<(Counted a, Counted b) { return a.value < b.value; }
    friend bool operator>(Counted a, Counted b) { return a.value > b.value; }
    friend bool operator<=(Counted a, Counted b) { return a.value <= b.value; }
    friend bool operator>=(Counted a, Counted b) { return a.value >= b.value; }
    friend bool operator==(Counted a, Counted b) { return a.value == b.value; }
    friend bool operator!=(Counted a, Counted b) { return a.value != b.value; }

   private:
    static Counted counted(int operations, float result) {
        flops += operations;
        return {result};
    }
};

thread_local std::size_t work_item = 0;
rt::Features features;  ///< the scene's, in place of the kernels' switches

// What OpenCL C has and C++ has not.
#define __global
#define __kernel
#define restrict __restrict__
#define RT_REALS Counted
#define RT_HAS_SPHERES features.spheres
#define RT_HAS_HUGE_SPHERES features.huge_spheres
#define RT_HAS_EYE_ON_SURFACE features.eye_on_surface
#define RT_HAS_CONES features.cones
#define RT_HAS_TRIANGLES features.triangles
#define RT_HAS_VERTEX_NORMALS features.vertex_normals
#define RT_HAS_HIERARCHY features.hierarchy
#define RT_HAS_LIGHTS features.lights
#define RT_HAS_MIRRORS features.mirrors
#define RT_HAS_GLASS features.glass
#define RT_HAS_SOBOL features.sobol
#define RT_HAS_FILTERS features.filters
#define RT_RENDERS_SAMPLES 0
#define RT_RENDERS_LIST 0

namespace kernels {

using uint = std::uint32_t;
using ulong = std::uint64_t;

std::size_t get_global_id(uint) { return work_item; }
float fabs(float x) { return std::fabs(x); }
int as_int(Counted x) { return std::bit_cast<int>(x.value); }
float as_float(int bits) { return std::bit_cast<float>(bits); }
float convert_float(int v) { return static_cast<float>(v); }
float convert_float(uint v) { return static_cast<float>(v); }
int convert_int(Counted v) { return static_cast<int>(v.value); }
uint convert_uint(int v) { return static_cast<uint>(v); }

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wenum-compare"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include "kernels/render.cl"
#pragma GCC diagnostic pop

}  // namespace kernels

/// A buffer of the flat scene as the kernels see it.
template <typename Theirs, typename Ours, typename Allocator>
const Theirs* buffer(const std::vector<Ours, Allocator>& values) {
    static_assert(sizeof(Theirs) == sizeof(Ours));
    return reinterpret_cast<const Theirs*>(values.data());
}

/// The picture, and what its rays took.
struct CountedPicture {
    std::vector<float> rgb;
    std::int64_t flops = 0;
};

CountedPicture render(const rt::FlatScene<float>& flat, int threads) {
    features = flat.features;
    const std::size_t pixels =
        static_cast<std::size_t>(flat.params.width) * static_cast<std::size_t>(flat.params.height);
    CountedPicture picture;
    picture.rgb.resize(3 * pixels);
    std::vector<kernels::RayCounts> rays(pixels);
    const auto params = std::bit_cast<kernels::LaunchParams>(flat.params);
    const kernels::Tile tile{0, 0, params.width, params.height, 0, params.width, {}};
    std::atomic<std::int64_t> all_flops = 0;
    const auto run = [&](std::size_t first) {
        flops = 0;
        for (work_item = first; work_item < pixels;
             work_item += static_cast<std::size_t>(threads)) {
            kernels::render_pixels(
                picture.rgb.data(), rays.data(), buffer<kernels::Sphere>(flat.spheres),
                buffer<kernels::Cone>(flat.cones), buffer<kernels::Triangle>(flat.triangles),
                buffer<kernels::VertexNormals>(flat.vertex_normals),
                buffer<kernels::Material>(flat.materials), buffer<kernels::Light>(flat.lights),
                buffer<kernels::BvhNode>(flat.nodes), flat.order.data(), flat.casters.data(),
                params, tile);
        }
        all_flops += flops;
    };
    std::vector<std::thread> pool;
    for (int i = 0; i < threads; ++i) pool.emplace_back(run, static_cast<std::size_t>(i));
    for (std::thread& thread : pool) thread.join();
    picture.flops = all_flops;
    return picture;
}

std::vector<float> rendered_by_threads(const rt::FlatScene<float>& flat, int threads) {
    const rt::StopFlag never_stop = 0;
    const rt::Rect whole{0, 0, flat.params.width, flat.params.height};
    rt::ThreadsOptions options;
    options.threads = threads;
    const auto renderer = rt::make_threads_renderer(flat, options);
    const rt::Rect tile = renderer->tile_size(whole.width);
    rt::TileQueue queue(rt::make_tiles(whole, tile.width, tile.height), never_stop);
    rt::Film<float> film(whole.width, whole.height);
    renderer->render(queue, whole, film);
    return {film.rgb.begin(), film.rgb.end()};
}

}  // namespace

std::int64_t kernel_flops(const rt::FlatScene<float>& flat, int threads) {
    const CountedPicture picture = render(flat, threads);
    if (picture.rgb != rendered_by_threads(flat, threads)) {
        throw std::runtime_error("the picture whose operations were counted is not mirrorball's");
    }
    return picture.flops;
}

}  // namespace embree_bench
