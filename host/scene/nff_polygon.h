// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "host/scene/mistakes.h"
#include "host/scene/nff_fill.h"
#include "host/scene/nff_tokens.h"
#include "host/scene/polygon.h"
#include "host/scene/scene.h"

namespace rt {

/// Reads the polygons of an NFF file as triangles.
class NffPolygons {
   public:
    explicit NffPolygons(Mistakes& mistakes) : mistakes_(mistakes) {}

    /// Reads the arguments of a p, or a pp (`is_patch`), at `offset`, and appends its triangles.
    /// Returns false when the rest of it cannot be parsed. Throws Error (ExitCode::limit) when the
    /// file's polygons take too long to triangulate.
    bool read(NffTokens& tokens, std::size_t offset, bool is_patch, NffFills& fills,
              std::vector<Scene::Triangle>& triangles);

   private:
    std::optional<int> read_count(NffTokens& tokens, std::size_t vertex_bytes);
    bool read_normal(NffTokens& tokens);
    void note_fault(std::size_t offset, PolygonFault fault);

    Mistakes& mistakes_;
    std::vector<glm::dvec3> corners_, normals_;  ///< of the polygon at hand
    std::vector<std::array<std::uint32_t, 3>> faces_;
    std::int64_t work_ = max_polygon_work;
};

}  // namespace rt
