// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/base/text.h"
#include "host/base/version.h"
#include "host/flatten/flat_scene.h"
#include "host/journal/journal_file.h"
#include "host/opencl/cl_renderer.h"
#include "host/picture/crew.h"
#include "host/picture/render_settings.h"
#include "host/picture/render_stats.h"
#include "host/render/rect.h"

namespace rt {

/// What remains to be rendered of a picture, given a journal or a choice of shares, and saving what
/// is finished. Without either, the whole picture remains.
template <typename T>
class PictureJournal {
   public:
    using Say = std::function<void(const std::string& line)>;

    /// Opens settings.journal. `devices` render the picture: what inexact ones have rendered, only
    /// they resume. `stats` describes the picture. Throws Error: output if another process renders
    /// the same picture, or if the result of shares would replace something else; usage for shares
    /// that cannot be kept.
    PictureJournal(const RenderSettings& settings, const RenderStats& stats,
                   const FlatScene<T>& scene, const std::vector<DeviceChoice>& devices, Say say)
        : settings_(settings), region_(stats.picture.region), say_(std::move(say)) {
        blocks_ = settings.shares ? shared_blocks(*settings.shares, region_) : std::vector{region_};
        if (settings.journal.empty()) return;
        if (settings.math == Math::fast || settings.schedule != Schedule::tiles) return;
        char host[256] = "";
        ::gethostname(host, sizeof(host) - 1);
        header_.picture = stats.picture;
        header_.shares = to_string(settings.shares.value_or(Shares{}));
        header_.scene = stats.scene.name;
        header_.scene_hash = hash_text(stats.scene.hash);
        header_.inexact_devices = inexact_names(devices, header_.picture.precision);
        header_.writer = joined_names(devices) + " on " + host;
        header_.key = key_of(scene);
        open();
    }

    /// Whether the file holds this picture, as far as it is saved.
    bool has_begun() const { return file_ && file_->exists(); }

    /// Whether the journal has the whole picture.
    bool is_finished() const { return known_ && known_->is_finished; }

    /// The share of the film that the journal has.
    double share_known() const { return known_ ? known_->share_rendered() : 0; }

    /// The film with all that is known of it; call once.
    Film<T> take_film() {
        return known_ ? std::move(known_->film) : Film<T>(region_.width, region_.height);
    }

    /// The film's tiles of this size of which a pixel remains to be rendered.
    std::vector<Rect> tiles(int width, int height) const {
        std::vector<Rect> tiles = shared_tiles(width, height);
        if (known_) std::erase_if(tiles, [&](const Rect& tile) { return known_->has(tile); });
        return tiles;
    }

    /// All of them, known or not.
    std::vector<Rect> shared_tiles(int width, int height) const {
        std::vector<Rect> tiles;
        for (const Rect& block : blocks_) {
            std::ranges::copy(make_tiles(block, width, height), std::back_inserter(tiles));
        }
        return tiles;
    }

    /// Starts saving what is finished of this film. Throws Error (output) if shares cannot be
    /// saved; tile_finished throws it if that turns out later.
    void begin(const Film<T>& film) {
        if (!file_) return;
        const double delay = settings_.shares ? 0 : settings_.journal_delay;
        keeper_ =
            std::make_unique<JournalKeeper<T>>(*file_, film, region_, delay, delay == 0 || known_);
        if (!file_->failure().empty()) tell_failure();
    }
    void tile_finished(const Rect& tile) {
        if (keeper_ && !keeper_->tile_finished(tile)) tell_failure();
    }

    /// Closes it, once what was rendered is known to be right. Throws Error (ExitCode::output) if
    /// shares are not on disk.
    void end(bool is_complete) {
        if (!keeper_) return;
        if (!is_complete || settings_.shares) {
            keeper_->close(is_complete);
            if (!settings_.shares && !known_ && !keeper_->has_pixels()) file_->remove();
        }
        keeper_.reset();
        if (!file_->failure().empty()) tell_failure();
    }

    /// Discards what is saved, because it was wrong, and saves nothing more.
    void discard() {
        keeper_.reset();  // it may be writing the file's start
        if (file_) file_->remove();
    }

    std::shared_ptr<JournalFile> file() const { return file_; }

   private:
    /// Hashes all that the film's bits depend on: the scene, how it is sampled, and the program.
    /// Not on hierarchies, which also order the flat scene's arrays.
    std::uint64_t key_of(const FlatScene<T>& scene) const {
        Hasher hasher;
        hasher.add(std::string_view(version));
        hasher.add(std::string_view(render_kernels));
        hasher.add(sizeof(T));
        hasher.add(std::string_view(header_.scene_hash));
        auto params = scene.params;
        params.sphere_root = params.cone_root = params.triangle_root = 0;
        hasher.add_bytes(std::as_bytes(std::span(&params, 1)));
        const AaMode& aa = header_.picture.aa;
        hasher.add(std::string_view(to_string(aa)));
        hasher.add(aa.threshold);
        for (const int number : {region_.x, region_.y, region_.width, region_.height}) {
            hasher.add(number);
        }
        return hasher.value();
    }

    /// Checks what file exists, and resumes from it if it is of this picture.
    void open() {
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
            say_(path +
                 ": belongs to a different picture or version, or to different settings; starting "
                 "over");
        }
        if (settings_.fresh && is_ours_) file_->remove();
        if (!known_) file_->restart(journal_start(header_));
    }

    void read() {
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
        const std::string damage =
            damaged_bytes == 0
                ? ""
                : fmt::format("; ignored its damaged end ({})", counted(damaged_bytes, "byte"));
        say_(fmt::format("resuming from {}, which has {:.0f} % of the picture{}", file_->path(),
                         100 * known_->share_rendered(), damage));
    }

    /// Shares that cannot be written are not worth rendering.
    void tell_failure() {
        if (settings_.shares) throw Error(ExitCode::output, file_->failure());
        if (failure_is_told_.exchange(true)) return;
        say_(fmt::format("{}; {} are saved", file_->failure(),
                         file_->exists() ? "no more tiles" : "no tiles"));
    }

    const RenderSettings& settings_;
    const Rect region_;
    const Say say_;
    JournalHeader header_;
    std::vector<Rect> blocks_;  ///< of the shares; otherwise the region
    std::shared_ptr<JournalFile> file_;
    bool is_ours_ = false;  ///< what the file had: this picture, though perhaps with other bits
    std::optional<KnownPixels<T>> known_;
    std::atomic<bool> failure_is_told_ = false;
    std::unique_ptr<JournalKeeper<T>> keeper_;
};

}  // namespace rt
