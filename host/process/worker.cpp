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
#include <climits>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "host/base/files.h"
#include "host/process/stop_signal.h"
#include "host/render/stopwatch.h"

namespace rt {

namespace {

// The worker's messages: one byte each, except that the exit code follows `ended`, and a text that
// ends with a zero `began`.
constexpr char watched = 'w', unwatched = 'u', progressed = 'p', ended = 'e', began = 'b';

constexpr double poll_seconds = 0.2;

/// A driver may compute for ever. Though it is busy, its first progress is overdue after so many
/// deadlines, and any other after so many and this many times the longest wait so far.
constexpr double first_deadlines = 60, later_deadlines = 6, longest_gaps = 10;

/// Processor time that mere waiting may use up within a deadline.
constexpr double idle_seconds = 0.1;

constexpr const char* link_name = "MIRRORBALL_WORKER";

std::atomic<int> link_pipe = -1;
double link_seconds = 0;

void tell(std::string_view bytes) {
    if (link_pipe < 0) return;
    while (::write(link_pipe, bytes.data(), bytes.size()) < 0 && errno == EINTR) {
    }
}

/// A process's state, from /proc.
struct ProcessState {
    bool is_busy = false;  ///< a thread runs, waits for a disk or a child, or is stopped
    double processor_seconds = 0;
};

/// The fields of a stat file, starting at the state.
std::istringstream fields_of(const std::string& file) {
    std::ifstream stream(file);
    std::string text;
    std::getline(stream, text);
    const std::size_t name_end = text.rfind(')');
    return std::istringstream(name_end == text.npos ? "" : text.substr(name_end + 1));
}

ProcessState state_of(pid_t process) {
    ProcessState result;
    const std::string folder = fmt::format("/proc/{}/", process);
    std::istringstream fields = fields_of(folder + "stat");
    std::string skipped;
    for (int i = 0; i < 11; ++i) fields >> skipped;
    double ticks = 0, more = 0;
    for (int i = 0; i < 4; ++i) {  // user and system, its own and of the children that have ended
        if (fields >> more) ticks += more;
    }
    result.processor_seconds = ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
    std::error_code error;
    for (std::filesystem::directory_iterator task(folder + "task", error), end;
         !error && task != end; task.increment(error)) {
        char state = '?';
        fields_of(task->path() / "stat") >> state;
        std::string child;
        std::ifstream(task->path() / "children") >> child;
        result.is_busy |= std::string_view("RDTt").find(state) != std::string_view::npos;
        result.is_busy |= !child.empty();
    }
    return result;
}

/// Detects that a watched process has been idle, or busy without progress, for too long.
class Watchdog {
   public:
    Watchdog(pid_t process, double deadline, double longest, const StopFlag* enough)
        : process_(process), deadline_(deadline), longest_(longest), enough_(enough) {}

    void hear(char byte) {
        if (byte == progressed) {
            longest_gap_ = std::max(longest_gap_, gap_);
            has_progressed_ = true;
        } else {
            is_watched_ = byte == watched;
            longest_gap_ = 0;
            has_progressed_ = false;
        }
        gap_ = idle_ = 0;
    }

    bool is_overdue() const { return total_.seconds() > longest_; }

    /// Call at least every poll_seconds. Time in which this process did not run does not count.
    bool is_late() {
        const double passed = std::min(watch_.lap(), 2 * poll_seconds);
        if (is_overdue() || (enough_ != nullptr && *enough_ != 0)) return true;
        if (!is_watched_) return false;
        gap_ += passed;
        const ProcessState now = state_of(process_);
        const bool has_computed = now.processor_seconds - processor_before_ >= idle_seconds;
        if (now.is_busy || has_computed) {
            idle_ = 0;
            processor_before_ = now.processor_seconds;
        } else {
            idle_ += passed;
        }
        const double longest_busy = has_progressed_
                                        ? later_deadlines * deadline_ + longest_gaps * longest_gap_
                                        : first_deadlines * deadline_;
        return idle_ >= deadline_ || gap_ >= longest_busy;
    }

    /// Since the last progress, or since it was last watched.
    double seconds_without_progress() const { return gap_; }

   private:
    const pid_t process_;
    const double deadline_, longest_;
    const StopFlag* const enough_;  ///< may be null
    const Stopwatch total_;
    Stopwatch watch_;
    bool is_watched_ = false;
    double gap_ = 0, idle_ = 0, processor_before_ = 0;
    bool has_progressed_ = false;
    double longest_gap_ = 0;  ///< without progress
};

std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> result;
    for (std::string& text : texts) result.push_back(text.data());
    result.push_back(nullptr);
    return result;
}

std::vector<std::string> changed_environment(const std::vector<std::string>& changes) {
    std::vector<std::string> variables = changes;
    for (char** variable = environ; *variable != nullptr; ++variable) {
        const std::string_view text = *variable;
        const std::string_view name = text.substr(0, text.find('=') + 1);
        const bool is_changed =
            std::any_of(changes.begin(), changes.end(),
                        [&](const std::string& change) { return change.starts_with(name); });
        if (!is_changed) variables.emplace_back(text);
    }
    return variables;
}

/// Returns 0 if none could be started.
pid_t start(std::vector<std::string> command, const std::vector<std::string>& changes) {
    std::vector<std::string> variables = changed_environment(changes);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    pid_t process = 0;
    const int error = ::posix_spawn(&process, "/proc/self/exe", nullptr, &attributes,
                                    pointers(command).data(), pointers(variables).data());
    posix_spawnattr_destroy(&attributes);
    return error == 0 ? process : 0;
}

bool has_ended(pid_t process) {
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(process), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == process;
}

/// Listens to the worker until it reports its end, is gone, or is late. Returns the exit code it
/// reported, if any.
std::optional<int> listen(int pipe, pid_t process, Watchdog& watchdog, WorkerEnd& end) {
    bool is_end_next = false, is_in_text = false;
    for (;;) {
        const bool is_gone = has_ended(process);  // its last message is in the pipe by then
        pollfd waited{pipe, POLLIN, 0};
        const int patience = is_gone ? 0 : static_cast<int>(1000 * poll_seconds);
        if (::poll(&waited, 1, patience) > 0) {
            char bytes[256];
            const ssize_t got = ::read(pipe, bytes, sizeof(bytes));
            if (got == 0) return std::nullopt;
            for (ssize_t i = 0; i < got; ++i) {
                if (is_end_next) return static_cast<unsigned char>(bytes[i]);
                if (is_in_text) {
                    is_in_text = bytes[i] != '\0';
                    if (is_in_text) end.task += bytes[i];
                    continue;
                }
                is_end_next = bytes[i] == ended;
                is_in_text = bytes[i] == began;
                if (is_in_text) end.task.clear();
                if (!is_end_next && !is_in_text) watchdog.hear(bytes[i]);
            }
            continue;
        }
        if (is_gone) return std::nullopt;
        if (watchdog.is_late()) {
            end.is_hung = true;
            return std::nullopt;
        }
    }
}

std::string name_of_signal(int number) {
    const char* const name = ::sigabbrev_np(number);
    return name != nullptr ? std::string("SIG") + name : "signal " + std::to_string(number);
}

}  // namespace

WorkerEnd run_worker(const std::vector<std::string>& command,
                     const std::vector<std::string>& changes, double deadline,
                     double seconds_before, double longest, const StopFlag* enough) {
    int ends[2];
    WorkerEnd end;
    end.how = "could not be started";
    if (::pipe2(ends, O_CLOEXEC) != 0) return end;
    const FileDescriptor ours(ends[0]);
    FileDescriptor theirs(ends[1]);
    ::fcntl(theirs.number(), F_SETFD, 0);
    std::vector<std::string> all = changes;
    all.push_back(
        fmt::format("{}={},{},{:.6f}", link_name, theirs.number(), ::getpid(), seconds_before));
    pid_t process = 0;
    pass_stop_signals_to([&] { return process = start(command, all); });
    theirs = FileDescriptor();
    if (process == 0) return end;
    Watchdog watchdog(process, deadline, longest, enough);
    const std::optional<int> status = listen(ours.number(), process, watchdog, end);
    if (end.is_hung) ::kill(process, SIGKILL);
    int wait_status = 0;
    while (::waitpid(process, &wait_status, 0) < 0 && errno == EINTR) {
    }
    const int passed = passed_stop_signal();
    pass_stop_signals_to([] { return 0; });
    if (status) {
        end.is_regular = true;
        end.status = *status;
        return end;
    }
    end.stop_signal = passed;
    if (end.is_hung) {
        end.how = watchdog.is_overdue() ? "did not end in time"
                                        : fmt::format("made no progress for {:.0f} s",
                                                      watchdog.seconds_without_progress());
    } else if (WIFSIGNALED(wait_status)) {
        end.how = "was killed by " + name_of_signal(WTERMSIG(wait_status));
    } else {
        end.how = fmt::format("ended with exit code {}", WEXITSTATUS(wait_status));
    }
    return end;
}

bool become_worker(const std::string& link) {
    int pipe = -1;
    pid_t parent = 0;
    if (std::sscanf(link.c_str(), "%d,%d,%lf", &pipe, &parent, &link_seconds) != 3) return false;
    ::unsetenv(link_name);
    if (::fcntl(pipe, F_SETFD, FD_CLOEXEC) != 0) return false;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::prctl(PR_SET_NAME, "mirrorball");     // not "exe"
    if (::getppid() != parent) ::_exit(1);  // it has already ended
    link_pipe = pipe;
    heed_stop_signals_of(parent, note_worker_end);
    return true;
}

bool is_worker() { return link_pipe >= 0; }

double seconds_before_worker() { return link_pipe < 0 ? 0 : link_seconds; }

void watch_worker(bool is_watched) { tell({is_watched ? &watched : &unwatched, 1}); }

void note_worker_task(const std::string& task) {
    tell(began + task.substr(0, PIPE_BUF - 2) + '\0');  // at once, or not among other messages
}

/// Sends at most ten messages a second, so that the pipe never fills up.
void note_worker_progress() {
    static const Stopwatch watch;
    static std::atomic<std::int64_t> last = -1;
    const auto now = static_cast<std::int64_t>(10 * watch.seconds());
    if (last.exchange(now) != now) tell({&progressed, 1});
}

WorkerTask::WorkerTask(const std::string& task, bool is_driver) {
    note_worker_task(task);
    watch_worker(is_driver);
}

WorkerTask::~WorkerTask() { watch_worker(false); }

void note_worker_end(int status) {
    const char bytes[2] = {ended, static_cast<char>(status)};
    tell({bytes, 2});
}

}  // namespace rt
