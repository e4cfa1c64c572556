// SPDX-License-Identifier: Apache-2.0
#include "host/scene/nff_fill.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/scene/scene_limits.h"

namespace rt {

bool NffFills::read(NffTokens& tokens) {
    constexpr const char* names[] = {"red", "green", "blue", "Kd", "Ks", "Shine", "T", "ior"};
    tokens.expect("f red green blue Kd Ks Shine T ior");
    Fill fill{};
    std::array<std::size_t, 8> places{};
    for (std::size_t i = 0; i < fill.size(); ++i) {
        places[i] = tokens.peek().offset;
        const auto number = tokens.read_not_negative(names[i]);
        if (!number) return false;
        fill[i] = *number;
    }
    const auto [red, green, blue, kd, ks, shine, t, ior] = fill;
    if (t > 0 && ior == 0) {
        mistakes_.add(places[7],
                      "ior is 0 where T is not; write an index above 0, 1 to go straight");
    }
    if (std::max({red, green, blue}) * kd > max_scene_number) {
        mistakes_.add(places[3], "Kd times the colour is above 1e30; make it smaller");
    }
    use(fill);
    return true;
}

void NffFills::use(const Fill& fill) {
    const auto next = static_cast<int>(materials_.size());
    const auto [known, is_new] = index_.try_emplace(fill, next);
    current_ = known->second;
    if (!is_new) return;
    const auto [red, green, blue, kd, ks, shine, t, ior] = fill;
    Scene::Material material;
    material.name = fmt::format("f{}", next + 1);
    material.diffuse = glm::dvec3(red, green, blue) * kd;
    material.ambient = material.diffuse;
    material.specular = material.mirror = glm::dvec3(ks, ks, ks);
    material.shininess = shine;
    material.transmission = glm::dvec3(t, t, t);
    material.ior = t > 0 ? ior : 1;
    material.two_sided = true;
    materials_.push_back(material);
}

int NffFills::current() {
    if (current_ < 0) use({1, 1, 1, 1, 0, 0, 0, 1});
    return current_;
}

}  // namespace rt
