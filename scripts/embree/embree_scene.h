// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <embree3/rtcore.h>

#include <vector>

#include "host/flatten/flat_scene.h"

namespace embree_bench {

/// A flat scene in Embree's hands. Triangles and spheres are read where they lie, in shared
/// buffers: a vertex every 16 bytes, four a triangle, of which the last is its normal.
class EmbreeScene {
   public:
    static constexpr std::int32_t spheres = 0, triangles = 1;  ///< geometries

    EmbreeScene(const rt::FlatScene<float>& flat, int threads, RTCBuildQuality quality);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    RTCScene handle() const { return scene_; }
    double build_seconds() const { return build_seconds_; }

    /// Materials of all spheres, then of all triangles.
    const std::vector<std::int32_t>& materials() const { return materials_; }

   private:
    void attach_spheres(const rt::FlatScene<float>& flat);
    void attach_triangles(const rt::FlatScene<float>& flat);
    void attach(RTCGeometry geometry, std::int32_t id);

    RTCBuildQuality quality_;
    RTCDevice device_;
    RTCScene scene_;
    std::vector<std::uint32_t> corners_;
    std::vector<std::int32_t> materials_;
    double build_seconds_ = 0;
};

}  // namespace embree_bench
