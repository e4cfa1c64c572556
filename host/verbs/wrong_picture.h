// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/options/render_options.h"

namespace rt {

/// After a device's picture was found to be wrong, for whoever mends the driver: renders the scene
/// on the device again, whatever it gives, and on threads. Saves both next to the output, as
/// NAME.wrong.png and NAME.right.png. Returns, for a message, the first pixel that differs and
/// where they are.
std::string keep_wrong_picture(const Scene& scene, const RenderOptions& options);

}  // namespace rt
