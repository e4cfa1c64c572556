// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "host/cli/progress.h"
#include "host/cli/render_options.h"
#include "host/picture/render_picture.h"
#include "host/view/live_picture.h"

// The steps of rendering. All of them may throw Error.
namespace rt {

/// The metadata that marks an unfinished picture; its text says how much is there.
inline constexpr const char* partial_mark = "mirrorball:Partial";

/// Metadata of a picture, without anything that varies from run to run or device to device.
PictureMetadata picture_metadata(const std::string& scene, const std::string& scene_hash,
                                 const std::string& settings, const std::string& image_hash);

/// The text of that name; empty if there is none.
std::string text_in(const PictureMetadata& metadata, const std::string& name);

/// Whether both name the same scene and settings.
bool shows_the_same(const PictureMetadata& a, const PictureMetadata& b);

/// Warns that the picture is not saved, unless only figures are wanted. Returns whether it did.
bool say_unsaved(const RenderOptions& options);

/// Reports on stderr that `count` pixels of a picture of that region are not finite, if any.
/// Returns whether any are.
bool report_non_finite(const Picture& picture, const Rect& region, std::size_t count);

/// Starts the clock of --timeout.
void start_timeout(const RenderOptions& options);

/// Finds the devices on another thread, as find_devices; a worker's parent watches their drivers.
std::future<std::vector<DeviceChoice>> start_finding_devices(const RenderOptions& options);

/// Rejects, before anything is computed, an output that could not be written.
void check_output(const RenderOptions& options);

/// Chooses where finished tiles are kept: next to the output, or in it for shares.
void choose_journal(RenderOptions& options);

/// Prints a scene's warnings on stderr.
void print_warnings(const std::string& scene, const std::vector<std::string>& warnings);

/// Loads options.scene as it is to be rendered; reports on stderr what the reader skipped and
/// what looks wrong in it. Rejects
/// an output that is one of the files it names.
Scene scene_to_render(const RenderOptions& options);

/// Prints a render's messages on stderr: of each its first line, or all with --verbose; nothing
/// with --quiet. The options must outlive it.
std::function<void(const std::string& line)> message_printer(const RenderOptions& options);

/// The viewers that the options ask for; null without any. The options must outlive it.
std::unique_ptr<LivePicture> make_live_picture(const RenderOptions& options);

/// After the final picture: waits until the windows are closed and viewers have the picture, or for
/// a stop signal, which is not reported, since everything is done.
void wait_for_viewers(LivePicture& live);

/// Shows a render's events on stderr and in viewers, if there are any, and has a worker's parent
/// watch the drivers meanwhile. All must outlive it.
class RenderConsole {
   public:
    RenderConsole(const RenderOptions& options, LivePicture* live);
    RenderConsole(const RenderConsole&) = delete;
    RenderConsole& operator=(const RenderConsole&) = delete;
    ~RenderConsole();

    const RenderEvents& events() const { return events_; }

   private:
    std::optional<ProgressReporter> progress_;
    RenderEvents events_;
};

/// Writes the picture to options.output, an unfinished one next to it: the existing file may be
/// finished. One without any tile is not written. Removes a finished picture's journal and what was
/// unfinished of it. Shares are already written. Returns the name of the file; "" if none was
/// written.
std::string save_picture(const RenderedPicture& rendered, const RenderOptions& options);

/// Notes the device whose driver process failed, and how, when threads finished its picture.
void note_failed_device(RenderStats& stats, const RenderOptions& options);

/// Prints what options.stats requests: the summary line on stderr, or figures on stdout.
void print_results(const RenderStats& stats, const RenderOptions& options);

/// Reports on stderr what is wrong with a picture saved as `path`. Returns the exit status.
int verdict(const RenderedPicture& rendered, const RenderOptions& options, const std::string& path);

/// Rejects, before anything is computed, AOV files that could not be written, or are inputs.
void check_aov_files(const RenderOptions& options, const std::vector<std::string>& inputs);

/// Writes the AOVs in options.aovs next to the picture: as channels of NAME.aov.exr if the picture
/// is an .exr, else each in false color as NAME.depth.png and so on. `scene` is as it was rendered.
/// Returns false, with a message and nothing written, after a stop signal. Throws Error
/// (ExitCode::output).
bool write_aovs(const Scene& scene, const RenderStats& stats, const RenderOptions& options);

/// Calls `render`, which returns an exit status, now and whenever the scene's file or one of its
/// models or their material libraries changes, until `is_over`, with exit status 0, or a stop
/// signal comes, with the signal's; reports its exceptions on stderr.
int watch_scene(const std::string& scene, bool is_quiet, const std::function<int()>& render,
                const std::function<bool()>& is_over);

/// Renders several scenes, one after the other, on devices that are opened once. A scene that fails
/// does not stop the others. Returns the worst exit status of all.
int render_batch(const RenderOptions& options);

}  // namespace rt
