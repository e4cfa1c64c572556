// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/picture/render_settings.h"
#include "host/scene/scene.h"
#include "host/verbs/device_list.h"

namespace rt {

/// One thing that is not as usual: something that the scene does not need put back in, or something
/// that it has taken away.
struct Change {
    std::string what;
    std::function<void(RenderSettings&)> make;
};

/// What `bench --ablate` tries on this scene and device. No hierarchy is taken away from more
/// primitives than can be tested one after the other in bearable time.
std::vector<Change> changes_to_measure(const Scene& scene, const ListedDevice& device,
                                       Precision precision);

}  // namespace rt
