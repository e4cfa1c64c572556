// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/picture/render_settings.h"
#include "host/scene/scene.h"
#include "host/verbs/device_list.h"

namespace rt {

/// One deviation from the defaults: compiles something the scene does not need, or removes
/// something it uses.
struct Change {
    std::string what;
    std::function<void(RenderSettings&)> make;
};

/// The changes that `bench --ablate` tries on this scene and device. Hierarchies are removed only
/// where testing all primitives one by one does not take too long.
std::vector<Change> changes_to_measure(const Scene& scene, const ListedDevice& device,
                                       Precision precision);

}  // namespace rt
