// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/features.h"

namespace rt {

Features no_features() {
    Features features;
    for (const FeatureName& feature : feature_names) features.*feature.flag = false;
    return features;
}

Features features_of(int bits) {
    Features features;
    for (std::size_t i = 0; i < feature_names.size(); ++i) {
        features.*feature_names[i].flag = (bits >> i & 1) != 0;
    }
    return features;
}

Features either_of(const Features& a, const Features& b) {
    Features features;
    for (const FeatureName& feature : feature_names) {
        features.*feature.flag = a.*feature.flag || b.*feature.flag;
    }
    return features;
}

std::vector<std::string> names_of(const Features& features, bool used) {
    std::vector<std::string> names;
    for (const FeatureName& feature : feature_names) {
        if (features.*feature.flag == used) names.emplace_back(feature.name);
    }
    return names;
}

}  // namespace rt
