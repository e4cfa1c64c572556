// SPDX-License-Identifier: Apache-2.0
#include "host/measure/amdahl.h"

namespace rt {

double parallel_fraction(double trace_seconds, double total_seconds) {
    return total_seconds > 0 ? trace_seconds / total_seconds : 0;
}

double amdahl_speed_up(double parallel_fraction, int threads) {
    return 1 / ((1 - parallel_fraction) + parallel_fraction / threads);
}

}  // namespace rt
