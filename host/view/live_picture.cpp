// SPDX-License-Identifier: Apache-2.0
#include "host/view/live_picture.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <utility>

namespace rt {

namespace {

/// Between two updates: smooth to watch, and little to do.
constexpr std::chrono::milliseconds interval(100);

std::size_t place(const Picture& picture, int x, int y) {
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                static_cast<std::size_t>(x));
}

void copy_part(const Picture& from, const Rect& part, Picture& to) {
    for (int y = part.y; y < part.y + part.height; ++y) {
        const std::size_t at = place(from, part.x, y);
        std::copy_n(from.pixels.begin() + static_cast<std::ptrdiff_t>(at), 3 * part.width,
                    to.pixels.begin() + static_cast<std::ptrdiff_t>(at));
    }
}

}  // namespace

LivePicture::LivePicture(std::vector<std::unique_ptr<Viewer>> viewers)
    : viewers_(std::move(viewers)), thread_([this] { run(); }) {}

void LivePicture::begin(int width, int height) {
    const std::scoped_lock lock(mutex_);
    picture_ = {width, height, 3, {}};
    picture_.pixels.resize(place(picture_, 0, height));
    parts_.clear();
    has_begun_ = true;
    changed_.notify_all();
}

void LivePicture::put(const Rect& part, std::span<const float> rgb) {
    const std::scoped_lock lock(mutex_);
    const auto row = static_cast<std::size_t>(3 * part.width);
    for (int y = 0; y < part.height; ++y) {
        const auto from = rgb.subspan(static_cast<std::size_t>(y) * row, row);
        std::copy(from.begin(), from.end(),
                  picture_.pixels.begin() +
                      static_cast<std::ptrdiff_t>(place(picture_, part.x, part.y + y)));
    }
    parts_.push_back(part);
    changed_.notify_all();
}

void LivePicture::tell(bool begins, const std::vector<Rect>& parts) {
    for (const auto& viewer : viewers_) {
        if (begins) viewer->begin(shown_.width, shown_.height);
        if (!parts.empty()) viewer->update(shown_, parts);
        viewer->tick();
    }
}

bool LivePicture::any_open() const {
    return std::any_of(viewers_.begin(), viewers_.end(),
                       [](const auto& viewer) { return viewer->is_open(); });
}

void LivePicture::run() {
    std::unique_lock lock(mutex_);
    while (!is_done_ && final_ == nullptr) {
        const bool begins = std::exchange(has_begun_, false);
        const std::vector<Rect> parts = std::exchange(parts_, {});
        if (begins) shown_ = picture_;
        for (const Rect& part : parts) copy_part(picture_, part, shown_);
        lock.unlock();
        tell(begins, parts);
        lock.lock();
        changed_.wait_for(lock, interval, [this] { return is_done_ || final_ != nullptr; });
    }
    if (final_ != nullptr) {
        const bool begins = has_begun_ || picture_.width == 0;
        for (const auto& viewer : viewers_) {
            if (begins) viewer->begin(final_->width, final_->height);
            viewer->finish(*final_);
        }
        is_shown_ = true;
        changed_.notify_all();
    }
    while (!is_done_ && any_open()) {
        tell(false, {});
        changed_.wait_for(lock, interval, [this] { return is_done_; });
    }
    is_done_ = true;
    changed_.notify_all();
}

LivePicture::~LivePicture() {
    {
        const std::scoped_lock lock(mutex_);
        is_done_ = true;
        changed_.notify_all();
    }
    thread_.join();
}

void LivePicture::finish(const Picture& picture) {
    std::unique_lock lock(mutex_);
    final_ = &picture;
    changed_.notify_all();
    changed_.wait(lock, [this] { return is_shown_; });
}

void LivePicture::wait(const std::function<bool()>& is_stopped) {
    std::unique_lock lock(mutex_);
    while (!is_done_ && !is_stopped()) changed_.wait_for(lock, interval);
}

}  // namespace rt
