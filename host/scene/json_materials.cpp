// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "host/base/text.h"
#include "host/scene/json_reader.h"
#include "host/scene/json_shapes.h"
#include "host/scene/words.h"

namespace rt {
namespace {

constexpr std::string_view material_keys[] = {"ambient",      "diffuse",   "specular", "mirror",
                                              "transmission", "shininess", "ior",      "two_sided"};

Scene::Material read_material(const JsonMember& member, Mistakes& mistakes) {
    Scene::Material material;
    material.name = printable(member.key);
    const ObjectReader reader(member.value, "a material", material_keys, mistakes);
    reader.optional("ambient", material.ambient, read_reflectance);
    reader.optional("diffuse", material.diffuse, read_reflectance);
    reader.optional("specular", material.specular, read_reflectance);
    reader.optional("mirror", material.mirror, read_reflectance);
    reader.optional("transmission", material.transmission, read_reflectance);
    reader.optional("ior", material.ior, read_positive);
    reader.optional("shininess", material.shininess, read_not_negative);
    reader.optional("two_sided", material.two_sided, read_bool);
    return material;
}

/// What to do about an unknown material.
std::string advice(std::string_view name, std::span<const std::string_view> known) {
    if (known.empty()) return "the scene has no materials; define it under \"materials\"";
    return suggestion(name, known, "known materials are");
}

}  // namespace

MaterialTable::MaterialTable(const JsonValue* value, Mistakes& mistakes) {
    if (!value) return;
    const auto* members = value->as<JsonValue::Object>();
    readable_ = members != nullptr;
    if (!members) {
        mistakes.add(value->offset, fmt::format("materials is {}; write an object, {{\"name\": "
                                                "{{...}}}}",
                                                kind_of(*value)));
        return;
    }
    for (const JsonMember& member : *members) {
        if (member.key.empty()) {
            mistakes.add(member.key_offset, "a material's name is empty; give it one");
        }
        index_.emplace(member.key, static_cast<int>(materials_.size()));
        materials_.push_back(read_material(member, mistakes));
    }
}

std::optional<int> MaterialTable::read_reference(const JsonValue& value, std::string_view name,
                                                 Mistakes& mistakes) const {
    const std::string* text = read_string(value, name, mistakes);
    if (!text) return std::nullopt;
    const auto found = index_.find(*text);
    if (found != index_.end()) return found->second;
    if (!readable_) return std::nullopt;
    std::vector<std::string_view> known;
    for (const Scene::Material& material : materials_) known.push_back(material.name);
    mistakes.add(value.offset,
                 fmt::format("unknown material {}; {}", in_quotes(*text), advice(*text, known)));
    return std::nullopt;
}

}  // namespace rt
