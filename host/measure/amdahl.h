// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rt {

/// The share of a one-thread run that more threads can shorten, as the paper measures it (section
/// 5.3): ray trace seconds over total seconds. 0 when nothing was measured.
double parallel_fraction(double trace_seconds, double total_seconds);

/// Amdahl's law: how many times faster `threads` threads can be at most, 1 / ((1 - f) + f / n).
double amdahl_speed_up(double parallel_fraction, int threads);

}  // namespace rt
