// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/render/tile_queue.h"

namespace rt {

/// The number of the signal that asked us to stop (SIGINT, SIGTERM or SIGHUP), or 0.
const StopFlag& stop_flag();

/// Notes which stop signals we were started to ignore, and lets writes to closed pipes and past
/// file limits fail as calls, with an error we can report. Call it first.
void prepare_signals();

/// From now on the stop signals set the stop flag, but for those we were started to ignore; a
/// second one ends the program at once. Call it after OpenCL has started: its runtimes replace
/// handlers that were there before them.
void install_stop_signals();

}  // namespace rt
