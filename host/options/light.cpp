// SPDX-License-Identifier: Apache-2.0
#include "host/options/parse.h"
#include "host/options/verb_options.h"

namespace rt {

namespace {

double parse_light_scale(const std::string& text) {
    const auto numbers = parse_amounts(text);
    if (!numbers || numbers->size() != 1) {
        refuse("--light-scale", text, "give a number from 0 to 1e30, as in 0.5");
    }
    return numbers->front();
}

glm::dvec3 parse_ambient(const std::string& text) {
    const auto numbers = parse_amounts(text);
    if (!numbers || (numbers->size() != 1 && numbers->size() != 3)) {
        refuse("--ambient", text, "give R,G,B or one number, from 0 to 1e30, as in 0.2");
    }
    const std::vector<double>& n = *numbers;
    return n.size() == 1 ? glm::dvec3(n[0]) : glm::dvec3(n[0], n[1], n[2]);
}

}  // namespace

void add_light_options(const CommandLine& verb, LightOverrides& light) {
    verb.option("--light-scale", "X",
                "intensity for lights without one (default: NFF sqrt(n)/2n, JSON 1, models "
                "0.75 and 0.25)",
                [&](const std::string& text) { light.light_scale = parse_light_scale(text); });
    verb.option("--ambient", "R,G,B|X", "ambient light (default: the scene's)",
                [&](const std::string& text) { light.ambient_light = parse_ambient(text); });
}

}  // namespace rt
