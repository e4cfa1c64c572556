// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rt {

/// kernels/render.cl with its includes, embedded at build time (host/embed_kernels.cpp).
extern const char* const render_kernels;

}  // namespace rt
