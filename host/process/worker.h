// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "host/process/stop_signal.h"

// OpenCL drivers crash and hang, taking the process that loaded them with them. So the program
// starts itself again as a worker process that loads them, and watches it through a pipe.
namespace rt {

/// How a worker ended.
struct WorkerEnd {
    bool is_regular = false;  ///< it reported its exit itself, with this status
    int status = 0;           ///< exit code
    bool is_hung = false;     ///< killed because it made no progress or took too long
    int stop_signal = 0;      ///< signal that ended it, and should end this process
    std::string how;          ///< otherwise: "was killed by SIGABRT", "made no progress for 10 s"
    std::string task;         ///< what it was doing, if it said so
};

/// Runs the program again with the same arguments and these environment changes ("NAME=value"), and
/// waits. Stop signals are forwarded to the worker. While watched, it counts as hung and is killed
/// after `deadline` seconds without progress or processor time; when it is busy but its first
/// progress takes 60 times `deadline`, or a later one 6 times `deadline` and ten times as long as
/// any before; or when `longest` seconds have passed. If no process can be started, `how` says so.
/// `seconds_before`: time since this process began. It is also killed when `enough` is set.
WorkerEnd run_worker(const std::vector<std::string>& command,
                     const std::vector<std::string>& changes, double deadline,
                     double seconds_before,
                     double longest = std::numeric_limits<double>::infinity(),
                     const StopFlag* enough = nullptr);

/// Makes this process a worker if `link` (environment variable MIRRORBALL_WORKER) is valid, and
/// returns whether it is. It then dies with its parent. Call it before any thread has started.
bool become_worker(const std::string& link);

bool is_worker();

/// In a worker, the seconds that passed before it was started; else 0.
double seconds_before_worker();

// Called by a worker, no-ops in other processes; the last two may be called by any thread.
void watch_worker(bool is_watched);  ///< whether it should be busy all the time
void note_worker_task(const std::string& task);
void note_worker_progress();
void note_worker_end(int status);  ///< just before it exits

/// Names the task of a worker and, if a driver does it, has it watched, until destroyed.
class WorkerTask {
   public:
    WorkerTask(const std::string& task, bool is_driver);
    WorkerTask(const WorkerTask&) = delete;
    WorkerTask& operator=(const WorkerTask&) = delete;
    ~WorkerTask();
};

}  // namespace rt
