// SPDX-License-Identifier: Apache-2.0
#include "host/base/low_priority.h"

#include <sys/resource.h>
#include <unistd.h>

#include <future>
#include <thread>

namespace rt {

namespace {

constexpr int niceness = 5;

}  // namespace

void run_at_low_priority(const std::function<void()>& work) {
    std::packaged_task<void()> task([&] {
        setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), niceness);
        work();
    });
    std::thread thread(std::ref(task));
    thread.join();
    task.get_future().get();
}

}  // namespace rt
