// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/flatten/flat_scene.h"

namespace embree_bench {

/// What the kernels of kernels/ do to reals while they render the flat scene's picture, one ray at
/// a time: + - * / and sqrt count one, a multiply-add two; comparisons, choices, conversions and
/// signs nothing. What is the same for all rays (a radius squared) is not counted either. So it is
/// what the rays need one by one; a packet does more. Throws std::runtime_error when the picture it
/// was counted on is not the pthreads renderer's, bit for bit.
std::int64_t kernel_flops(const rt::FlatScene<float>& flat, int threads);

}  // namespace embree_bench
