// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/mistakes.h"
#include "host/scene/nff_tokens.h"
#include "host/scene/scene.h"

namespace rt {

/// Reads the arguments of a v: from, at, up, angle, hither and resolution, in any order. `offset`
/// is that of the v. Returns false when the rest of the view cannot be parsed.
bool read_nff_view(NffTokens& tokens, std::size_t offset, Scene& scene, Mistakes& mistakes);

}  // namespace rt
