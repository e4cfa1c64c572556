// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "host/explain/ray_tree.h"

namespace rt {

namespace {

using Kind = RayNode::Kind;
using State = LightAtHit::State;

/// Below half a step of 8 bits.
constexpr double least_weight = 0.004;

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

std::string surface_of(const RayNode& ray) {
    return ray.hit ? printable(ray.hit->material) : "background";
}

/// What each ray shows, and how much that adds to the color. `via`: how the eye's ray got there.
void add_shares(const RayNode& ray, const std::string& via,
                std::vector<std::pair<std::string, double>>& shares) {
    const std::string name = surface_of(ray) + via;
    auto share = std::ranges::find(shares, name, [](const auto& one) { return one.first; });
    if (share == shares.end()) share = shares.insert(share, {name, 0});
    const glm::dvec3 color = ray.weight * ray.color;
    share->second += color.x + color.y + color.z;
    for (const RayNode& child : ray.children) {
        const char* const how = child.kind == Kind::mirror ? " mirrored in " : " through ";
        add_shares(child, via.empty() ? how + surface_of(ray) : via, shares);
    }
}

}  // namespace

std::string summary_of(const std::vector<SampleTree>& trees) {
    std::vector<std::pair<std::string, double>> shares;
    for (const SampleTree& tree : trees) add_shares(tree.ray, "", shares);
    double total = 0;
    for (const auto& [name, share] : shares) total += share;
    if (!std::isfinite(total) || total <= 0) return "";
    std::ranges::stable_sort(shares, std::greater(), [](const auto& one) { return one.second; });
    std::string text;
    for (const auto& [name, share] : shares) {
        const double percent = 100 * share / total;
        if (percent < 0.5) continue;
        text += fmt::format("{}{:.0f} % {}", text.empty() ? "" : ", ", percent, name);
    }
    return text;
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
