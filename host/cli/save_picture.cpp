// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/text.h"
#include "host/base/version.h"
#include "host/cli/render_pictures.h"
#include "host/image/image_error.h"
#include "host/image/output_file.h"
#include "host/image/picture_io.h"
#include "host/journal/journal_file.h"
#include "host/process/stop_signal.h"

namespace rt {

namespace {

/// Whether both name the same scene and settings.
bool shows_the_same(const PictureMetadata& a, const PictureMetadata& b) {
    for (const char* name : {scene_hash_key, "mirrorball:Settings", "mirrorball:Encoding"}) {
        if (text_in(a, name) != text_in(b, name)) return false;
    }
    return true;
}

/// What a picture file says of itself; empty if it cannot be read.
std::optional<PictureMetadata> metadata_in(const std::string& path) try {
    return read_picture_header(path).metadata;
} catch (const Error&) {
    return std::nullopt;
}

/// Whether a file of this format says what it shows.
bool has_metadata(const std::string& path) {
    const auto format = known_picture_format(path);
    return format == PictureFormat::png || format == PictureFormat::exr;
}

/// Whether a file says that it is an unfinished picture.
bool is_unfinished(const std::optional<PictureMetadata>& metadata) {
    return metadata && !text_in(*metadata, partial_mark).empty();
}

/// Removes what an interrupted render of the same picture left next to it.
void remove_partial(const std::string& output, const PictureMetadata& metadata) {
    if (output == stdout_path) return;
    const std::string path = partial_path(output);
    const auto found = metadata_in(path);
    std::error_code ignored;
    if (is_unfinished(found) && shows_the_same(*found, metadata)) {
        std::filesystem::remove(path, ignored);
    }
}

/// How much of a stopped picture is done.
std::string share_done(const RenderStats& stats) {
    return fmt::format("{} of {} tiles", stats.tiles_finished, stats.tiles);
}

}  // namespace

PictureMetadata picture_metadata(const std::string& scene, const std::string& scene_hash,
                                 const std::string& settings, const std::string& image_hash,
                                 Encoding encoding) {
    return {{"mirrorball:Scene", scene},
            {scene_hash_key, scene_hash},
            {"mirrorball:Settings", settings},
            {"mirrorball:Encoding",
             encoding == Encoding::display ? "" : std::string(name_of(encoding_names, encoding))},
            {"mirrorball:ImageHash", image_hash},
            {"mirrorball:Version", version}};
}

bool may_show(const std::string& path, const Scene& scene, const RenderOptions& options) try {
    const auto [picture, found] = read_picture_file(path);  // to its end: a copy may be cut
    return count_non_finite(picture) == 0 &&
           (text_in(found, scene_hash_key).empty() ||
            shows_the_same(found, picture_metadata(scene.name, hash_text(scene_hash(scene)),
                                                   to_string(picture_spec(scene, options)), "",
                                                   options.encoding)));
} catch (const Error&) {
    return false;
}

bool note_non_finite(const Picture& picture, const Rect& region, std::size_t count,
                     std::vector<std::string>& notes) {
    if (count == 0) return false;
    const auto [x, y] = first_non_finite(picture);
    notes.push_back(
        fmt::format("{} not finite, the first at {},{}; look for very large numbers in the scene",
                    counted(count, "pixel is", "pixels are"), region.x + x, region.y + y));
    return true;
}

std::string save_picture(const RenderedPicture& rendered, const RenderOptions& options) {
    if (options.output.empty() || options.shares) return options.output;
    const RenderStats& stats = rendered.stats;
    PictureMetadata metadata =
        picture_metadata(stats.scene.name, hash_text(stats.scene.hash), to_string(stats.picture),
                         hash_text(stats.image_hash), options.encoding);
    if (stats.estimate) {
        metadata.push_back({"mirrorball:EstimatedError", to_string(*stats.estimate)});
    }
    if (!stats.device.fallback_from.empty()) {
        metadata.push_back({"mirrorball:FallbackFrom", stats.device.fallback_from});
        const std::string failure = stats.failure();
        if (!failure.empty()) metadata.push_back({"mirrorball:FallbackReason", failure});
    }
    std::string path = options.output;
    if (!stats.complete()) {
        if (stats.tiles_finished == 0 && stats.resumed == 0) return "";
        if (path == stdout_path) return "";  // a reader of stdout wants a whole picture
        path = partial_path(path);
        std::error_code unknown;  // then writing it says why
        const bool is_ours =
            has_metadata(path) ? is_unfinished(metadata_in(path)) : stats.resumed > 0;
        if (!is_ours && std::filesystem::exists(path, unknown)) {
            print_note(printable(path) +
                       ": exists and is not an unfinished picture; saving nothing there");
            return "";
        }
        metadata.emplace_back(partial_mark, share_done(stats));
    }
    const StopsAtOnce may_wait_for_a_reader(find_output_destination(path).in_place);
    write_picture(path, rendered.picture, options.encoding, metadata, options.format);
    if (!stats.complete()) return path;
    if (rendered.journal) rendered.journal->remove();
    remove_partial(options.output, metadata);
    return path;
}

int verdict(const RenderedPicture& rendered, const RenderOptions& options,
            const std::string& output, std::vector<std::string>& notes) {
    const RenderStats& stats = rendered.stats;
    const bool non_finite =
        note_non_finite(rendered.picture, stats.picture.region, stats.non_finite, notes);
    if (!stats.complete()) {
        const bool can_go_on = rendered.journal != nullptr && rendered.journal->exists() &&
                               rendered.journal->failure().empty();
        notes.push_back(fmt::format("{} after {}{}{}", stop_reason(), share_done(stats),
                                    output.empty() ? "" : "; the finished part is in " + output,
                                    can_go_on ? "; the same command resumes from there" : ""));
        return exit_code_of_stop(stop_flag());
    }
    if (non_finite) return static_cast<int>(ExitCode::non_finite);
    const bool unchecked = stop_flag() != 0 && options.check > 0 && stats.tiles_checked == 0;
    if (unchecked || (!stats.estimate && (options.estimate || options.target_rmse > 0))) {
        notes.push_back(fmt::format("{} before the picture{}", stop_reason(),
                                    unchecked ? " was checked" : "'s error was estimated"));
        return exit_code_of_stop(stop_flag());
    }
    if (stats.estimate && stats.estimate->target > 0 &&
        !stats.estimate->reaches(stats.estimate->target)) {
        notes.push_back(fmt::format("{} with {}, not the target of {:g}: {}",
                                    to_string(*stats.estimate), to_string(stats.picture.aa),
                                    stats.estimate->target,
                                    stop_flag() != 0 ? stop_reason() : "no mode has more samples"));
        return stop_flag() != 0 ? exit_code_of_stop(stop_flag())
                                : static_cast<int>(ExitCode::incomplete);
    }
    return static_cast<int>(ExitCode::done);
}

}  // namespace rt
