// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/image/picture.h"
#include "host/measure/converge.h"
#include "host/options/converge_options.h"
#include "host/scene/scene.h"

namespace rt {

struct ConvergedPicture {
    Picture picture;  ///< the mean of the halves
    ConvergeReference about;
    bool complete = true;  ///< false when a signal stopped it
};

/// The converged picture of a scene at its own size and bounces: rendered in double on threads and
/// cached, or read from the cache folder. A cache that cannot be written only causes a message on
/// stderr.
ConvergedPicture converged_picture(const Scene& scene, const ConvergeOptions& options);

}  // namespace rt
