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

/// The same in words, for messages: "interrupted (Ctrl-C)", "terminated (SIGTERM)".
std::string stop_reason();

/// Records which stop signals were ignored at startup, and ignores SIGPIPE and SIGXFSZ so that
/// those writes fail with an error we can report. Until install_stop_signals a stop signal ends the
/// program with a message. Call it first.
void prepare_signals();

/// Reinstalls our handlers after a driver replaced them while loading.
void restore_stop_signals();

/// From now on the first stop signal sets the stop flag and, unless quiet, says what happens next;
/// a second SIGINT, SIGTERM or SIGHUP ends the program at once. Signals ignored at startup stay
/// ignored. Call it after OpenCL has started: its runtimes replace existing handlers.
void install_stop_signals();

/// After install_stop_signals: as if this stop signal had come, without a message.
void note_stop(int number);

/// Sends this process SIGALRM after so many seconds.
void stop_after(double seconds);

/// The exit code of a program stopped by this signal number.
int exit_code_of_stop(int number);

/// While one exists with at_once set, a pending or new stop signal ends the program immediately;
/// for writes that may block.
class StopsAtOnce {
   public:
    explicit StopsAtOnce(bool at_once);
    StopsAtOnce(const StopsAtOnce&) = delete;
    StopsAtOnce& operator=(const StopsAtOnce&) = delete;
    ~StopsAtOnce();

   private:
    const bool at_once_;
};

/// Whether to suppress the message at the first stop signal; returns the setting before.
bool stop_quietly(bool quietly = true);

/// Forwards stop signals to the process that `start` returns, from its creation on, instead of
/// handling them, and continues it if it is stopped. If it returns 0, they are handled here again.
void pass_stop_signals_to(const std::function<pid_t()>& start);

/// The last signal forwarded; 0: none.
int passed_stop_signal();

/// Ends this process as this stop signal would.
[[noreturn]] void end_by_stop_signal(int number);

/// Handles stop signals only when `sender` sent them, or its own time limit ran out: terminals and
/// most batch systems signal every process of a job, and a second signal means to quit at once.
/// When SIGXCPU, SIGUSR1 or SIGALRM ends this process, `listener` gets the exit code, in a handler.
void accept_signals_from(pid_t sender, void (*listener)(int status));

}  // namespace rt
