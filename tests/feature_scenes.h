// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/flatten/features.h"
#include "host/scene/scene.h"

// Scenes that need chosen features of the kernels.
namespace rt::test {

/// A small scene that needs exactly these features.
Scene scene_needing(const Features& features);

/// Whether any scene needs exactly these.
bool is_possible(const Features& features);

}  // namespace rt::test
