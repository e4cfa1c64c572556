// SPDX-License-Identifier: Apache-2.0
#include "host/render/techniques.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/error.h"

namespace rt {

bool Techniques::any() const { return !names_of(*this).empty(); }

Techniques all_techniques() {
    Techniques naive;
    for (const Technique& technique : techniques) naive.*technique.flag = true;
    return naive;
}

std::vector<std::string> names_of(const Techniques& naive) {
    std::vector<std::string> names;
    for (const Technique& technique : techniques) {
        if (naive.*technique.flag) names.emplace_back(technique.name);
    }
    return names;
}

Techniques techniques_named(const std::string& option, const std::vector<std::string>& names) {
    Techniques naive;
    for (const std::string& name : names) {
        const auto* technique =
            std::find_if(techniques.begin(), techniques.end(),
                         [&](const Technique& one) { return name == one.name; });
        if (technique == techniques.end()) {
            throw Error(ExitCode::usage,
                        fmt::format("{}: no technique '{}'; there are: {}", option, name,
                                    fmt::join(names_of(all_techniques()), ", ")));
        }
        naive.*technique->flag = true;
    }
    return naive;
}

}  // namespace rt
