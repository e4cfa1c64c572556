// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/features.h"

namespace rt {

std::vector<std::string> names_of(const Features& features, bool used) {
    std::vector<std::string> names;
    for (const FeatureName& feature : feature_names) {
        if (features.*feature.flag == used) names.emplace_back(feature.name);
    }
    return names;
}

}  // namespace rt
