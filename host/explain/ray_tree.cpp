// SPDX-License-Identifier: Apache-2.0
#include "host/explain/ray_tree.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/base/error.h"
#include "host/flatten/view_frame.h"
#include "host/render/native_kernels.h"

extern "C" {
void rt_explain_pixel(double* film, rt::f64::RayCounts* counts, const rt::NativeView<double>* view,
                      const rt::f64::Tile* tile);
void rt_note_path_event(const PathEvent* event);
}

namespace {

thread_local std::vector<PathEvent>* listener = nullptr;

}  // namespace

void rt_note_path_event(const PathEvent* event) { listener->push_back(*event); }

namespace rt {

namespace {

glm::dvec3 triple(const double (&numbers)[3]) { return {numbers[0], numbers[1], numbers[2]}; }

/// Builds trees from events. A secondary ray is the child of the last hit with one bounce less:
/// pending rays are processed last in, first out.
class TreeBuilder {
   public:
    TreeBuilder(const Scene& scene, const FlatScene<double>& flat)
        : scene_(scene),
          flat_(flat),
          triangles_(scene),
          frame_(make_view_frame(scene, triangles_, 1)),
          lights_(shining_lights(scene)) {}

    std::vector<SampleTree> build(const std::vector<PathEvent>& events) {
        std::vector<SampleTree> trees;
        for (const PathEvent& event : events) {
            switch (event.what) {
                case RT_EVENT_SAMPLE:
                    trees.push_back({static_cast<int>(event.index), start(event, Kind::eye)});
                    trees.back().ray.weight = glm::dvec3(1);
                    break;
                case RT_EVENT_MIRROR:
                    parent(trees, event).children.push_back(start(event, Kind::mirror));
                    break;
                case RT_EVENT_REFRACTED:
                    parent(trees, event).children.push_back(start(event, Kind::refracted));
                    break;
                case RT_EVENT_SHADOW:
                    seen_.push_back({lights_[static_cast<std::size_t>(event.index)],
                                     LightAtHit::State::shadowed, glm::dvec3(0)});
                    break;
                case RT_EVENT_LIT:
                    seen_.back().state = LightAtHit::State::lit;
                    seen_.back().color = triple(event.color);
                    break;
                case RT_EVENT_MISS:
                    last(trees.back().ray).color = triple(event.color);
                    break;
                case RT_EVENT_HIT:
                    end(event, last(trees.back().ray));
                    break;
                default:
                    break;
            }
        }
        return trees;
    }

   private:
    using Kind = RayNode::Kind;

    glm::dvec3 in_scene(const double (&point)[3]) const {
        return triple(point) / frame_.scale + frame_.eye;
    }

    RayNode start(const PathEvent& event, Kind kind) const {
        RayNode ray;
        ray.kind = kind;
        ray.bounce = static_cast<int>(event.bounce);
        ray.weight = triple(event.weight);
        ray.origin = in_scene(event.point);
        ray.direction = triple(event.normal);
        return ray;
    }

    /// The ray started last.
    static RayNode& last(RayNode& ray) {
        RayNode* found = &ray;
        while (!found->children.empty()) found = &found->children.back();
        return *found;
    }

    static RayNode& parent(std::vector<SampleTree>& trees, const PathEvent& event) {
        RayNode* found = &trees.back().ray;
        while (found->bounce + 1 < event.bounce) found = &found->children.back();
        return *found;
    }

    void end(const PathEvent& event, RayNode& ray) {
        ray.color = triple(event.color);
        RayHit& hit = ray.hit.emplace();
        hit.distance = event.distance / frame_.scale;
        hit.point = in_scene(event.point);
        hit.normal = triple(event.normal);
        const std::size_t number = number_in_scene(flat_, event.index);
        hit.object = object_of(scene_, triangles_, number);
        const Scene::Material& material = material_of(number);
        hit.material = material.name;
        hit.ambient = material.ambient * scene_.ambient_light;
        hit.lights = all_lights();
        seen_.clear();
    }

    /// The lights that a shadow ray was traced to, and the others, which lie behind the surface.
    std::vector<LightAtHit> all_lights() const {
        std::vector<LightAtHit> lights;
        for (std::size_t i = 0, next = 0; i < flat_.lights.size(); ++i) {
            const bool asked = next < seen_.size() && seen_[next].light == lights_[i];
            lights.push_back(asked ? seen_[next++] : LightAtHit{lights_[i], {}, glm::dvec3(0)});
        }
        return lights;
    }

    const Scene::Material& material_of(std::size_t number) const {
        const std::size_t spheres = scene_.spheres.size(), cones = scene_.cones.size();
        const int material = number < spheres ? scene_.spheres[number].material
                             : number < spheres + cones
                                 ? scene_.cones[number - spheres].material
                                 : triangles_.material(number - spheres - cones);
        return scene_.materials[static_cast<std::size_t>(material)];
    }

    const Scene& scene_;
    const FlatScene<double>& flat_;
    const TriangleList triangles_;
    const ViewFrame frame_;
    const std::vector<std::size_t> lights_;
    std::vector<LightAtHit> seen_;  ///< lights of the upcoming hit
};

/// Below half a step of 8 bits.
constexpr double least_weight = 0.004;

std::string color_text(const glm::dvec3& v) {
    return fmt::format("{:.5f} {:.5f} {:.5f}", v.x, v.y, v.z);
}

std::string point_text(const glm::dvec3& v) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
}

std::string light_text(const LightAtHit& light) {
    if (light.state == LightAtHit::State::lit) return color_text(light.color);
    return light.state == LightAtHit::State::behind ? "behind the surface" : "in shadow";
}

std::size_t rays_of(const RayNode& ray) {
    std::size_t count = 1;
    for (const RayNode& child : ray.children) count += rays_of(child);
    return count;
}

/// Returns how many rays are left out.
std::size_t add_ray(const RayNode& ray, bool all, std::string& text) {
    if (!all && std::max({ray.weight.x, ray.weight.y, ray.weight.z}) < least_weight) {
        return rays_of(ray);
    }
    const std::string indent(static_cast<std::size_t>(2 + 4 * ray.bounce), ' ');
    text += fmt::format("{}{} ray hits ", indent, name_of(ray_kinds, ray.kind));
    if (const auto& hit = ray.hit) {
        text += fmt::format("{} ({}) at {}, {:.6g} away, normal {}\n", hit->object,
                            printable(hit->material), point_text(hit->point), hit->distance,
                            point_text(hit->normal));
        text += fmt::format("{}    ambient     {}\n", indent, color_text(hit->ambient));
        for (const LightAtHit& light : hit->lights) {
            text +=
                fmt::format("{}    light {:<5} {}\n", indent, light.light + 1, light_text(light));
        }
    } else {
        text += "nothing\n";
    }
    text += fmt::format("{}    {:<11} {}\n", indent, ray.hit ? "local light" : "background",
                        color_text(ray.color));
    text += fmt::format("{}    x weight    {}\n", indent, color_text(ray.weight));
    text += fmt::format("{}    adds        {}\n", indent, color_text(ray.weight * ray.color));
    std::size_t left_out = 0;
    for (const RayNode& child : ray.children) left_out += add_ray(child, all, text);
    return left_out;
}

}  // namespace

std::string object_of(const Scene& scene, const TriangleList& triangles, std::size_t number) {
    if (number < scene.spheres.size()) return fmt::format("sphere {}", number + 1);
    number -= scene.spheres.size();
    if (number < scene.cones.size()) return fmt::format("cone {}", number + 1);
    const auto [mesh, index] = triangles.place(number - scene.cones.size());
    if (mesh == nullptr) return fmt::format("triangle {}", index + 1);
    return fmt::format("mesh {}, triangle {}", mesh - scene.meshes.data() + 1, index + 1);
}

std::vector<std::size_t> shining_lights(const Scene& scene) {
    std::vector<std::size_t> lights;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        if (scene.lights[i].intensity != glm::dvec3(0)) lights.push_back(i);
    }
    return lights;
}

#ifdef MIRRORBALL_WITHOUT_NATIVE
ExplainedPixel explain_pixel(const FlatScene<double>&, int, int) {
    throw Error(ExitCode::device, "this program was built without kernels for threads");
}
#else
ExplainedPixel explain_pixel(const FlatScene<double>& scene, int x, int y) {
    ExplainedPixel pixel;
    const NativeView<double> view = native_view(scene);
    const f64::Tile tile{x, y, 1, 1, 0, 1, {}};
    f64::RayCounts counts{};
    listener = &pixel.events;
    rt_explain_pixel(&pixel.color.x, &counts, &view, &tile);
    listener = nullptr;
    return pixel;
}
#endif

std::vector<SampleTree> ray_trees(const ExplainedPixel& pixel, const Scene& scene,
                                  const FlatScene<double>& flat) {
    return TreeBuilder(scene, flat).build(pixel.events);
}

glm::dvec3 color_of(const RayNode& ray, const glm::dvec3& before) {
    glm::dvec3 color = before + ray.weight * ray.color;
    for (const RayNode& child : ray.children) color = color_of(child, color);
    return color;
}

std::string ray_trees_text(const std::vector<SampleTree>& trees, bool all) {
    std::string text;
    std::size_t left_out = 0;
    for (const SampleTree& tree : trees) {
        text += fmt::format("sample {}: {}\n", tree.number + 1, color_text(color_of(tree.ray)));
        left_out += add_ray(tree.ray, all, text);
    }
    if (left_out == 0) return text;
    return text + fmt::format("left out: {} of weight below {}; -v shows all\n",
                              counted(left_out, "ray"), least_weight);
}

}  // namespace rt
