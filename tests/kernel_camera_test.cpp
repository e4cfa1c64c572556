// SPDX-License-Identifier: Apache-2.0
//
// kernels/camera.cl against the closed form in 113 bits and against its symmetries.
#include "tests/exact.h"
#include "tests/kernel_runner.h"
#include "tests/probe_types.h"
#include "tests/test_random.h"
#include "tests/test_shapes.h"

namespace rt::this_file {

namespace {

template <typename T>
using LaunchParams = typename Flat<T>::LaunchParams;

/// A camera of any orientation; a pixel spans about 1e-2 of the view.
template <typename T>
LaunchParams<T> any_params(Random& random, bool orthographic, int grid) {
    const glm::dvec3 forward = random.unit_vector();
    const glm::dvec3 right = glm::normalize(glm::cross(forward, random.unit_vector()));
    const glm::dvec3 up = glm::cross(right, forward);
    LaunchParams<T> params{};
    params.width = 200;
    params.height = 130;
    params.grid = grid;
    params.direction = pack<T>(forward);
    const auto some_rounding = [&](double size) {
        return pack<T>(0.3 * Flat<T>::roundoff * size * random.unit_vector());
    };
    params.direction_low = some_rounding(1);
    if (!orthographic) params.direction_dx_low = some_rounding(3e-3);
    if (!orthographic) params.direction_dy_low = some_rounding(4e-3);
    (orthographic ? params.origin_dx : params.direction_dx) = pack<T>(3e-3 * right);
    (orthographic ? params.origin_dy : params.direction_dy) = pack<T>(4e-3 * up);
    return params;
}

/// Every sample of every pixel.
template <typename T>
struct Samples {
    std::vector<typename Flat<T>::Index> x, y, k;

    explicit Samples(const LaunchParams<T>& params) {
        for (int j = 0; j < params.height; ++j) {
            for (int i = 0; i < params.width; ++i) {
                for (int s = 0; s < params.grid * params.grid; ++s) {
                    x.push_back(i);
                    y.push_back(j);
                    k.push_back(s);
                }
            }
        }
    }
    std::vector<ProbeRay<T>> device(const LaunchParams<T>& params) const {
        return run<T, ProbeRay<T>>("camera_ray", x.size(), std::vector{params}, x, y, k);
    }
    /// 2 (position) - size, with the position of sample k as the kernel's header defines it.
    Quad sx(std::size_t i, const LaunchParams<T>& f) const {
        return 2 * (Quad(x[i]) + (Quad(k[i] % f.grid) + 0.5) / f.grid) - f.width;
    }
    Quad sy(std::size_t i, const LaunchParams<T>& f) const {
        return 2 * (Quad(y[i]) + (Quad(k[i] / f.grid) + 0.5) / f.grid) - f.height;
    }
};

template <typename T>
void expect_closed_form(bool orthographic, int grid) {
    Random random(static_cast<std::uint64_t>(grid));
    const LaunchParams<T> f = any_params<T>(random, orthographic, grid);
    const Samples<T> samples(f);
    const auto rays = samples.device(f);
    WorstError dir, low, origin;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Quad sx = samples.sx(i, f), sy = samples.sy(i, f);
        const Quad3 through = exact(f.direction) + sx * exact(f.direction_dx) +
                              sy * exact(f.direction_dy) + exact(f.direction_low) +
                              sx * exact(f.direction_dx_low) + sy * exact(f.direction_dy_low);
        dir.add(vector_error<T>(rays[i].dir, unit(through), 1));
        const Quad3 both = exact(rays[i].dir) + exact(rays[i].dir_low);
        const Quad u = Flat<T>::roundoff;
        low.add(double(length(unit(both) - unit(through)) / (u * u)));
        origin.add(
            vector_error<T>(rays[i].origin, sx * exact(f.origin_dx) + sy * exact(f.origin_dy), 1));
        ASSERT_TRUE(std::isinf(rays[i].t_max) && rays[i].from == Flat<T>::none);
    }
    dir.expect_at_most(4, "direction");
    if (grid < 3) {  // thirds are rounded themselves
        low.expect_at_most(3.4, "direction with its low part, in roundoffs squared");
    }
    origin.expect_at_most(orthographic ? 2 : 0, "origin");
}

KERNEL_SUITE(CameraRay);
TYPED_TEST(CameraRay, PerspectiveFansOutFromTheEye) {
    for (const int grid : {1, 2, 3}) expect_closed_form<TypeParam>(false, grid);
}
TYPED_TEST(CameraRay, OrthographicRaysAreParallel) {
    for (const int grid : {1, 2, 3}) expect_closed_form<TypeParam>(true, grid);
}
TYPED_TEST(CameraRay, OnASquarePicturesDiagonalHasEqualComponents) {
    LaunchParams<TypeParam> params{};
    params.width = params.height = 101;
    params.direction = {0, 0, -1};
    params.direction_dx = {TypeParam(0.00517), 0, 0};
    params.direction_dy = {0, TypeParam(0.00517), 0};
    for (const int grid : {1, 2, 3, 4}) {
        params.grid = grid;
        const Samples<TypeParam> samples(params);
        const auto rays = samples.device(params);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (samples.x[i] != samples.y[i]) continue;
            if (samples.k[i] % grid != samples.k[i] / grid) continue;
            ASSERT_EQ(rays[i].dir.x, rays[i].dir.y) << samples.x[i];
        }
    }
}
TYPED_TEST(CameraRay, OppositePixelsMirrorEachOther) {
    LaunchParams<TypeParam> params{};
    params.width = 64;
    params.height = 37;
    params.grid = 1;
    params.direction = {0, 0, -1};
    params.direction_dx = {TypeParam(0.013), 0, 0};
    params.direction_dy = {0, TypeParam(0.017), 0};
    const auto rays = Samples<TypeParam>(params).device(params);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto &a = rays[i].dir, &b = rays[rays.size() - 1 - i].dir;
        ASSERT_TRUE(a.x == -b.x && a.y == -b.y && a.z == b.z) << i;
    }
}

}  // namespace

}  // namespace rt::this_file
