// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/features.h"

namespace rt {

std::vector<std::string> names_of(const Features& features, bool used) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < features.size(); ++i) {
        if (features[i] == used) names.emplace_back(feature_names[i].name);
    }
    return names;
}

}  // namespace rt
