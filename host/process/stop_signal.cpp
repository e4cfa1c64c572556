// SPDX-License-Identifier: Apache-2.0
#include "host/process/stop_signal.h"

#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <string_view>

#include "host/base/console.h"
#include "host/base/error.h"

namespace rt {

namespace {

struct StopSignal {
    int number;
    const char* reason;
    bool by_hand;  ///< a second one quits at once; a CPU limit's repeats every second
    bool ignored = false;
};

StopFlag received = 0;
std::atomic<bool> stops_quietly = false, is_working = false;
std::atomic<int> stops_at_once = 0;
std::atomic<pid_t> worker = 0, parent = 0;  ///< where to forward signals, and whose to handle
std::atomic<std::int64_t> received_at = 0;  ///< ms
void (*exit_listener)(int status) = nullptr;
std::atomic<int> passed_on = 0;     ///< the last signal forwarded
constexpr std::int64_t echo = 200;  ///< ms; timeout(1) signals the process, then its group
std::array<StopSignal, 6> stop_signals{{{SIGINT, "interrupted (Ctrl-C)", true},
                                        {SIGTERM, "terminated (SIGTERM)", true},
                                        {SIGHUP, "hung up (SIGHUP)", true},
                                        {SIGXCPU, "out of CPU time (SIGXCPU)", false},
                                        {SIGUSR1, "asked to stop (SIGUSR1)", false},
                                        {SIGALRM, "out of time (--timeout)", false}}};

const StopSignal& of_number(int number) {
    for (const StopSignal& signal : stop_signals) {
        if (signal.number == number) return signal;
    }
    return stop_signals.front();
}

/// Async-signal-safe output, for signal handlers.
void write_text(std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
        if (written <= 0) return;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

void write_line(std::string_view a, std::string_view b) {
    if (bar_is_shown()) write_text("\n");
    write_text("mirrorball: ");
    write_text(a);
    write_text(b);
    write_text("\n");
}

/// Ends as if unhandled; batch and time-limit signals exit instead (SIGXCPU would dump core).
[[noreturn]] void end_by(const StopSignal& signal) {
    if (!signal.by_hand) {
        const int status = exit_code_of_stop(signal.number);
        if (exit_listener != nullptr) exit_listener(status);
        _exit(status);
    }
    std::signal(signal.number, SIG_DFL);
    sigset_t own;
    sigemptyset(&own);
    sigaddset(&own, signal.number);
    pthread_sigmask(SIG_UNBLOCK, &own, nullptr);  // we may be in its handler
    std::raise(signal.number);
    _exit(128 + signal.number);
}

[[noreturn]] void end_unsaved(const StopSignal& signal) {
    write_line(signal.reason, "; nothing is saved");
    end_by(signal);
}

/// Forwards stop signals to a worker, which ignores others. Unlike those it is queued: a terminal
/// signals both processes, and two equal signals become one while the first one waits.
int forwarding_signal() { return SIGRTMIN; }

/// The number of the stop signal; 0: it was not meant for us. Time limits apply to each process.
int meant_number(int number, const siginfo_t* info) {
    if (parent == 0 || number == SIGXCPU || number == SIGALRM) return number;
    const bool is_forwarded = number == forwarding_signal() && info->si_pid == parent;
    return is_forwarded ? info->si_value.sival_int : 0;
}

std::int64_t milliseconds_now() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * std::int64_t{1000} + now.tv_nsec / 1000000;
}

void stop_working(const StopSignal& signal) {
    std::int64_t never = 0;
    received_at.compare_exchange_strong(never, milliseconds_now());
    int none = 0;
    if (received.compare_exchange_strong(none, signal.number)) {
        if (!stops_quietly && signal.by_hand) {
            write_line("stopping, saving what is finished; interrupt again to quit at once", "");
        } else if (!stops_quietly) {
            write_line(signal.reason, "; saving what is finished");
        }
    } else if (signal.by_hand && milliseconds_now() - received_at > echo) {
        end_by(signal);
    }
}

void pass_on(int number) {
    passed_on = number;
    sigval value{};
    value.sival_int = number;
    if (const pid_t to = worker; to > 0) {
        ::sigqueue(to, forwarding_signal(), value);
        ::kill(to, SIGCONT);  // one that is stopped would not save anything
    }
}

void handle(int number, siginfo_t* info, void*) {
    const int saved = errno;
    const bool has_worker = worker != 0, works = is_working;
    if (has_worker) pass_on(number);
    number = meant_number(number, info);
    if (number != 0 && (works || !has_worker)) {
        if (!works || stops_at_once > 0) end_unsaved(of_number(number));
        stop_working(of_number(number));
    }
    errno = saved;
}

}  // namespace

const StopFlag& stop_flag() { return received; }

std::string stop_reason() { return of_number(received).reason; }

void prepare_signals() {
    for (StopSignal& signal : stop_signals) {
        struct sigaction action {};
        sigaction(signal.number, nullptr, &action);
        signal.ignored = action.sa_handler == SIG_IGN;
    }
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGCHLD, SIG_DFL);  // ignored, nobody learns how a driver's compiler ended
    restore_stop_signals();
}

void restore_stop_signals() {
    const auto install = [](int number, bool is_ignored) {
        struct sigaction action {};
        if (is_ignored) {
            action.sa_handler = SIG_IGN;
        } else {
            action.sa_sigaction = handle;
        }
        action.sa_flags = SA_RESTART | (is_ignored ? 0 : SA_SIGINFO);
        sigaction(number, &action, nullptr);
    };
    for (const StopSignal& signal : stop_signals) install(signal.number, signal.ignored);
    if (parent != 0) install(forwarding_signal(), false);
}

void install_stop_signals() {
    is_working = true;
    restore_stop_signals();
}

void note_stop(int number) {
    received_at = milliseconds_now();
    received = number;
}

void stop_after(double seconds) {
    itimerval timer{};
    timer.it_value.tv_sec = static_cast<time_t>(seconds);
    timer.it_value.tv_usec =
        static_cast<suseconds_t>(1e6 * (seconds - static_cast<double>(timer.it_value.tv_sec)));
    ::setitimer(ITIMER_REAL, &timer, nullptr);
}

int exit_code_of_stop(int number) {
    return number == SIGALRM ? static_cast<int>(ExitCode::incomplete) : 128 + number;
}

StopsAtOnce::StopsAtOnce(bool at_once) : at_once_(at_once) {
    if (!at_once) return;
    ++stops_at_once;
    if (received != 0) end_unsaved(of_number(received));
}

StopsAtOnce::~StopsAtOnce() { stops_at_once -= at_once_ ? 1 : 0; }

bool stop_quietly(bool quietly) { return stops_quietly.exchange(quietly); }

void pass_stop_signals_to(const std::function<pid_t()>& start) {
    sigset_t stops, before;
    sigemptyset(&stops);
    for (const StopSignal& signal : stop_signals) sigaddset(&stops, signal.number);
    pthread_sigmask(SIG_BLOCK, &stops, &before);
    worker = start();
    passed_on = 0;
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

int passed_stop_signal() { return passed_on; }

void end_by_stop_signal(int number) { end_by(of_number(number)); }

void accept_signals_from(pid_t sender, void (*listener)(int status)) {
    exit_listener = listener;
    parent = sender;
    restore_stop_signals();
}

}  // namespace rt
