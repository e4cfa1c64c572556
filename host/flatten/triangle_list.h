// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "host/scene/scene.h"

namespace rt {

/// All triangles of a scene by number: Scene::triangles first, then the
/// faces of mesh after mesh. The scene must outlive it.
class TriangleList {
   public:
    using Corners = std::array<glm::dvec3, 3>;

    struct Place {
        const Scene::Mesh* mesh;  ///< null: one of Scene::triangles
        std::size_t index;        ///< in Scene::triangles or the mesh's faces
    };

    explicit TriangleList(const Scene& scene);

    Place place(std::size_t index) const;
    std::uint64_t size() const { return starts_.back(); }
    Corners corners(std::size_t index) const;
    int material(std::size_t index) const;
    bool is_smooth(std::size_t index) const;
    std::optional<Corners> normals(std::size_t index) const;

   private:
    const Scene& scene_;
    /// The number of each mesh's first face, and the number of all triangles.
    std::vector<std::uint64_t> starts_;
};

/// The unit normal on the side from which the corners run counterclockwise.
glm::dvec3 unit_normal(const TriangleList::Corners& corners);

}  // namespace rt
