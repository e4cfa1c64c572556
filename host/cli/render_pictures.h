// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/cli/render_options.h"
#include "host/image/output_file.h"
#include "host/picture/render_picture.h"
#include "host/view/viewer.h"

// Rendering and saving the pictures that render names. All of it may throw Error.
namespace rt {

/// The metadata that marks an unfinished picture; its text says how much is there.
inline constexpr const char* partial_mark = "mirrorball:Partial";

/// Metadata of a picture, without anything that varies from run to run or device to device.
PictureMetadata picture_metadata(const std::string& scene, const std::string& scene_hash,
                                 const std::string& settings, const std::string& image_hash,
                                 Encoding encoding);

/// Whether a file is the picture to be rendered: whole, finite, and by its metadata, if any.
bool may_show(const std::string& path, const Scene& scene, const RenderOptions& options);

/// Notes that `count` pixels of a picture of that region are not finite, if any. Returns whether
/// any are.
bool note_non_finite(const Picture& picture, const Rect& region, std::size_t count,
                     std::vector<std::string>& notes);

/// Prints a scene's warnings on stderr.
void print_warnings(const std::string& scene, const std::vector<std::string>& warnings);

/// Chooses where finished tiles are kept: next to the output, or in it for shares.
void choose_journal(RenderOptions& options);

/// Writes the picture to options.output, an unfinished one next to it: the existing file may be
/// finished. One without any tile is not written. Removes a finished picture's journal and what was
/// unfinished of it. Shares are already written. Returns the name of the file; "" if none was
/// written.
std::string save_picture(const RenderedPicture& rendered, const RenderOptions& options);

/// Notes what is wrong with a picture saved as `path`. Returns the exit status.
int verdict(const RenderedPicture& rendered, const RenderOptions& options, const std::string& path,
            std::vector<std::string>& notes);

/// Rejects, before anything is computed, AOV files that could not be written, or are inputs.
void check_aov_files(const RenderOptions& options, UsedFiles used);

/// Writes the AOVs in options.aovs next to the picture: as channels of NAME.aov.exr if the picture
/// is an .exr, else each in false color as NAME.depth.png and so on. `scene` is as it was rendered.
/// Returns false, with a message and nothing written, after a stop signal. Throws Error
/// (ExitCode::output).
bool write_aovs(const Scene& scene, const RenderStats& stats, const RenderOptions& options);

/// The viewers that the options ask for; null without any. The options must outlive it.
std::unique_ptr<LivePicture> make_live_picture(const RenderOptions& options);

/// Prints the results of a finished picture on stdout. `record` is what a worker tells of it:
/// "N STATUS", which are its place among the items and its exit status, a line end, and the
/// results.
void print_finished(const std::string& record);

/// Renders options.items one after the other: those of a batch on devices that are opened once, and
/// one that fails does not stop the others; another picture's errors are thrown. Returns the worst
/// exit status of all. `seconds_before_main`: added to the time of a single picture. `kept`:
/// viewers that stay open for the next picture; null: each picture has its own, which wait to be
/// closed.
int render_pictures(const RenderOptions& options, double seconds_before_main, LivePicture* kept);

}  // namespace rt
