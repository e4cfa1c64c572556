// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/render/tile_queue.h"

namespace rt {

/// The number of the signal that asked us to stop, SIGINT or SIGTERM, or 0.
const StopFlag& stop_flag();

/// From now on SIGINT and SIGTERM set the stop flag; a second one ends the program at once. Call it
/// after OpenCL has started: its runtimes replace handlers that were there before them.
void install_stop_signals();

/// Lets writes to closed pipes and past file limits fail as calls, with an error we can report.
void ignore_write_signals();

}  // namespace rt
