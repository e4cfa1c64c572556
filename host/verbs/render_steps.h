// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/options/render_options.h"
#include "host/picture/render_picture.h"
#include "host/verbs/progress.h"
#include "host/view/live_picture.h"

// What rendering one scene and a batch of them have in common. All of it throws Error.
namespace rt {

/// What belongs to a picture, and nothing that changes from run to run or device to device.
PictureMetadata picture_metadata(const std::string& scene, const std::string& scene_hash,
                                 const std::string& settings, const std::string& image_hash);

/// Says on stderr that so many pixels of a picture of that region are not finite; whether any is.
bool report_non_finite(const Picture& picture, const Rect& region, std::size_t count);

/// Refuses, before anything is computed, an output that could not be written.
void check_output(const RenderOptions& options);

/// Where finished tiles are kept: beside the output, or in it where it is of shares.
void choose_journal(RenderOptions& options);

/// options.scene as it is to be rendered; what its reader left out goes to stderr. Refuses an
/// output that is one of its models.
Scene scene_to_render(const RenderOptions& options);

/// Shows on stderr what a render tells of. The options must outlive it.
class RenderConsole {
   public:
    explicit RenderConsole(const RenderOptions& options);
    RenderConsole(const RenderConsole&) = delete;
    RenderConsole& operator=(const RenderConsole&) = delete;

    const RenderEvents& events() const { return events_; }

    /// Shows the picture as it stays, where it is shown.
    void finish(const Picture& picture);

    /// Until its windows are closed, or a stop signal comes.
    void wait();

   private:
    void show(const RenderOptions& options);

    std::optional<LivePicture> live_;
    std::optional<ProgressReporter> progress_;
    RenderEvents events_;
};

/// Writes the picture to options.output, an unfinished one next to it: what is there may be
/// finished. The journal of a finished one goes. Shares are written already. Returns the name it
/// got; "" where none is asked for.
std::string save_picture(const RenderedPicture& rendered, const RenderOptions& options);

/// What options.stats asks for: the summary line on stderr, or figures on stdout.
void print_results(const RenderStats& stats, const RenderOptions& options);

/// Says on stderr what is wrong with a picture that was saved as `path`. Returns the exit status it
/// means.
int verdict(const RenderedPicture& rendered, const std::string& path);

}  // namespace rt
