// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/flatten/flat_types.h"
#include "host/flatten/view_frame.h"
#include "host/scene/scene.h"

namespace rt {

/// Camera, sampling, bounces, background and ambient light; the counts of primitives and the roots
/// of hierarchies are left 0.
template <typename T>
typename Flat<T>::LaunchParams flatten_params(const ViewFrame& view, const Scene& scene);

}  // namespace rt
