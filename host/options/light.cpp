// SPDX-License-Identifier: Apache-2.0
#include "host/options/parse.h"
#include "host/options/verb_options.h"

namespace rt {

namespace {

std::optional<double> amount_of(const std::string& text) {
    const auto number = parse_number<double>(text);
    return number && *number >= 0 && *number <= 1e30 ? number : std::nullopt;
}

double parse_light_scale(const std::string& text) {
    const auto scale = amount_of(text);
    if (!scale) refuse(text, "expected a number from 0 to 1e30, such as 0.5");
    return *scale;
}

glm::dvec3 parse_ambient(const std::string& text) {
    constexpr const char* expected = "expected R,G,B or one number, from 0 to 1e30, such as 0.2";
    std::vector<double> n;
    for (const std::string& part : split_list(text, expected)) {
        n.push_back(amount_of(part).value_or(-1));
        if (n.back() < 0) refuse(text, expected);
    }
    if (n.size() != 1 && n.size() != 3) refuse(text, expected);
    return n.size() == 1 ? glm::dvec3(n[0]) : glm::dvec3(n[0], n[1], n[2]);
}

}  // namespace

void add_light_options(const CommandLine& verb, LightOverrides& light) {
    verb.value("--light-scale", "X", light.light_scale, parse_light_scale,
               "intensity of lights that have none (default: NFF sqrt(n)/2n, JSON 1, models "
               "0.75 and 0.25)");
    verb.value("--ambient", "R,G,B|X", light.ambient_light, parse_ambient,
               "ambient light (default: the scene's)");
}

}  // namespace rt
