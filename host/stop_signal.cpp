// SPDX-License-Identifier: Apache-2.0
#include "host/stop_signal.h"

#include <csignal>

namespace rt {

namespace {

volatile std::sig_atomic_t stop_signal = 0;

void remember(int signal) {
    stop_signal = signal;
    std::signal(signal, SIG_DFL);
}

}  // namespace

const StopFlag& stop_flag() { return stop_signal; }

void install_stop_signals() {
    for (const int signal : {SIGINT, SIGTERM}) {
        struct sigaction action {};
        action.sa_handler = remember;
        action.sa_flags = SA_RESTART;
        sigaction(signal, &action, nullptr);
    }
}

void ignore_write_signals() {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace rt
