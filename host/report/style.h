// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rt {

/// The page's style sheet: light, dark and print; system fonts; no external resources. Has the
/// plots' classes: s0 to s7 colors, d0 to d7 dashes, p0 to p7 parts of bars.
extern const char* const report_style;

}  // namespace rt
