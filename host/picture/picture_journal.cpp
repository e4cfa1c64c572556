// SPDX-License-Identifier: Apache-2.0
#include "host/picture/picture_journal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/base/text.h"
#include "host/base/version.h"
#include "host/opencl/cl_renderer.h"
#include "host/picture/crew.h"

namespace rt {

namespace {

std::string host_name() {
    char name[256] = "";
    return ::gethostname(name, sizeof(name) - 1) == 0 ? name : "";
}

}  // namespace

template <typename T>
PictureJournal<T>::PictureJournal(const RenderSettings& settings, const RenderStats& stats,
                                  const FlatScene<T>& scene,
                                  const std::vector<DeviceChoice>& devices, Say say)
    : settings_(settings),
      scene_(scene),
      aa_(stats.picture.aa),
      region_(stats.picture.region),
      say_(std::move(say)) {
    blocks_ = settings.shares ? shared_blocks(*settings.shares, region_) : std::vector{region_};
    if (settings.journal.empty()) return;
    if (settings.math == Math::fast || settings.schedule != Schedule::tiles) return;
    header_.picture = stats.picture;
    header_.shares = to_string(settings.shares.value_or(Shares{}));
    header_.scene = stats.scene.name;
    header_.scene_hash = hash_text(stats.scene.hash);
    header_.inexact_devices = inexact_names(devices);
    header_.writer = joined_names(devices) + " on " + host_name();
    header_.key = key();
    open();
}

/// Hashes all that the film's bits depend on: the scene, how it is sampled, and the program. Not on
/// hierarchies, which also order the flat scene's arrays.
template <typename T>
std::uint64_t PictureJournal<T>::key() const {
    Hasher hasher;
    hasher.add(std::string_view(version));
    hasher.add(std::string_view(render_kernels));
    hasher.add(sizeof(T));
    hasher.add(std::string_view(header_.scene_hash));
    auto params = scene_.params;
    params.sphere_root = params.cone_root = params.triangle_root = 0;
    hasher.add_bytes(std::as_bytes(std::span(&params, 1)));
    hasher.add(std::string_view(to_string(aa_)));
    hasher.add(aa_.threshold);
    for (const int number : {region_.x, region_.y, region_.width, region_.height}) {
        hasher.add(number);
    }
    return hasher.value();
}

/// Checks what file exists, and resumes from it if it is of this picture.
template <typename T>
void PictureJournal<T>::open() {
    file_ = std::make_shared<JournalFile>(settings_.journal);
    const std::string& path = file_->path();
    using Found = JournalFile::Found;
    if (file_->found() == Found::something_else) {
        if (settings_.shares) {
            throw Error(ExitCode::output,
                        path + ": is not a journal or cannot be written; choose another file");
        }
        say_(path + ": is not a mirrorball journal; finished tiles are not saved");
        file_.reset();
        return;
    }
    if (file_->found() == Found::journal) read();
    const bool is_foreign = !settings_.fresh && !is_ours_ && file_->found() != Found::nothing;
    if (is_foreign && settings_.shares) {
        throw Error(ExitCode::output, path +
                                          ": belongs to a different picture, share or version; "
                                          "choose another file, or replace it with --fresh");
    }
    if (is_foreign) {
        say_(
            path +
            ": belongs to a different picture or version, or to different settings; starting over");
    }
    if (settings_.fresh && is_ours_) file_->remove();
    if (!known_) file_->restart(journal_start(header_));
}

template <typename T>
void PictureJournal<T>::read() {
    std::uint64_t damaged_bytes = 0;
    const auto read_if_ours = [&](JournalReader& reader) {
        const JournalHeader& header = reader.header();
        if (header.shares != header_.shares || header.picture.region != region_) return;
        is_ours_ = header.key == header_.key;
        if (!is_ours_ || settings_.fresh) return;
        if (header.inexact_devices != header_.inexact_devices) {
            return say_(file_->path() + " is by " + header.writer +
                        ", which may round differently; starting over");
        }
        known_ = read_known_pixels<T>(reader);
        damaged_bytes = reader.bytes() - reader.good_bytes();
    };
    try {
        file_->read(read_if_ours);
    } catch (const DamagedJournal&) {
        is_ours_ = true;  // nobody can resume it
        if (!settings_.fresh) say_(file_->path() + ": its start is damaged; starting over");
    } catch (const Error& error) {
        if (error.exit_code() != ExitCode::input) throw;  // otherwise it is of another version
    }
    if (!known_) return;
    const std::string damage = damaged_bytes == 0 ? ""
                                                  : fmt::format("; ignored its damaged end ({})",
                                                                counted(damaged_bytes, "byte"));
    say_(fmt::format("resuming from {}, which has {:.0f} % of the picture{}", file_->path(),
                     100 * known_->share_rendered(), damage));
}

template <typename T>
Film<T> PictureJournal<T>::take_film() {
    return known_ ? std::move(known_->film) : Film<T>(region_.width, region_.height);
}

template <typename T>
std::vector<Rect> PictureJournal<T>::tiles(int width, int height) const {
    std::vector<Rect> tiles = shared_tiles(width, height);
    if (known_) std::erase_if(tiles, [&](const Rect& tile) { return known_->has(tile); });
    return tiles;
}

template <typename T>
std::vector<Rect> PictureJournal<T>::shared_tiles(int width, int height) const {
    std::vector<Rect> tiles;
    for (const Rect& block : blocks_) {
        std::ranges::copy(make_tiles(block, width, height), std::back_inserter(tiles));
    }
    return tiles;
}

template <typename T>
void PictureJournal<T>::begin(const Film<T>& film) {
    if (!file_) return;
    const double delay = settings_.shares ? 0 : settings_.journal_delay;
    keeper_ =
        std::make_unique<JournalKeeper<T>>(*file_, film, region_, delay, delay == 0 || known_);
    if (!file_->failure().empty()) tell_failure();
}

/// Shares that cannot be written are not worth rendering.
template <typename T>
void PictureJournal<T>::tell_failure() {
    if (settings_.shares) throw Error(ExitCode::output, file_->failure());
    if (failure_is_told_.exchange(true)) return;
    say_(fmt::format("{}; {} are saved", file_->failure(),
                     file_->exists() ? "no more tiles" : "no tiles"));
}

template <typename T>
void PictureJournal<T>::tile_finished(const Rect& tile) {
    if (keeper_ && !keeper_->tile_finished(tile)) tell_failure();
}

template <typename T>
void PictureJournal<T>::discard() {
    keeper_.reset();  // it may be writing the file's start
    if (file_) file_->remove();
}

template <typename T>
void PictureJournal<T>::end(bool is_complete) {
    if (!keeper_) return;
    if (!is_complete || settings_.shares) {
        keeper_->close(is_complete);
        if (!settings_.shares && !known_ && !keeper_->has_pixels()) file_->remove();
    }
    keeper_.reset();
    if (!file_->failure().empty()) tell_failure();
}

template class PictureJournal<float>;
template class PictureJournal<double>;

}  // namespace rt
