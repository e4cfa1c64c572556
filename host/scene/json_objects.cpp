// SPDX-License-Identifier: Apache-2.0
#include "host/scene/json_objects.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_map>

#include "host/scene/geometry.h"

namespace rt {
namespace {

std::nullopt_t refuse_kind(const JsonField& field, std::string_view wanted) {
    return field.refuse("{} is {}; write {}", field.name, kind_of(field.value), wanted);
}

std::nullopt_t refuse_number(const JsonField& field, double number, std::string_view wanted) {
    return field.refuse("{} is {}; write {}", field.name, number, wanted);
}

/// Three items, each read by `read`.
template <typename Read>
std::optional<glm::dvec3> read_triple(const JsonField& field, std::string_view wanted, Read read) {
    const auto items = read_items<3>(field, wanted, wanted, read);
    if (!items) return std::nullopt;
    const auto [x, y, z] = *items;
    return glm::dvec3(x, y, z);
}

std::optional<double> read_not_negative(const JsonField& field) {
    const auto number = read_number(field);
    if (!number || *number >= 0) return number;
    return refuse_number(field, *number, "0 or more");
}

std::optional<bool> read_bool(const JsonField& field) {
    if (const bool* truth = field.value.as<bool>()) return *truth;
    return refuse_kind(field, "true or false");
}

/// A color, at most max_reflectance.
std::optional<glm::dvec3> read_reflectance(const JsonField& field) {
    const auto color = read_color(field);
    if (!color) return std::nullopt;
    const double brightest = largest(*color);
    if (brightest <= max_reflectance) return color;
    return refuse_number(field, brightest, fmt::format("{} at most", max_reflectance));
}

using Corners = std::array<glm::dvec3, 3>;

Scene::Material read_material(const JsonMember& member, Mistakes& mistakes) {
    Scene::Material material;
    material.name = printable(member.key);
    ObjectReader reader(member.value, "a material", mistakes);
    reader.optional("ambient", material.ambient, read_reflectance);
    reader.optional("diffuse", material.diffuse, read_reflectance);
    reader.optional("specular", material.specular, read_reflectance);
    reader.optional("mirror", material.mirror, read_reflectance);
    reader.optional("transmission", material.transmission, read_reflectance);
    reader.optional("ior", material.ior, read_positive);
    reader.optional("shininess", material.shininess, read_not_negative);
    reader.optional("two_sided", material.two_sided, read_bool);
    reader.refuse_others();
    return material;
}

/// The materials of a scene file, looked up by name.
class MaterialTable {
   public:
    /// Reads the "materials" object (null: the file has none).
    MaterialTable(const JsonValue* value, Mistakes& mistakes) {
        if (!value) return;
        const auto* members = value->as<JsonValue::Object>();
        readable_ = members != nullptr;
        if (!members) {
            mistakes.add(value->offset,
                         "materials is {}; write an object, {{\"name\": "
                         "{{...}}}}",
                         kind_of(*value));
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

    /// The index of the material a shape names; notes an unknown one.
    std::optional<int> read_reference(const JsonField& field) const {
        const auto text = read_string(field);
        if (!text || !readable_) return std::nullopt;
        if (const auto found = index_.find(*text); found != index_.end()) return found->second;
        std::vector<std::string_view> known;
        for (const Scene::Material& material : materials_) known.push_back(material.name);
        return field.refuse("unknown material {}; {}", in_quotes(*text),
                            known.empty()
                                ? "the scene has no materials; define it under \"materials\""
                                : suggestion(*text, known, "known materials are"));
    }

    std::vector<Scene::Material> take() { return std::move(materials_); }

   private:
    std::vector<Scene::Material> materials_;
    std::unordered_map<std::string, int> index_;
    bool readable_ = true;  ///< false: names are unknown, so all are accepted
};

void read_material_of(ObjectReader& reader, const MaterialTable& materials, int& target) {
    reader.required("material", "\"material\": \"name\"", target,
                    [&](const JsonField& field) { return materials.read_reference(field); });
}

std::optional<Corners> read_corners(const JsonField& field) {
    return read_items<3>(field, "an array, [...]", "3 of them", read_vec3);
}

std::optional<Corners> read_vertices(const JsonField& field) {
    const auto vertices = read_corners(field);
    if (!vertices || !zero_area(*vertices)) return vertices;
    return field.refuse("zero-area triangle; remove it");
}

std::optional<Corners> read_normals(const JsonField& field) {
    auto normals = read_corners(field);
    if (!normals) return std::nullopt;
    for (glm::dvec3& normal : *normals) {
        const auto unit = unit_direction(normal);
        if (!unit) {
            return field.refuse("a vertex normal is zero; give it a direction or remove 'normals'");
        }
        normal = *unit;
    }
    return normals;
}

/// [x, y, z], or one number for all three.
std::optional<glm::dvec3> read_scale(const JsonField& field) {
    std::optional<glm::dvec3> scale;
    if (field.value.as<double>()) {
        if (const auto number = read_number(field)) scale = glm::dvec3(*number);
    } else {
        scale = read_vec3(field);
    }
    if (!scale || (scale->x != 0 && scale->y != 0 && scale->z != 0)) return scale;
    return field.refuse("scale contains a 0; write other numbers");
}

std::optional<Affine> read_steps(const JsonField& field) {
    glm::dvec3 scale(1), degrees(0), translation(0);
    ObjectReader reader(field.value, "the transform", field.mistakes);
    reader.optional("scale", scale, read_scale);
    reader.optional("rotate_degrees", degrees, read_vec3);
    reader.optional("translate", translation, read_vec3);
    reader.refuse_others();
    return make_affine(scale, degrees, translation);
}

std::optional<Affine> read_matrix(const JsonField& field) {
    const auto numbers =
        read_items<16>(field, "an array, [...]", "16 of them, row by row", read_number);
    if (!numbers) return std::nullopt;
    const auto& m = *numbers;
    if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1) {
        return field.item((*field.value.as<JsonValue::Array>())[12])
            .refuse(
                "the last row of the transform is not 0, 0, 0, 1; write the matrix row by row, the "
                "translation in column 4");
    }
    return Affine{{m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]}, {m[3], m[7], m[11]}};
}

/// The 16 numbers of a matrix, row by row, or an object with scale, rotate_degrees, translate.
std::optional<Affine> read_transform(const JsonField& field) {
    const bool is_matrix = field.value.as<JsonValue::Array>() != nullptr;
    const auto affine = is_matrix ? read_matrix(field) : read_steps(field);
    if (!affine || normal_matrix(affine->linear)) return affine;
    return field.refuse("the transform is singular and flattens the mesh; correct its numbers");
}

std::optional<std::string> read_file_name(const JsonField& field, const SceneFolder& folder) {
    const auto text = read_string(field);
    if (!text) return std::nullopt;
    if (!is_obj_name(*text) && !is_ply_name(*text)) {
        return field.refuse(
            "{} is not a supported model file; name a file that ends in .obj or .ply",
            in_quotes(*text));
    }
    const OpenedFile opened = open_beneath(folder, *text);
    if (opened.problem.empty()) return text;
    return field.refuse("{}", opened.problem);
}

Scene::Light read_light(const JsonField& item) {
    Scene::Light light;
    ObjectReader reader(item.value, "a light", item.mistakes);
    reader.required("position", "\"position\": [x, y, z]", light.position, read_vec3);
    reader.optional("intensity", light.intensity, read_color);
    light.has_own_intensity = reader.find("intensity") != nullptr;
    reader.refuse_others();
    return light;
}

Scene::Sphere read_sphere(const JsonField& item, const MaterialTable& materials) {
    Scene::Sphere sphere;
    ObjectReader reader(item.value, "a sphere", item.mistakes);
    reader.required("center", "\"center\": [x, y, z]", sphere.center, read_vec3);
    reader.required("radius", "\"radius\": 1", sphere.radius, read_positive);
    read_material_of(reader, materials, sphere.material);
    reader.refuse_others();
    return sphere;
}

Scene::Cone read_cone(const JsonField& item, const MaterialTable& materials) {
    Scene::Cone cone;
    Mistakes& mistakes = item.mistakes;
    ObjectReader reader(item.value, "a cone", mistakes);
    const std::size_t before = mistakes.count();
    reader.required("base", "\"base\": [x, y, z]", cone.base, read_vec3);
    reader.required("base_radius", "\"base_radius\": 1", cone.base_radius, read_not_negative);
    reader.required("apex", "\"apex\": [x, y, z]", cone.apex, read_vec3);
    reader.required("apex_radius", "\"apex_radius\": 0", cone.apex_radius, read_not_negative);
    if (mistakes.count() == before) {
        if (nearly_same_point(cone.base, cone.apex)) {
            mistakes.add(reader.find("apex")->offset, same_cone_ends);
        }
        if (cone.base_radius == 0 && cone.apex_radius == 0) {
            mistakes.add(reader.find("base_radius")->offset, zero_cone_radii);
        }
    }
    read_material_of(reader, materials, cone.material);
    reader.refuse_others();
    return cone;
}

Scene::Triangle read_triangle(const JsonField& item, const MaterialTable& materials) {
    Scene::Triangle triangle;
    ObjectReader reader(item.value, "a triangle", item.mistakes);
    reader.required("vertices", "\"vertices\": [[x, y, z], [x, y, z], [x, y, z]]",
                    triangle.vertices, read_vertices);
    reader.optional("normals", triangle.normals, read_normals);
    read_material_of(reader, materials, triangle.material);
    reader.refuse_others();
    return triangle;
}

MeshRequest read_mesh(const JsonField& item, const MaterialTable& materials,
                      const SceneFolder& folder) {
    MeshRequest request;
    request.offset = item.value.offset;
    ObjectReader reader(item.value, "a mesh", item.mistakes);
    reader.required("file", "\"file\": \"model.ply\"", request.file,
                    [&](const JsonField& field) { return read_file_name(field, folder); });
    reader.optional("material", request.material,
                    [&](const JsonField& field) { return materials.read_reference(field); });
    if (!reader.find("material") && is_ply_name(request.file)) {
        reader.require("material", "\"material\": \"name\": PLY files have none");
    }
    reader.optional("transform", request.transform, read_transform);
    reader.refuse_others();
    return request;
}

/// Appends read(item) for every item of the array under `key`, if it is there.
template <class T, class Read>
void read_list(ObjectReader& reader, std::string_view key, std::vector<T>& target, Read read) {
    const JsonValue* value = reader.find(key);
    const auto* items = value ? read_array({*value, key, reader.mistakes()}) : nullptr;
    if (!items) return;
    target.reserve(items->size());
    for (const JsonValue& item : *items) target.push_back(read({item, key, reader.mistakes()}));
}

}  // namespace

std::optional<double> read_number(const JsonField& field) {
    const double* number = field.value.as<double>();
    if (!number) return refuse_kind(field, "a number");
    if (std::abs(*number) <= max_scene_number) return *number;
    return refuse_number(field, *number, "a number from -1e30 to 1e30");
}

std::optional<double> read_positive(const JsonField& field) {
    const auto number = read_number(field);
    if (!number || *number > 0) return number;
    return refuse_number(field, *number, "a number above 0");
}

std::optional<int> read_integer(const JsonField& field, int low, int high) {
    const std::string wanted = fmt::format("a whole number from {} to {}", low, high);
    const double* number = field.value.as<double>();
    if (!number) return refuse_kind(field, wanted);
    if (*number >= low && *number <= high && *number == std::floor(*number)) {
        return static_cast<int>(*number);
    }
    return refuse_number(field, *number, wanted);
}

std::optional<std::string> read_string(const JsonField& field) {
    if (const auto* text = field.value.as<std::string>()) return *text;
    return refuse_kind(field, "text in double quotes");
}

std::optional<double> read_angle(const JsonField& field) {
    const auto degrees = read_positive(field);
    if (!degrees || *degrees < 180) return degrees;
    return refuse_number(field, *degrees, "an angle between 0 and 180");
}

std::optional<glm::dvec3> read_vec3(const JsonField& field) {
    return read_triple(field, "three numbers, [x, y, z]", read_number);
}

std::optional<glm::dvec3> read_color(const JsonField& field) {
    if (field.value.as<double>()) {
        const auto level = read_not_negative(field);
        return level ? std::optional(glm::dvec3(*level)) : std::nullopt;
    }
    return read_triple(field, "one number for a gray, or three, [r, g, b]", read_not_negative);
}

const JsonValue::Array* read_array(const JsonField& field, std::string_view wanted) {
    const auto* items = field.value.as<JsonValue::Array>();
    if (!items) refuse_kind(field, wanted);
    return items;
}

ObjectReader::ObjectReader(const JsonValue& value, std::string_view what, Mistakes& mistakes)
    : members_(value.as<JsonValue::Object>()), field_{value, what, mistakes} {
    if (!members_) refuse_kind(field_, "an object, {...}");
}

const JsonValue* ObjectReader::find(std::string_view key) {
    const auto asked = std::span(asked_).first(asked_count_);
    if (std::ranges::find(asked, key) == asked.end()) asked_.at(asked_count_++) = key;
    if (!members_) return nullptr;
    const auto found = std::ranges::find(*members_, key, &JsonMember::key);
    return found == members_->end() ? nullptr : &found->value;
}

void ObjectReader::refuse_others() const {
    if (!members_) return;
    const auto asked = std::span(asked_).first(asked_count_);
    for (const JsonMember& member : *members_) {
        if (std::ranges::find(asked, member.key) != asked.end()) continue;
        mistakes().add(member.key_offset, "unknown key {} in {}; {}", in_quotes(member.key),
                       field_.name, suggestion(member.key, asked, "known keys are"));
    }
}

const JsonValue* ObjectReader::require(std::string_view key, std::string_view example) {
    const JsonValue* value = find(key);
    if (!value && members_) {
        field_.refuse("{} has no {}; add {}", field_.name, in_quotes(key), example);
    }
    return value;
}

std::vector<MeshRequest> read_objects(ObjectReader& reader, const SceneFolder& folder,
                                      Scene& scene) {
    std::vector<MeshRequest> meshes;
    MaterialTable materials(reader.find("materials"), reader.mistakes());
    const auto with_materials = [&](auto read) {
        return [&materials, read](const JsonField& item) { return read(item, materials); };
    };
    read_list(reader, "lights", scene.lights, read_light);
    read_list(reader, "spheres", scene.spheres, with_materials(read_sphere));
    read_list(reader, "cones", scene.cones, with_materials(read_cone));
    read_list(reader, "triangles", scene.triangles, with_materials(read_triangle));
    read_list(reader, "meshes", meshes,
              [&](const JsonField& item) { return read_mesh(item, materials, folder); });
    scene.materials = materials.take();
    return meshes;
}

}  // namespace rt
