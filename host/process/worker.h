// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

// OpenCL drivers crash and hang, taking the process that loaded them with them. So the program
// starts itself again as a worker process that loads them, and watches it through a pipe.
namespace rt {

/// What to run in a worker.
struct WorkerCommand {
    std::vector<std::string> arguments;                        ///< of the program, its name first
    std::string drivers{};                                     ///< its OCL_ICD_VENDORS; empty: ours
    double deadline = 10;                                      ///< seconds without progress
    double seconds_before = 0;                                 ///< since this process began
    double longest = std::numeric_limits<double>::infinity();  ///< seconds it may take in all
    std::function<void(const std::string& record)> told{};     ///< called for each record at once
};

/// How a worker ended.
struct WorkerEnd {
    bool is_started = false;
    bool is_regular = false;  ///< it reported its exit itself, with this status
    int status = 0;           ///< exit code
    int stop_signal = 0;      ///< signal that it should have ended by, as should this process
    std::string how;          ///< otherwise: "was killed by SIGABRT", "did not end in time"
    std::string task;         ///< what a driver was doing
    std::vector<std::string> records;  ///< what it told with tell_parent

    bool has_failed() const { return !is_regular && stop_signal == 0; }
};

/// Runs the program again and waits. Stop signals are forwarded to the worker; one that ends it at
/// once ends this process, too. While a driver works there, it counts as hung after `deadline`
/// seconds in which neither it nor its children computed, or 60 times as many in which they did,
/// without progress. A worker that is hung, or takes longer than `longest`, is killed with its
/// children. Throws what `told` throws: then end this process, and the worker ends with it.
WorkerEnd run_worker(const WorkerCommand& command);

/// Ends this process as its worker ended, if a stop signal ended that.
void end_if_stopped(const WorkerEnd& end);

/// Makes this process a worker, which dies with its parent, if environment variable
/// MIRRORBALL_WORKER has a valid link to it. Call it first: it sets the worker's drivers, too.
void become_worker();

bool is_worker();

/// In a worker, the seconds that passed before it was started; else 0.
double seconds_before_worker();

// Called by a worker, no-ops in other processes; all but the first may be called by any thread.
void watch_worker(const std::string& task);   ///< what a driver does from now on; "": nothing
void tell_parent(const std::string& record);  ///< whole, or not at all
void note_worker_progress();
void note_worker_end(int status);  ///< just before it exits; async-signal-safe

/// Names a task of a driver, or "", until destroyed.
class DriverTask {
   public:
    explicit DriverTask(const std::string& task) { watch_worker(task); }
    DriverTask(const DriverTask&) = delete;
    DriverTask& operator=(const DriverTask&) = delete;
    ~DriverTask() { watch_worker(""); }
};

}  // namespace rt
