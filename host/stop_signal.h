// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>

#include "host/render/tile_queue.h"

namespace rt {

/// The number of the signal that asked us to stop (SIGINT, SIGTERM, SIGHUP, or SIGXCPU and SIGUSR1,
/// with which batch systems announce the end), or 0.
const StopFlag& stop_flag();

/// What it was, for messages: "interrupted (Ctrl-C)", "terminated (SIGTERM)".
std::string stop_reason();

/// Notes which stop signals we were started to ignore, and lets writes to closed pipes and past
/// file limits fail as calls, with an error we can report. Until install_stop_signals a stop signal
/// ends the program, with a line that says so. Call it first.
void prepare_signals();

/// Puts the handlers back that a driver replaced while it was loaded.
void restore_stop_signals();

/// From now on the first stop signal sets the stop flag and says what happens next, unless `quiet`;
/// a second SIGINT, SIGTERM or SIGHUP ends the program at once. Signals that we were started to
/// ignore stay ignored. Call it after OpenCL has started: its runtimes replace handlers that were
/// there before them.
void install_stop_signals();

/// No line on stderr at the first stop signal.
void stop_quietly();

/// Has `start` start a process, and from then on passes stop signals on to it instead of heeding
/// them. Returns what `start` does; 0: there is no process.
pid_t pass_stop_signals_to(const std::function<pid_t()>& start);

/// Ends that. Where one was passed on, and the process has not ended in order, ends this one by it,
/// too.
void pass_stop_signals_to_nobody(bool has_ended_in_order);

/// Heeds stop signals of that process alone: a terminal and most batch systems send theirs to all
/// processes of a job, and a second one means to quit at once.
void heed_stop_signals_of(pid_t process);

}  // namespace rt
