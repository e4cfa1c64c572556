// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/image/picture.h"
#include "host/render/rect.h"

namespace rt {

/// Crops a 3-channel picture to `part`, which must lie within it.
Picture cut(const Picture& picture, const Rect& part);

}  // namespace rt
