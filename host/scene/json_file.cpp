// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <unordered_map>
#include <utility>

#include "host/base/text.h"
#include "host/scene/geometry.h"
#include "host/scene/json_document.h"
#include "host/scene/model.h"
#include "host/scene/scene.h"
#include "host/scene/scene_file.h"
#include "host/scene/text_file.h"
#include "host/scene/words.h"

namespace rt {
namespace {

using Corners = std::array<glm::dvec3, 3>;
using Fixed = Scene::FieldOfView::Fixed;
using Key = Scene::CameraPath::Key;

constexpr Named<Scene::Projection> projections[] = {
    {"perspective", Scene::Projection::perspective},
    {"orthographic", Scene::Projection::orthographic}};
constexpr Named<Fixed> fov_axes[] = {{"x", Fixed::horizontal}, {"y", Fixed::vertical}};
constexpr Named<bool> interpolations[] = {{"catmull-rom", true}, {"linear", false}};

/// The keys for what a camera fixes of its field of view, unless it has a window.
constexpr Named<Fixed> extents[] = {{"fov_degrees", Fixed::vertical},
                                    {"fov_degrees", Fixed::horizontal},
                                    {"width", Fixed::view_width},
                                    {"height", Fixed::view_height}};

std::optional<std::string> read_name(const JsonField& field) {
    const auto name = read_string(field);
    if (!name || printable(*name) == *name) return name;
    return field.refuse("'name' contains a control or invisible character; use plain text");
}

std::optional<AaMode> read_aa(const JsonField& field) {
    const auto text = read_string(field);
    if (!text) return std::nullopt;
    const auto mode = parse_aa_mode(*text);
    if (!mode) field.refuse("unknown aa {}; write {}", in_quotes(*text), aa_mode_help);
    return mode;
}

std::optional<Scene::Window> read_window(const JsonField& field) {
    const auto sides = read_items<4>(field, "an array, [...]", "4 of them", read_number);
    if (!sides) return std::nullopt;
    const auto [left, right, bottom, top] = *sides;
    if (left < right && bottom < top) return Scene::Window{left, right, bottom, top};
    return field.refuse(
        "the window is empty or mirrored; write [left, right, bottom, top] with left < right and "
        "bottom < top");
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

void read_steps(ObjectReader& reader, Affine& transform) {
    glm::dvec3 scale(1), degrees(0), translation(0);
    reader.optional("scale", scale, read_scale);
    reader.optional("rotate_degrees", degrees, read_vec3);
    reader.optional("translate", translation, read_vec3);
    transform = make_affine(scale, degrees, translation);
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
    std::optional<Affine> affine(std::in_place);
    if (field.value.as<JsonValue::Array>()) {
        affine = read_matrix(field);
    } else {
        read_object({field.value, "the transform", field.mistakes}, *affine, read_steps);
    }
    if (!affine || normal_matrix(affine->linear)) return affine;
    return field.refuse("the transform is singular and flattens the mesh; correct its numbers");
}

void read_image(ObjectReader& image, Scene& scene) {
    image.optional("width", scene.width, integer_from(1, max_image_side));
    image.optional("height", scene.height, integer_from(1, max_image_side));
    image.optional("aa", scene.aa, read_aa);
    const auto pixels = static_cast<std::int64_t>(scene.width) * scene.height;
    if (pixels <= max_image_pixels) return;
    image.field.refuse("the image has {} pixels; make it {} at most", pixels, max_image_pixels);
}

/// The one of the keys that is present; notes it if there is none, or more.
std::optional<std::string_view> find_only(ObjectReader& camera,
                                          const std::vector<std::string_view>& keys) {
    std::vector<std::string_view> found;
    for (const std::string_view key : keys) {
        if (camera.find(key)) found.push_back(key);
    }
    if (found.size() == 1) return found[0];
    return camera.field.refuse("the camera gives {} of {}; give exactly one", found.size(),
                               word_list(keys));
}

void read_extent(ObjectReader& reader, std::string_view key, double& amount) {
    reader.optional(key, amount, key == "fov_degrees" ? read_angle : read_positive);
}

void read_camera(ObjectReader& reader, Scene::Camera& camera) {
    reader.required("from", "[x, y, z], where the eye is", camera.from, read_vec3);
    reader.required("at", "[x, y, z], where it looks", camera.at, read_vec3);
    const bool has_up = reader.optional("up", camera.up, read_vec3);
    if (reader.is_good()) {
        if (const auto mistake = find_axes_mistake(camera.from, camera.at, camera.up)) {
            reader.refuse(mistake->is_up && has_up ? "up" : "at", mistake->message);
        }
    }
    reader.optional("window", camera.window, read_window);
    std::optional<Scene::Projection> type;
    if (reader.optional("type", type, one_of("camera type", projections)) && !type) {
        for (const auto& [key, fixed] : extents) reader.find(key);  // each may be valid
        reader.find("fov_axis");
        return;
    }
    camera.projection = type.value_or(Scene::Projection::perspective);
    const bool is_perspective = camera.projection == Scene::Projection::perspective;
    std::vector<std::string_view> keys{"height", "width", "window"};
    if (is_perspective) keys = {"fov_degrees", "window"};
    const auto key = find_only(reader, keys);
    if (key == "window") return;
    Scene::FieldOfView& view = camera.field_of_view;
    if (key) {
        view.fixed = *value_of(extents, *key);
        read_extent(reader, *key, view.amount);
    }
    if (is_perspective) reader.optional("fov_axis", view.fixed, one_of("fov_axis", fov_axes));
}

/// Keys of a path inherit what they omit from the scene's own camera.
void read_key(ObjectReader& reader, Key& key) {
    Scene::Camera& camera = key.camera;
    reader.required("frame", "1", key.frame, read_number);
    reader.optional("from", camera.from, read_vec3);
    reader.optional("at", camera.at, read_vec3);
    reader.optional("up", camera.up, read_vec3);
    const std::string_view extent = name_of(extents, camera.field_of_view.fixed);
    if (!extent.empty()) read_extent(reader, extent, camera.field_of_view.amount);
    if (!reader.is_good()) return;
    if (const auto mistake = find_axes_mistake(camera.from, camera.at, camera.up)) {
        reader.field.refuse("{}", mistake->message);
    }
}

/// Once around `at` and back to the start in so many frames, the first of which is 1.
std::vector<Key> turntable(const Scene::Camera& camera, int frames) {
    const glm::dvec3 axis = unit_direction(camera.up).value_or(glm::dvec3(0, 1, 0));
    std::vector<Key> keys;
    for (int i = 0; i < frames; ++i) {
        keys.push_back({i + 1.0, camera});
        keys.back().camera.from =
            camera.at + turned(camera.from - camera.at, axis, 360.0 * i / frames);
    }
    return keys;
}

void read_path(ObjectReader& reader, Scene& scene) {
    Scene::CameraPath& path = scene.path;
    int frames = 0;
    if (reader.optional("turntable", frames, integer_from(2, 100000))) {
        path.keys = turntable(scene.camera, frames);
        return;
    }
    reader.optional("interpolation", path.is_smooth, one_of("interpolation", interpolations));
    const JsonValue* keys = reader.require("keys", "[{\"frame\": 1, \"from\": [0, 0, 5]}]");
    Mistakes& mistakes = reader.field.mistakes;
    const auto* items = keys ? read_array({*keys, "keys", mistakes}) : nullptr;
    if (!items) return;
    if (items->empty()) reader.refuse("keys", "the path has no keys; give one or more");
    for (const JsonValue& value : *items) {
        const JsonField item{value, "a key of the path", mistakes};
        Key key{0, scene.camera};
        if (!read_object(item, key, read_key)) continue;
        if (!path.keys.empty() && key.frame <= path.keys.back().frame) {
            item.refuse("frame {} comes after frame {}; put the keys in order, and each frame once",
                        key.frame, path.keys.back().frame);
            continue;
        }
        path.keys.push_back(key);
    }
}

/// Reads all but the objects.
void read_settings(ObjectReader& reader, Scene& scene) {
    std::string ignored;  // for editors and people
    reader.optional("$schema", ignored, read_string);
    reader.optional("description", ignored, read_string);
    reader.optional("name", scene.name, read_name);
    reader.require("camera", "{\"from\": [0, 0, 5], \"at\": [0, 0, 0], \"fov_degrees\": 60}");
    const bool has_camera = reader.object("camera", "the camera", scene.camera, read_camera);
    if (reader.find("path") && has_camera) reader.object("path", "the path", scene, read_path);
    reader.object("image", "the image", scene, read_image);
    reader.optional("max_bounces", scene.max_bounces, integer_from(0, most_bounces));
    reader.optional("background", scene.background, read_color);
    reader.optional("ambient_light", scene.ambient_light, read_color);
}

void read_light(ObjectReader& reader, Scene::Light& light) {
    reader.required("position", "[x, y, z]", light.position, read_vec3);
    light.has_own_intensity = reader.optional("intensity", light.intensity, read_color);
}

void read_frustum(ObjectReader& reader, Scene::Cone& cone) {
    reader.required("base", "[x, y, z]", cone.base, read_vec3);
    reader.required("base_radius", "1", cone.base_radius, read_not_negative);
    reader.required("apex", "[x, y, z]", cone.apex, read_vec3);
    reader.required("apex_radius", "0", cone.apex_radius, read_not_negative);
    if (!reader.is_good()) return;
    if (nearly_same_point(cone.base, cone.apex)) reader.refuse("apex", same_cone_ends);
    if (cone.base_radius == 0 && cone.apex_radius == 0) {
        reader.refuse("base_radius", zero_cone_radii);
    }
}

void read_material(ObjectReader& reader, Scene::Material& material) {
    for (const auto& [key, color] : material_colors) {
        reader.optional(key, material.*color, read_reflectance);
    }
    reader.optional("ior", material.ior, read_positive);
    reader.optional("shininess", material.shininess, read_not_negative);
    reader.optional("two_sided", material.two_sided, read_bool);
}

/// An item of "meshes" without the model itself.
struct MeshRequest {
    std::string file;             ///< as written in the scene
    std::uint32_t offset = 0;     ///< of the item in the scene's text
    std::optional<int> material;  ///< for all faces, in place of the model's own
    Affine transform;
};

/// Models are loaded only if the scene has no other mistakes.
class JsonSceneReader {
   public:
    JsonSceneReader(std::string_view text, const std::string& file_name)
        : mistakes_(text, file_name), folder_(SceneFolder::of(file_name)) {}

    /// Throws as load_model does.
    Scene read() {
        const JsonValue root = parse_json(mistakes_);
        read_object({root, "the scene", mistakes_}, scene_,
                    [&](ObjectReader& reader, Scene& scene) {
                        read_settings(reader, scene);
                        read_objects(reader, scene);
                    });
        mistakes_.throw_if_any();
        for (const MeshRequest& mesh : meshes_) load_mesh(mesh);
        mistakes_.throw_if_any();
        return std::move(scene_);
    }

   private:
    void read_objects(ObjectReader& reader, Scene& scene) {
        if (const auto* materials = reader.find("materials")) {
            read_materials({*materials, "materials", mistakes_});
        }
        reader.list("lights", "a light", scene.lights, read_light);
        reader.list("spheres", "a sphere", scene.spheres,
                    [&](ObjectReader& item, Scene::Sphere& sphere) {
                        item.required("center", "[x, y, z]", sphere.center, read_vec3);
                        item.required("radius", "1", sphere.radius, read_positive);
                        read_material_of(item, sphere.material);
                    });
        reader.list("cones", "a cone", scene.cones, [&](ObjectReader& item, Scene::Cone& cone) {
            read_frustum(item, cone);
            read_material_of(item, cone.material);
        });
        reader.list("triangles", "a triangle", scene.triangles,
                    [&](ObjectReader& item, Scene::Triangle& triangle) {
                        item.required("vertices", "[[x, y, z], [x, y, z], [x, y, z]]",
                                      triangle.vertices, read_vertices);
                        item.optional("normals", triangle.normals, read_normals);
                        read_material_of(item, triangle.material);
                    });
        reader.list("meshes", "a mesh", meshes_,
                    [&](ObjectReader& item, MeshRequest& mesh) { read_mesh(item, mesh); });
    }

    void read_materials(const JsonField& field) {
        const auto* members = field.value.as<JsonValue::Object>();
        if (!members) {
            field.refuse_kind("an object, {\"name\": {...}}");
            has_materials_ = false;
            return;
        }
        for (const JsonMember& member : *members) {
            if (member.key.empty()) {
                mistakes_.add(member.key_offset, "a material's name is empty; give it one");
            }
            material_numbers_.emplace(member.key, static_cast<int>(scene_.materials.size()));
            Scene::Material& material = scene_.materials.emplace_back();
            material.name = printable(member.key);
            read_object({member.value, "a material", mistakes_}, material, read_material);
        }
    }

    /// The index of the material that a shape names; notes an unknown one.
    std::optional<int> read_reference(const JsonField& field) const {
        const auto text = read_string(field);
        if (!text || !has_materials_) return std::nullopt;
        const auto found = material_numbers_.find(*text);
        if (found != material_numbers_.end()) return found->second;
        std::vector<std::string_view> known;
        for (const Scene::Material& material : scene_.materials) known.push_back(material.name);
        return field.refuse("unknown material {}; {}", in_quotes(*text),
                            known.empty()
                                ? "the scene has no materials; define it under \"materials\""
                                : suggestion(*text, known, "known materials are"));
    }

    void read_material_of(ObjectReader& reader, int& target) const {
        reader.required("material", "\"name\"", target,
                        [&](const JsonField& field) { return read_reference(field); });
    }

    void read_mesh(ObjectReader& reader, MeshRequest& mesh) const {
        mesh.offset = reader.field.value.offset;
        reader.required("file", "\"model.ply\"", mesh.file,
                        [&](const JsonField& field) { return read_file_name(field); });
        const bool has_material =
            reader.optional("material", mesh.material,
                            [&](const JsonField& field) { return read_reference(field); });
        if (!has_material && is_ply_name(mesh.file)) {
            reader.require("material", "\"name\": PLY files have none");
        }
        reader.optional("transform", mesh.transform, read_transform);
    }

    std::optional<std::string> read_file_name(const JsonField& field) const {
        const auto text = read_string(field);
        if (!text) return std::nullopt;
        if (!is_obj_name(*text) && !is_ply_name(*text)) {
            return field.refuse(
                "{} is not a supported model file; name a file that ends in .obj or .ply",
                in_quotes(*text));
        }
        const OpenedFile opened = open_beneath(folder_, *text);
        if (opened.problem.empty()) return text;
        return field.refuse("{}", opened.problem);
    }

    /// Adds a model, and its materials unless it gets another, to the scene.
    void load_mesh(const MeshRequest& request) {
        const OpenedFile opened = open_beneath(folder_, request.file);
        if (!opened.problem.empty()) return mistakes_.add(request.offset, "{}", opened.problem);
        const ModelOptions options{folder_.root, !request.material, request.transform};
        Model model = load_model(opened.file, opened.path, options);
        std::vector<int>& materials = model.mesh.face_materials;
        if (request.material) {
            materials = {*request.material};
        } else if (model.materials.empty()) {
            mistakes_.add(request.offset,
                          "a mesh has no \"material\", and {} has none either; add \"material\": "
                          "\"name\"",
                          in_quotes(opened.path));
        } else {
            const auto first = static_cast<int>(scene_.materials.size());
            for (int& material : materials) material += first;
            std::ranges::move(model.materials, std::back_inserter(scene_.materials));
        }
        scene_.meshes.push_back(std::move(model.mesh));
        std::ranges::move(model.notes, std::back_inserter(scene_.notes));
        std::ranges::move(model.library_files, std::back_inserter(scene_.model_files));
        scene_.model_files.push_back(opened.path);
    }

    Mistakes mistakes_;
    const SceneFolder folder_;
    Scene scene_;
    std::unordered_map<std::string, int> material_numbers_;
    bool has_materials_ = true;  ///< false: they cannot be read, so any name is accepted
    std::vector<MeshRequest> meshes_;
};

}  // namespace

Scene parse_json_scene(std::string_view text, const std::string& file_name) {
    Scene scene = JsonSceneReader(text, file_name).read();
    if (scene.name.empty()) scene.name = name_of_file(file_name);
    set_image_size(scene, scene.width, scene.height);
    return scene;
}

}  // namespace rt
