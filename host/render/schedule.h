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
constexpr auto& enum_names(Schedule) { return schedule_names; }
inline const char* to_string(Schedule schedule) { return name_of(schedule_names, schedule); }

}  // namespace rt
