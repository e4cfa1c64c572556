// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "host/scene/json_document.h"
#include "host/scene/mistakes.h"
#include "host/scene/scene.h"

namespace rt {

/// The materials of a scene file, looked up by name.
class MaterialTable {
   public:
    /// Reads the "materials" object (null: the file has none).
    MaterialTable(const JsonValue* value, Mistakes& mistakes);

    /// The index of the material a shape names; notes an unknown one.
    std::optional<int> read_reference(const JsonValue& value, std::string_view name,
                                      Mistakes& mistakes) const;

    std::vector<Scene::Material> take() { return std::move(materials_); }

   private:
    std::vector<Scene::Material> materials_;
    std::unordered_map<std::string, int> index_;
    bool readable_ = true;  ///< false: names are unknown, so all are accepted
};

Scene::Light read_light(const JsonValue& value, Mistakes& mistakes);
Scene::Sphere read_sphere(const JsonValue& value, const MaterialTable& materials,
                          Mistakes& mistakes);
Scene::Cone read_cone(const JsonValue& value, const MaterialTable& materials, Mistakes& mistakes);
Scene::Triangle read_triangle(const JsonValue& value, const MaterialTable& materials,
                              Mistakes& mistakes);

}  // namespace rt
