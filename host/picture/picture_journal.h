// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/flatten/flat_scene.h"
#include "host/journal/journal_file.h"
#include "host/opencl/devices.h"
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
                   const FlatScene<T>& scene, const std::vector<DeviceChoice>& devices, Say say);

    /// Whether the file holds this picture, as far as it is saved.
    bool has_begun() const { return file_ && file_->exists(); }

    /// Whether the journal has the whole picture.
    bool is_finished() const { return known_ && known_->is_finished; }

    /// The share of the film that the journal has.
    double share_known() const { return known_ ? known_->share_rendered() : 0; }

    /// The film with all that is known of it; call once.
    Film<T> take_film();

    /// The film's tiles of this size of which a pixel remains to be rendered.
    std::vector<Rect> tiles(int width, int height) const;

    /// All of them, known or not.
    std::vector<Rect> shared_tiles(int width, int height) const;

    /// Starts saving what is finished of this film. Throws Error (output) if shares cannot be
    /// saved; tile_finished throws it if that turns out later.
    void begin(const Film<T>& film);
    void tile_finished(const Rect& tile);

    /// Closes it, once what was rendered is known to be right. Throws Error (ExitCode::output) if
    /// shares are not on disk.
    void end(bool is_complete);

    /// Discards what is saved, because it was wrong, and saves nothing more.
    void discard();

    std::shared_ptr<JournalFile> file() const { return file_; }

   private:
    void open();
    void read();
    void tell_failure();
    std::uint64_t key() const;

    const RenderSettings& settings_;
    const FlatScene<T>& scene_;
    const AaMode aa_;
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
