// SPDX-License-Identifier: Apache-2.0
#include "host/process/worker.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string_view>
#include <system_error>

#include "host/base/files.h"
#include "host/base/parallel.h"
#include "host/base/text.h"
#include "host/process/stop_signal.h"

namespace rt {

namespace {

// A worker's messages are a letter and a text, which a zero ends.
constexpr char is_doing = 't', progressed = 'p', told = 'r', ended = 'e';

constexpr double poll_seconds = 0.2;

/// A driver may never finish: even while busy, its progress is due within so many deadlines.
constexpr double busy_deadlines = 60;

/// Processor time that mere waiting may use up within a deadline.
constexpr double idle_seconds = 0.1;

constexpr const char* link_name = "MIRRORBALL_WORKER";

std::atomic<int> link_pipe = -1;
double link_seconds = 0;

/// Async-signal-safe.
void send(std::string_view message) {
    while (link_pipe >= 0 && !message.empty()) {
        const ssize_t sent = ::write(link_pipe, message.data(), message.size());
        if (sent < 0 && errno != EINTR) return;
        if (sent > 0) message.remove_prefix(static_cast<std::size_t>(sent));
    }
}

/// Not in pieces, between which another thread's message could come.
void send_whole(std::string_view message) {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    send(message);
}

/// A process and all its descendants, such as a driver's compiler and linker.
struct ProcessTree {
    std::vector<pid_t> processes;
    bool is_busy = false;  ///< a thread runs, waits for a disk, or is stopped
    double processor_seconds = 0;
};

void add_process(ProcessTree& tree, pid_t process) {
    tree.processes.push_back(process);
    const std::string folder = fmt::format("/proc/{}/", process);
    std::istringstream fields = stat_fields(folder + "stat");
    std::string skipped;
    for (int i = 0; i < 11; ++i) fields >> skipped;
    double ticks = 0;
    for (int i = 0; i < 4 && fields >> ticks; ++i) {  // its own, and of children that have ended
        tree.processor_seconds += ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
    }
    std::error_code error;
    for (std::filesystem::directory_iterator task(folder + "task", error), end;
         !error && task != end; task.increment(error)) {
        char state = '?';
        stat_fields(task->path() / "stat") >> state;
        tree.is_busy |= std::string_view("RDTt").find(state) != std::string_view::npos;
        std::ifstream children(task->path() / "children");
        for (pid_t child = 0; children >> child;) add_process(tree, child);
    }
}

ProcessTree tree_of(pid_t process) {
    ProcessTree tree;
    add_process(tree, process);
    return tree;
}

/// Detects that a worker takes too long, or its driver makes no progress.
class Watchdog {
   public:
    Watchdog(pid_t process, const WorkerCommand& command)
        : process_(process), deadline_(command.deadline), longest_(command.longest) {}

    /// From now on, and from the last progress on, time counts.
    void watch(bool is_watched) {
        is_watched_ = is_watched;
        waited_ = idle_ = 0;
    }
    void note_progress() { waited_ = idle_ = 0; }

    /// Empty, or why it should be killed. Time in which this process did not run does not count.
    std::string complaint() {
        const double passed = std::min(watch_.lap(), 2 * poll_seconds);
        if (total_.seconds() > longest_) return "did not end in time";
        if (!is_watched_) return "";
        waited_ += passed;
        const ProcessTree now = tree_of(process_);
        const bool has_computed = now.processor_seconds - processor_before_ >= idle_seconds;
        idle_ = now.is_busy || has_computed ? 0 : idle_ + passed;
        if (idle_ == 0) processor_before_ = now.processor_seconds;
        if (idle_ < deadline_ && waited_ < busy_deadlines * deadline_) return "";
        return fmt::format("made no progress for {:.0f} s", idle_ < deadline_ ? waited_ : idle_);
    }

   private:
    const pid_t process_;
    const double deadline_, longest_;
    const Stopwatch total_;
    Stopwatch watch_;
    bool is_watched_ = false;
    double waited_ = 0, idle_ = 0;  ///< seconds without progress, and without computing
    double processor_before_ = 0;
};

/// Returns 0, and says how, if none could be started.
pid_t start(std::vector<std::string> command, std::string& how) {
    std::vector<char*> arguments;
    for (std::string& argument : command) arguments.push_back(argument.data());
    arguments.push_back(nullptr);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    pid_t process = 0;
    constexpr const char* own = "/proc/self/exe";
    const int error = ::posix_spawn(&process, own, nullptr, &attributes, arguments.data(), environ);
    posix_spawnattr_destroy(&attributes);
    if (error != 0) how = fmt::format("could not be started ({}: {})", own, std::strerror(error));
    return error == 0 ? process : 0;
}

bool has_ended(pid_t process) {
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(process), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == process;
}

void hear(std::string_view message, const WorkerCommand& command, Watchdog& watchdog,
          WorkerEnd& end) {
    const std::string text(message.substr(1));
    switch (message.front()) {
        case is_doing:
            end.task = text;
            return watchdog.watch(!text.empty());
        case progressed:
            return watchdog.note_progress();
        case told:
            if (command.told) command.told(text);
            return end.records.push_back(text);
        case ended:
            end.is_regular = true;
            std::from_chars(text.data(), text.data() + text.size(), end.status);
    }
}

/// Listens to the worker until it reports its end, is gone, or is killed.
void listen(int pipe, pid_t process, const WorkerCommand& command, WorkerEnd& end) {
    Watchdog watchdog(process, command);
    std::string unread;
    while (!end.is_regular) {
        const bool is_gone = has_ended(process);  // its last message is in the pipe by then
        pollfd waited{pipe, POLLIN, 0};
        const int patience = is_gone ? 0 : static_cast<int>(1000 * poll_seconds);
        if (::poll(&waited, 1, patience) > 0) {
            char bytes[4096];
            const ssize_t got = ::read(pipe, bytes, sizeof(bytes));
            if (got == 0) return;
            if (got > 0) unread.append(bytes, static_cast<std::size_t>(got));
            for (std::size_t zero; (zero = unread.find('\0')) != unread.npos;) {
                hear(std::string_view(unread).substr(0, zero), command, watchdog, end);
                unread.erase(0, zero + 1);
            }
        } else if (is_gone) {
            return;
        }
        end.how = end.is_regular ? "" : watchdog.complaint();
        if (end.how.empty()) continue;
        for (const pid_t one : tree_of(process).processes) ::kill(one, SIGKILL);
        return;
    }
}

std::string name_of_signal(int number) {
    const char* const name = ::sigabbrev_np(number);
    return name != nullptr ? std::string("SIG") + name : "signal " + std::to_string(number);
}

}  // namespace

WorkerEnd run_worker(const WorkerCommand& command) {
    int ends[2];
    WorkerEnd end;
    if (::pipe2(ends, O_CLOEXEC) != 0) {
        end.how = "could not be started (no pipe)";
        return end;
    }
    const FileDescriptor ours(ends[0]);
    FileDescriptor theirs(ends[1]);
    ::fcntl(theirs.number(), F_SETFD, 0);
    const std::string link = fmt::format("{},{},{:.6f},{}", theirs.number(), ::getpid(),
                                         command.seconds_before, command.drivers);
    pid_t process = 0;
    ::setenv(link_name, link.c_str(), 1);
    pass_stop_signals_to([&] { return process = start(command.arguments, end.how); });
    ::unsetenv(link_name);
    theirs = FileDescriptor();
    if (process == 0) return end;
    end.is_started = true;
    listen(ours.number(), process, command, end);
    int wait_status = 0;
    while (::waitpid(process, &wait_status, 0) < 0 && errno == EINTR) {
    }
    const int passed = passed_stop_signal();
    pass_stop_signals_to([] { return 0; });
    if (end.is_regular) return end;
    if (WIFSIGNALED(wait_status) && WTERMSIG(wait_status) == passed) end_by_stop_signal(passed);
    end.stop_signal = passed;
    if (!end.how.empty()) return end;
    end.how = WIFSIGNALED(wait_status)
                  ? "was killed by " + name_of_signal(WTERMSIG(wait_status))
                  : fmt::format("ended with exit code {}", WEXITSTATUS(wait_status));
    return end;
}

void end_if_stopped(const WorkerEnd& end) {
    const int number = end.is_regular ? end.status - 128 : end.stop_signal;
    if (number > 0) end_by_stop_signal(number);
}

void become_worker() {
    const std::string link = environment(link_name);
    int pipe = -1, drivers = 0;
    pid_t parent = 0;
    const int found =
        std::sscanf(link.c_str(), "%d,%d,%lf,%n", &pipe, &parent, &link_seconds, &drivers);
    ::unsetenv(link_name);
    if (found != 3 || drivers == 0 || ::fcntl(pipe, F_SETFD, FD_CLOEXEC) != 0) return;
    const char* const place = link.c_str() + drivers;
    if (*place != '\0') ::setenv("OCL_ICD_VENDORS", place, 1);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::prctl(PR_SET_NAME, "mirrorball");     // not "exe"
    if (::getppid() != parent) ::_exit(1);  // it has already ended
    link_pipe = pipe;
    accept_signals_from(parent, note_worker_end);
}

bool is_worker() { return link_pipe >= 0; }

double seconds_before_worker() { return link_pipe < 0 ? 0 : link_seconds; }

void watch_worker(const std::string& task) { send_whole(is_doing + task + '\0'); }

void tell_parent(const std::string& record) { send_whole(told + record + '\0'); }

/// Sends at most ten messages a second, so that the pipe never fills up.
void note_worker_progress() {
    static const Stopwatch watch;
    static std::atomic<std::int64_t> last = -1;
    const auto now = static_cast<std::int64_t>(10 * watch.seconds());
    if (last.exchange(now) != now) send_whole({"p", 2});
}

void note_worker_end(int status) {
    char message[8] = {ended};
    const char* const end = std::to_chars(message + 1, std::end(message) - 1, status).ptr;
    send({message, static_cast<std::size_t>(end - message) + 1});
}

}  // namespace rt
