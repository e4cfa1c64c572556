// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "host/scene/aa_mode.h"

namespace rt {

/// The largest magnitude of any number in a scene or model file: it fits a float, with headroom for
/// the differences that rendering computes.
inline constexpr double max_scene_number = 1e30;

/// The largest reflectance or transmission: light of 1e30 is still a float after one surface.
inline constexpr double max_reflectance = 1e6;

// The largest picture a scene or user may ask for, in pixels, and the most bounces.
inline constexpr int max_image_side = 65536;
inline constexpr int max_image_pixels = 1 << 28;
inline constexpr int most_bounces = 100000;

/// A scene file's contents, in double precision and in the author's own units. Right-handed; y is
/// up by default; light is linear RGB. A reader (scene_file) validates all it fills in: numbers are
/// finite, radii positive, materials exist. Renderers never see it: flatten makes a FlatScene of
/// it.
struct Scene {
    enum class Projection { perspective, orthographic };

    /// A window on the view plane: at distance 1 from the eye for a perspective camera, in scene
    /// units for an orthographic one; x grows to the right, y upwards.
    struct Window {
        double left = -1, right = 1, bottom = -1, top = 1;
    };

    /// What the author fixed of the view; the other extent follows from the picture's aspect.
    struct FieldOfView {
        enum class Fixed {
            window,       ///< Camera::window is used as is, regardless of the picture's aspect
            horizontal,   ///< the full angle the picture's width spans (perspective)
            vertical,     ///< the full angle the picture's height spans (perspective)
            view_width,   ///< the width in scene units (orthographic)
            view_height,  ///< the height in scene units (orthographic)
        };

        Fixed fixed = Fixed::window;
        double amount = 0;  ///< degrees of an angle, scene units of a width or height
    };

    struct Camera {
        Projection projection = Projection::perspective;
        glm::dvec3 from{0, 0, 2};
        glm::dvec3 at{0, 0, 0};
        glm::dvec3 up{0, 1, 0};
        FieldOfView field_of_view;
        /// The picture's extent. The reader sets it for the scene's own picture size; code that
        /// changes that size calls camera_window again (set_image_size does both).
        Window window;
    };

    /// Camera keyframes of an animation, interpolated in between.
    struct CameraPath {
        struct Key {
            double frame = 0;
            Camera camera;  ///< of the same kind as the scene's
        };

        bool is_smooth = true;  ///< Catmull-Rom splines; else straight lines
        std::vector<Key> keys;  ///< frames ascend; empty: the camera stays where it is
    };

    /// Surface reflectances per RGB channel, each >= 0 (Phong 1975, Blinn 1977, Whitted 1980).
    struct Material {
        std::string name;
        glm::dvec3 ambient{0}, diffuse{0}, specular{0}, mirror{0};
        glm::dvec3 transmission{0};  ///< what passes through, per channel
        double shininess = 1;        ///< exponent of the Blinn lobe, >= 0
        double ior = 1;              ///< index of refraction behind the surface, > 0
        bool two_sided = false;      ///< turn normals towards the viewer
    };

    /// A point light without fall-off.
    struct Light {
        glm::dvec3 position{0};
        glm::dvec3 intensity{1};
        bool has_own_intensity = true;  ///< false: the file gave none (--light-scale)
    };

    struct Sphere {
        glm::dvec3 center{0};
        double radius = 1;
        int material = 0;  ///< index into Scene::materials
    };

    /// Counterclockwise seen from the front. Vertex normals, where given, are unit length
    /// (the reader normalizes them) and interpolated over the face.
    struct Triangle {
        std::array<glm::dvec3, 3> vertices{};
        std::optional<std::array<glm::dvec3, 3>> normals;
        int material = 0;
    };

    /// The side of a cone's frustum, open at both ends; a cylinder where the radii are equal.
    struct Cone {
        glm::dvec3 base{0}, apex{0, 1, 0};        ///< centers of the two rims, apart
        double base_radius = 1, apex_radius = 0;  ///< >= 0, one of them > 0
        int material = 0;                         ///< index into Scene::materials
    };

    /// Triangles that share vertices. Faces are counterclockwise seen from the front.
    struct Mesh {
        using Face = std::array<std::uint32_t, 3>;

        std::vector<glm::dvec3> positions;
        std::vector<glm::dvec3> normals;  ///< unit; empty for a flat mesh
        std::vector<Face> faces;          ///< indices into positions
        std::vector<Face> face_normals;   ///< indices into normals, one row a face, or no rows
        /// Indices into Scene::materials: one a face, or a single one for all.
        std::vector<int> face_materials;

        /// A face without vertex normals has this in its row of face_normals.
        static constexpr std::uint32_t no_normal = 0xffffffff;
    };

    std::string name;
    Camera camera;
    CameraPath path;
    int width = 500, height = 500;  ///< pixels
    AaMode aa;
    Filter filter = Filter::box;
    int sampling_seed = 0;  ///< of sobol samples: another seed, another independent picture
    int max_bounces = 8;    ///< mirror and refracted rays in a row after the eye ray
    glm::dvec3 background{0};
    glm::dvec3 ambient_light{0};
    std::vector<Light> lights;
    std::vector<Material> materials;
    std::vector<Sphere> spheres;
    std::vector<Cone> cones;
    std::vector<Triangle> triangles;
    std::vector<Mesh> meshes;
    /// What the reader ignored, a sentence each, for the user; no effect on rendering.
    std::vector<std::string> notes;
    std::vector<std::string> model_files;  ///< read in addition to the scene's own file
};

/// The colors of a material and their keys in scene files.
inline constexpr Named<glm::dvec3 Scene::Material::*> material_colors[] = {
    {"ambient", &Scene::Material::ambient},
    {"diffuse", &Scene::Material::diffuse},
    {"specular", &Scene::Material::specular},
    {"mirror", &Scene::Material::mirror},
    {"transmission", &Scene::Material::transmission}};

struct Box {
    glm::dvec3 low{std::numeric_limits<double>::infinity()}, high = -low;  ///< empty
};

/// The box of all shapes.
Box bounding_box(const Scene& scene);

/// The triangles of the scene, those of its meshes included.
std::size_t triangle_count(const Scene& scene);

/// The window that this camera's field of view covers on a picture of this size in pixels.
Scene::Window camera_window(const Scene::Camera& camera, int width, int height);

/// Sets the scene's picture size (pixels) and updates the camera's window to match.
void set_image_size(Scene& scene, int width, int height);

/// The default name of a scene: its file name without the extension.
std::string name_of_file(const std::string& path);

/// The scene's camera at a frame: on its path between the keys, clamped to the first and last key.
/// Throws Error (ExitCode::input) for a scene without a path, and where the view direction or up
/// vector is degenerate.
Scene::Camera camera_at(const Scene& scene, double frame);

/// Warnings about valid but rarely intended input, one sentence each: no light at all, nothing in
/// view, colors of 0 to 255, mirrors that brighten. No false alarms, but not exhaustive.
std::vector<std::string> scene_warnings(const Scene& scene);

/// A hash of what the scene shows: camera, light, materials and shapes; not its name or its
/// sampling (size, AA, bounces).
std::uint64_t scene_hash(const Scene& scene);

}  // namespace rt
