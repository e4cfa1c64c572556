// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "host/flatten/flat_types.h"

namespace rt {

/// Traces rays outside a picture, with all features compiled in: one answer per query
/// (kernels/rays.cl). Throws Error (ExitCode::device) if the device fails. For one thread at a
/// time; the scene must outlive it.
template <typename T>
using RayTracer = std::function<void(std::span<const typename Flat<T>::RayQuery> queries,
                                     std::span<typename Flat<T>::RayAnswer> answers)>;

}  // namespace rt
