// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rt {

/// Of the project ("0.1.0"), and of the source this was built from ("unknown" outside git).
extern const char* const version;
extern const char* const git_revision;

}  // namespace rt
