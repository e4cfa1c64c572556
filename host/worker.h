// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

// OpenCL drivers crash and hang, and they end the process that loaded them. So the program runs
// itself once more, as a worker that loads them, and watches it. A pipe says how the worker does.
namespace rt {

/// How a worker ended.
struct WorkerEnd {
    bool is_regular = false;  ///< by its own main, with this status
    int status = 0;           ///< exit code
    bool is_hung = false;     ///< it was ended, since it did nothing
    int stop_signal = 0;      ///< that it ended by, and this process should
    std::string how;          ///< otherwise: "was ended by SIGABRT", "did nothing for 10 s"
};

/// Runs the program again with the same arguments and these changes of the environment
/// ("NAME=value"), and waits. Stop signals go on to the worker. It counts as hung, and is killed,
/// after `deadline` seconds under watch without progress or processor time. Where no process can be
/// started `how` says so. `seconds_before`: what has passed since this process began.
WorkerEnd run_worker(const std::vector<std::string>& command,
                     const std::vector<std::string>& changes, double deadline,
                     double seconds_before);

/// Whether this process is a worker, which `link` says: the environment's MIRRORBALL_WORKER. From
/// then on it ends with the process that started it. Call it before any thread has started.
bool become_worker(const std::string& link);

bool is_worker();

/// Of a worker what had passed before it was started; else 0.
double seconds_before_worker();

// Called by a worker, without effect in other processes; the last two may be called by any thread.
void watch_worker(bool is_watched);  ///< whether it is to do something all the time
void note_worker_progress();
void note_worker_end(int status);  ///< just before it exits

}  // namespace rt
