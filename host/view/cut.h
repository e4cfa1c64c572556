// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/image/picture.h"
#include "host/render/rect.h"

namespace rt {

/// A part of a picture of 3 channels, which lies in it.
Picture cut(const Picture& picture, const Rect& part);

}  // namespace rt
