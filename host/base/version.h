// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rt {

/// The project's version ("0.1.0") and the source revision built ("unknown" outside git).
extern const char* const version;
extern const char* const git_revision;

}  // namespace rt
