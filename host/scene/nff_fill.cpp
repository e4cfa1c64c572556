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
    const auto check = [&](double weight, std::size_t place, std::string_view name) {
        if (weight <= max_reflectance) return;
        mistakes_.add(places[place],
                      fmt::format("{} is {}; write {} at most", name, weight, max_reflectance));
    };
    check(std::max({red, green, blue}) * kd, 3, "Kd times the color");
    check(ks, 4, names[4]);
    check(t, 6, names[6]);
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
