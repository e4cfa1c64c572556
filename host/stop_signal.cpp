// SPDX-License-Identifier: Apache-2.0
#include "host/stop_signal.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <string_view>

#include "host/console.h"
#include "host/image/temporary_file.h"

namespace rt {

namespace {

struct StopSignal {
    int number;
    const char* reason;
    bool by_hand;  ///< a second one means: at once. A CPU limit sends its signal every second.
    bool ignored = false;
};

StopFlag received = 0;
std::atomic<bool> stops_quietly = false, is_working = false;
std::array<StopSignal, 5> stop_signals{{{SIGINT, "interrupted (Ctrl-C)", true},
                                        {SIGTERM, "terminated (SIGTERM)", true},
                                        {SIGHUP, "hung up (SIGHUP)", true},
                                        {SIGXCPU, "out of CPU time (SIGXCPU)", false},
                                        {SIGUSR1, "asked to stop (SIGUSR1)", false}}};

const StopSignal& of_number(int number) {
    for (const StopSignal& signal : stop_signals) {
        if (signal.number == number) return signal;
    }
    return stop_signals.front();
}

/// For signal handlers, which may not print as others do.
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

/// As if there were no handler, but for batch systems' signals, whose default is a core dump.
void end_by(const StopSignal& signal) {
    unlink_temporaries();
    if (!signal.by_hand) _exit(128 + signal.number);
    std::signal(signal.number, SIG_DFL);
    std::raise(signal.number);
}

void stop_setting_up(int number) {
    const StopSignal& signal = of_number(number);
    write_line(signal.reason, "; nothing is saved");
    end_by(signal);
}

void stop_working(int number) {
    const int saved = errno;
    const StopSignal& signal = of_number(number);
    int none = 0;
    if (received.compare_exchange_strong(none, number)) {
        if (!stops_quietly)
            write_line("stopping, saving what is finished; again to quit at once", "");
    } else if (signal.by_hand) {
        end_by(signal);
    }
    errno = saved;
}

void handle_stop_signals(void (*handler)(int)) {
    for (const StopSignal& signal : stop_signals) {
        struct sigaction action {};
        action.sa_handler = signal.ignored ? SIG_IGN : handler;
        action.sa_flags = SA_RESTART;
        sigaction(signal.number, &action, nullptr);
    }
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
    restore_stop_signals();
}

void restore_stop_signals() { handle_stop_signals(is_working ? stop_working : stop_setting_up); }

void install_stop_signals() {
    is_working = true;
    restore_stop_signals();
}

void stop_quietly() { stops_quietly = true; }

}  // namespace rt
