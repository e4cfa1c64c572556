// SPDX-License-Identifier: Apache-2.0
#include "host/print/ray_tree_text.h"

#include <fmt/format.h>

#include "host/base/text.h"

namespace rt {

namespace {

using Json = nlohmann::ordered_json;

using Kind = RayNode::Kind;
using State = LightAtHit::State;

constexpr Named<Kind> ray_kinds[] = {
    {"eye", Kind::eye}, {"mirror", Kind::mirror}, {"refracted", Kind::refracted}};
constexpr Named<State> light_states[] = {
    {"behind", State::behind}, {"shadowed", State::shadowed}, {"lit", State::lit}};

std::string color_text(const glm::dvec3& v) {
    return fmt::format("{:.5f} {:.5f} {:.5f}", v.x, v.y, v.z);
}

std::string point_text(const glm::dvec3& v) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
}

std::string light_text(const LightAtHit& light) {
    if (light.state == State::lit) return color_text(light.color);
    return light.state == State::behind ? "behind the surface" : "in shadow";
}

void add_ray(const RayNode& ray, std::string& text) {
    const std::string indent(static_cast<std::size_t>(2 + 4 * ray.bounce), ' ');
    if (ray.hit) {
        text += fmt::format("{}{} ray hits {} ({}) at {}, {:.6g} away, normal {}\n", indent,
                            name_of(ray_kinds, ray.kind), ray.object, printable(ray.material),
                            point_text(ray.point), ray.distance, point_text(ray.normal));
    } else {
        text += fmt::format("{}{} ray hits nothing\n", indent, name_of(ray_kinds, ray.kind));
    }
    if (ray.hit) {
        text += fmt::format("{}    ambient     {}\n", indent, color_text(ray.ambient));
        for (const LightAtHit& light : ray.lights) {
            text +=
                fmt::format("{}    light {:<5} {}\n", indent, light.light + 1, light_text(light));
        }
    }
    text += fmt::format("{}    {:<11} {}\n", indent, ray.hit ? "local light" : "background",
                        color_text(ray.color));
    text += fmt::format("{}    x weight    {}\n", indent, color_text(ray.weight));
    text += fmt::format("{}    adds        {}\n", indent, color_text(ray.weight * ray.color));
    for (const RayNode& child : ray.children) add_ray(child, text);
}

Json triple_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

Json ray_json(const RayNode& ray) {
    Json json{{"kind", name_of(ray_kinds, ray.kind)},    {"bounce", ray.bounce},
              {"weight", triple_json(ray.weight)},       {"origin", triple_json(ray.origin)},
              {"direction", triple_json(ray.direction)}, {"hit", nullptr},
              {"color", triple_json(ray.color)},         {"children", Json::array()}};
    if (ray.hit) {
        Json lights = Json::array();
        for (const LightAtHit& light : ray.lights) {
            lights.push_back({{"light", light.light + 1},
                              {"state", name_of(light_states, light.state)},
                              {"color", triple_json(light.color)}});
        }
        json["hit"] = {{"object", ray.object},
                       {"material", printable(ray.material)},
                       {"distance", ray.distance},
                       {"point", triple_json(ray.point)},
                       {"normal", triple_json(ray.normal)},
                       {"ambient", triple_json(ray.ambient)},
                       {"lights", lights}};
    }
    for (const RayNode& child : ray.children) json["children"].push_back(ray_json(child));
    return json;
}

}  // namespace

std::string ray_trees_text(const std::vector<SampleTree>& trees) {
    std::string text;
    for (const SampleTree& tree : trees) {
        text += fmt::format("sample {}: {}\n", tree.number + 1, color_text(color_of(tree.ray)));
        add_ray(tree.ray, text);
    }
    return text;
}

nlohmann::ordered_json ray_trees_json(const std::vector<SampleTree>& trees) {
    Json samples = Json::array();
    for (const SampleTree& tree : trees) {
        samples.push_back({{"sample", tree.number},
                           {"color", triple_json(color_of(tree.ray))},
                           {"ray", ray_json(tree.ray)}});
    }
    return samples;
}

}  // namespace rt
