// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

namespace rt {

/// Calls `say`, on a separate thread, unless destroyed within `patience`: for steps that are
/// usually short.
class LateMessage {
   public:
    LateMessage(std::chrono::milliseconds patience, std::function<void()> say)
        : thread_([patience, say = std::move(say)](const std::stop_token& stop) {
              std::mutex mutex;
              std::condition_variable_any wake;
              std::unique_lock lock(mutex);
              const auto is_over = [&stop] { return stop.stop_requested(); };
              if (!wake.wait_for(lock, stop, patience, is_over)) say();
          }) {}

   private:
    std::jthread thread_;
};

}  // namespace rt
