// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/base/text.h"

namespace rt {

/// How the threads of the pthreads renderer share the work.
enum class Schedule {
    tiles,    ///< threads take tiles from a shared counter
    buffers,  ///< the paper's: a thread renders whole sample buffers, averaged at the end
};

inline constexpr Named<Schedule> schedule_names[] = {{"tiles", Schedule::tiles},
                                                     {"buffers", Schedule::buffers}};

}  // namespace rt
