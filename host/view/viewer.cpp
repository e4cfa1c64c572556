// SPDX-License-Identifier: Apache-2.0
#include "host/view/viewer.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "host/base/error.h"
#include "host/base/files.h"

namespace rt {

namespace {

const WindowModule& load_windows() {
    return *static_cast<const WindowModule*>(
        load_module({"libmirrorball_sdl.so", WindowModule::current_version, "windows",
                     "--show requires libsdl2-2.0-0, and mirrorball built with libsdl2-dev"},
                    ExitCode::device));
}

std::unique_ptr<Viewer> make_window(const std::string& name, Encoding encoding, const Say& say) {
    const auto encode = [encoding](const Picture& picture, const Rect& part) {
        return encode_8bit(cut(picture, part), encoding);
    };
    try {
        return load_windows().make(name, encode, say);
    } catch (const Error& error) {
        say(std::string("no window: ") + error.what());
        return nullptr;
    }
}

}  // namespace

std::vector<std::unique_ptr<Viewer>> make_viewers(const ViewSettings& settings,
                                                  const std::string& name, Encoding encoding,
                                                  const Say& say, const StopFlag& stop) {
    std::vector<std::unique_ptr<Viewer>> viewers;
    if (settings.tev) viewers.push_back(make_tev_viewer(*settings.tev, name, say, stop));
    if (settings.window) viewers.push_back(make_window(name, encoding, say));
    if (settings.preview) viewers.push_back(make_preview(settings, encoding, say));
    std::erase(viewers, nullptr);
    return viewers;
}

std::string why_no_windows() try {
    load_windows();
    return "";
} catch (const Error& error) {
    return error.what();
}

Picture cut(const Picture& picture, const Rect& part) {
    Picture result{part.width, part.height, 3, {}};
    const auto row = 3 * static_cast<std::ptrdiff_t>(part.width);
    for (int y = part.y; y < part.y + part.height; ++y) {
        const auto from = picture.pixels.begin() + 3 * (std::ptrdiff_t{y} * picture.width + part.x);
        result.pixels.insert(result.pixels.end(), from, from + row);
    }
    return result;
}

namespace {

/// Time between updates: smooth to watch, and cheap.
constexpr std::chrono::milliseconds interval(100);

}  // namespace

LivePicture::LivePicture(std::vector<std::unique_ptr<Viewer>> viewers,
                         std::chrono::milliseconds patience)
    : viewers_(std::move(viewers)),
      patience_(patience),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void LivePicture::begin(int width, int height) {
    const std::scoped_lock lock(mutex_);
    width_ = width;
    height_ = height;
    parts_.clear();
    final_.reset();
    has_begun_ = true;
    is_shown_ = is_over_ = false;
}

void LivePicture::put(const Rect& part, std::vector<float> rgb) {
    const std::scoped_lock lock(mutex_);
    parts_.push_back({part, std::move(rgb)});
}

void LivePicture::add(const Part& part) {
    const Rect& rect = part.rect;
    const auto row = 3 * static_cast<std::ptrdiff_t>(rect.width);
    for (int y = 0; y < rect.height; ++y) {
        const std::ptrdiff_t at = 3 * (std::ptrdiff_t{rect.y + y} * shown_.width + rect.x);
        std::copy_n(part.rgb.begin() + y * row, row, shown_.pixels.begin() + at);
    }
}

void LivePicture::tell(bool begins, const std::vector<Rect>& parts) {
    for (const auto& viewer : viewers_) {
        if (begins) viewer->begin(shown_.width, shown_.height);
        if (!parts.empty()) viewer->update(shown_, parts);
        viewer->tick();
    }
}

bool LivePicture::any_open() const {
    return std::ranges::any_of(viewers_, [](const auto& viewer) { return viewer->is_open(); });
}

void LivePicture::run(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
        const bool begins = std::exchange(has_begun_, false);
        const std::vector<Part> parts = std::exchange(parts_, {});
        std::optional<Picture> last = std::exchange(final_, {});
        if (begins) shown_ = {width_, height_, 3, {}};
        lock.unlock();
        shown_.pixels.resize(3 * static_cast<std::size_t>(shown_.width) * shown_.height);
        std::vector<Rect> changed;
        for (const Part& part : parts) {
            add(part);
            changed.push_back(part.rect);
        }
        tell(begins, changed);
        if (last) show_last(*std::move(last));
        lock.lock();
        if (last && !has_begun_) is_shown_ = true;
        is_over_ = is_shown_ && !any_open();
        changed_.notify_all();
        changed_.wait_for(lock, stop, interval, [this] { return final_.has_value(); });
    }
}

void LivePicture::show_last(Picture picture) {
    const bool has_begun = shown_.width > 0;
    shown_ = std::move(picture);
    for (const auto& viewer : viewers_) {
        if (!has_begun) viewer->begin(shown_.width, shown_.height);
        viewer->finish(shown_);
        viewer->tick();
    }
}

void LivePicture::finish(Picture picture) {
    std::unique_lock lock(mutex_);
    final_ = std::move(picture);
    changed_.notify_all();
    changed_.wait_for(lock, patience_, [this] { return is_shown_; });
}

bool LivePicture::is_over() {
    const std::scoped_lock lock(mutex_);
    return is_over_;
}

}  // namespace rt
