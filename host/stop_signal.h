// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>

#include "host/render/tile_queue.h"

namespace rt {

/// The number of the signal that asked us to stop (SIGINT, SIGTERM, SIGHUP, or SIGXCPU and SIGUSR1,
/// with which batch systems announce the end; SIGALRM after stop_after), or 0.
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

/// Sends this process SIGALRM after so many seconds.
void stop_after(double seconds);

/// The exit code of a program that was stopped by a signal, by its number.
int exit_code_of_stop(int number);

/// No line on stderr at the first stop signal.
void stop_quietly();

/// Passes stop signals on to the process that `start` returns, from the moment that it is there,
/// instead of heeding them. 0: to none; they are heeded again.
void pass_stop_signals_to(const std::function<pid_t()>& start);

/// The last one that was passed on; 0: none.
int passed_stop_signal();

/// Ends this process as a stop signal would.
[[noreturn]] void end_by_stop_signal(int number);

/// Heeds stop signals of that process alone: a terminal and most batch systems send theirs to all
/// processes of a job, and a second one means to quit at once. The listener gets the exit code
/// when one ends this process; it is called by a signal handler.
void heed_stop_signals_of(pid_t process, void (*listener)(int status));

}  // namespace rt
