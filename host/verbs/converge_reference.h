// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/image/picture.h"
#include "host/measure/converge_result.h"
#include "host/options/converge_options.h"
#include "host/scene/scene.h"

namespace rt {

struct ConvergedPicture {
    Picture picture;  ///< the mean of the halves
    ConvergeReference about;
    bool complete = true;  ///< false when a signal stopped it
};

/// The converged picture of a scene, in its own size and bounces: rendered in double on threads, or
/// read from the cache folder, and then kept there. A cache that cannot be written is said on
/// stderr, no more.
ConvergedPicture converged_picture(const Scene& scene, const ConvergeOptions& options);

}  // namespace rt
