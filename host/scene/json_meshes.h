// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/scene/affine.h"
#include "host/scene/beneath.h"
#include "host/scene/json_shapes.h"

namespace rt {

/// An item of "meshes" without the model itself, which is loaded only if the scene has no other
/// mistakes.
struct MeshRequest {
    std::string file;             ///< as written in the scene
    std::uint32_t offset = 0;     ///< of the item in the scene's text
    std::optional<int> material;  ///< for all faces, in place of the model's own
    Affine transform;
};

MeshRequest read_mesh(const JsonValue& value, const MaterialTable& materials,
                      const SceneFolder& folder, Mistakes& mistakes);

/// The 16 numbers of a matrix, row by row, or an object with scale, rotate_degrees, translate.
std::optional<Affine> read_transform(const JsonValue& value, std::string_view name,
                                     Mistakes& mistakes);

/// Loads the models and appends their materials to the scene's. Throws as load_model does.
void load_meshes(const std::vector<MeshRequest>& requests, const SceneFolder& folder, Scene& scene,
                 Mistakes& mistakes);

}  // namespace rt
