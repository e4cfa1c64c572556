// SPDX-License-Identifier: Apache-2.0
#include "host/image/modules/exr_threads.h"

#include <ImfThreading.h>

#include <algorithm>
#include <exception>
#include <thread>

namespace rt {
namespace {

bool start(int count) {
    try {
        Imf::setGlobalThreadCount(count);
        return true;
    } catch (const std::exception&) {
        return false;
    }
}

}  // namespace

ExrThreads::ExrThreads(int rows) {
    constexpr int rows_per_thread = 64;  // four blocks of rows, which are compressed as one
    const int cores = static_cast<int>(std::thread::hardware_concurrency());
    const int count = std::min(cores, rows / rows_per_thread);
    if (count > 1 && start(count)) count_ = count;
}

ExrThreads::~ExrThreads() {
    if (count_ > 0) start(0);
}

}  // namespace rt
