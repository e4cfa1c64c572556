// SPDX-License-Identifier: Apache-2.0
#include "scripts/embree/embree_scene.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace embree_bench {

namespace {

void fail(void*, RTCError, const char* text) {
    std::fprintf(stderr, "Embree: %s\n", text);
    std::exit(1);
}

}  // namespace

EmbreeScene::EmbreeScene(const rt::FlatScene<float>& flat, int threads, RTCBuildQuality quality)
    : quality_(quality), device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())) {
    if (device_ == nullptr) fail(nullptr, rtcGetDeviceError(nullptr), "no device");
    rtcSetDeviceErrorFunction(device_, fail, nullptr);
    for (const auto& sphere : flat.spheres) materials_.push_back(sphere.material);
    for (const auto& triangle : flat.triangles) materials_.push_back(triangle.material);
    for (std::uint32_t i = 0; i < flat.triangles.size(); ++i) {
        for (std::uint32_t corner = 0; corner < 3; ++corner) corners_.push_back(4 * i + corner);
    }
    const auto start = std::chrono::steady_clock::now();
    scene_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene_, quality_);
    if (!flat.spheres.empty()) attach_spheres(flat);
    if (!flat.triangles.empty()) attach_triangles(flat);
    rtcCommitScene(scene_);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    build_seconds_ = taken.count();
}

EmbreeScene::~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

void EmbreeScene::attach_spheres(const rt::FlatScene<float>& flat) {
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                               flat.spheres.data(), 0, sizeof(flat.spheres[0]),
                               flat.spheres.size());
    attach(geometry, spheres);
}

void EmbreeScene::attach_triangles(const rt::FlatScene<float>& flat) {
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               flat.triangles.data(), 0, sizeof(flat.triangles[0]) / 4,
                               4 * flat.triangles.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               corners_.data(), 0, 3 * sizeof(corners_[0]), flat.triangles.size());
    attach(geometry, triangles);
}

void EmbreeScene::attach(RTCGeometry geometry, std::int32_t id) {
    rtcSetGeometryBuildQuality(geometry, quality_);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene_, geometry, static_cast<unsigned>(id));
    rtcReleaseGeometry(geometry);
}

}  // namespace embree_bench
