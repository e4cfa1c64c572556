// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/mistakes.h"
#include "host/scene/nff_tokens.h"
#include "host/scene/scene.h"

namespace rt {

/// Reads what follows a v: from, at, up, angle, hither and resolution, in any order. `offset` is
/// where the v stands. Returns false when the rest of the view cannot be made out.
bool read_nff_view(NffTokens& tokens, std::size_t offset, Scene& scene, Mistakes& mistakes);

}  // namespace rt
