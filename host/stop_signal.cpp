// SPDX-License-Identifier: Apache-2.0
#include "host/stop_signal.h"

#include <array>
#include <csignal>

namespace rt {

namespace {

struct StopSignal {
    int number;
    bool ignored;
};

volatile std::sig_atomic_t received = 0;
std::array<StopSignal, 3> stop_signals{{{SIGINT, false}, {SIGTERM, false}, {SIGHUP, false}}};

void remember(int signal) {
    received = signal;
    std::signal(signal, SIG_DFL);
}

}  // namespace

const StopFlag& stop_flag() { return received; }

void prepare_signals() {
    for (StopSignal& signal : stop_signals) {
        struct sigaction action {};
        sigaction(signal.number, nullptr, &action);
        signal.ignored = action.sa_handler == SIG_IGN;
    }
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

void install_stop_signals() {
    for (const StopSignal& signal : stop_signals) {
        struct sigaction action {};
        action.sa_handler = signal.ignored ? SIG_IGN : remember;
        action.sa_flags = SA_RESTART;
        sigaction(signal.number, &action, nullptr);
    }
}

}  // namespace rt
