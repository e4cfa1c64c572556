// SPDX-License-Identifier: Apache-2.0
#include "host/journal/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/files.h"
#include "host/base/text.h"
#include "host/cli/options.h"
#include "host/cli/render_steps.h"
#include "host/cli/verb.h"
#include "host/image/image_error.h"
#include "host/image/output_path.h"
#include "host/image/picture_io.h"
#include "host/journal/shares.h"
#include "host/picture/render_picture.h"
#include "host/picture/render_stats.h"
#include "host/process/stop_signal.h"
#include "host/scene/scene_file.h"

namespace rt {

namespace {

/// `mirrorball merge`
struct MergeOptions {
    std::vector<std::string> parts;
    std::string output;  ///< empty: only check whether they fit; "-": standard output
    std::optional<PictureFormat> format;  ///< of standard output
    Encoding encoding = Encoding::display;
    bool allow_missing = false;
    double verify = 0;  ///< share of the picture to render again on threads and compare, 0 to 1
    std::string scene;  ///< for `verify`; empty: the file that the first part names
    bool quiet = false;
};

std::string scene_to_load(const JournalHeader& header, const std::string& scene) {
    std::error_code ignored;
    if (!scene.empty()) return scene;
    if (!header.scene_file.empty() && std::filesystem::exists(header.scene_file, ignored)) {
        return header.scene_file;
    }
    usage_error("--verify: cannot find the scene file{}; name it with --scene",
                header.scene_file.empty() ? "" : " " + header.scene_file);
}

/// Shares hand out the blocks of a region at random, so that any share is a sample of it.
Shares sample_of(const Rect& region, double share, std::uint64_t seed) {
    const auto blocks = static_cast<int>(share_blocks(region).size());
    const auto wanted = static_cast<int>(std::lround(share * blocks));
    Shares sample{std::vector<int>(static_cast<std::size_t>(std::clamp(wanted, 1, blocks))),
                  blocks};
    auto number = static_cast<int>(seed % static_cast<std::uint64_t>(blocks));
    for (int& chosen : sample.numbers) chosen = std::exchange(number, (number + 1) % blocks);
    std::sort(sample.numbers.begin(), sample.numbers.end());
    return sample;
}

/// Renders a share (0 to 1) of the picture again on threads of this machine, at least one of its
/// thousand blocks, chosen by its seed, as one more part for merge_journals to compare. `scene`:
/// the scene file; empty: the one that the header names. Returns false if a stop signal came first.
/// Throws Error: usage if the scene cannot be found.
bool render_part_again(const MergedPicture& merged, const std::string& scene, double share,
                       const std::string& part) {
    const JournalHeader& header = merged.header;
    RenderSettings settings = settings_for(header.picture);
    settings.journal = part;
    settings.shares = sample_of(header.picture.region, share, merged.seed);
    settings.light.light_scale = header.light_scale;
    if (const auto& light = header.ambient_light) {
        settings.light.ambient_light = glm::dvec3((*light)[0], (*light)[1], (*light)[2]);
    }
    Scene loaded = load_scene(scene_to_load(header, scene), settings.light);
    apply_overrides(loaded, settings);
    return render_picture(loaded, settings, {threads_choice()}, {}, stop_flag()).stats.complete();
}

std::string missing_text(const MergedPicture& merged) {
    return fmt::format("{} missing; render --shard {}",
                       counted(merged.missing_pixels, "pixel is", "pixels are"),
                       to_string(*merged.missing));
}

void write_merged(const MergedPicture& merged, const MergeOptions& options) {
    const JournalHeader& header = merged.header;
    PictureMetadata metadata = picture_metadata(
        header.scene, header.scene_hash, to_string(header.picture), hash_text(merged.image_hash));
    if (merged.missing) {
        metadata.emplace_back(partial_mark,
                              fmt::format("without shares {}", to_string(*merged.missing)));
    }
    write_picture(options.output, merged.picture, options.encoding, metadata, options.format);
}

/// Renders part of the merged picture again and compares. Throws Error if they differ.
void verify(const MergedPicture& merged, const MergeOptions& options) {
    const TemporaryFolder folder;
    if (folder.name().empty()) {
        throw Error(ExitCode::output,
                    "--verify: cannot create a temporary folder; set TMPDIR to a writable folder");
    }
    const std::string again = folder.name() + "/rendered-here.mbj";
    install_stop_signals();
    if (!render_part_again(merged, options.scene, options.verify, again)) return;
    std::vector<std::string> parts = options.parts;
    parts.push_back(again);
    merge_journals(parts);
    if (!options.quiet) print_note("the part rendered again is bit-identical");
}

/// A whole picture needs no other part: it is written in another format.
bool is_whole(const MergeOptions& options) {
    return options.parts.size() == 1 && options.parts.front().ends_with(".pfm");
}

int run_merge(const MergeOptions& options) {
    if (!options.output.empty()) {
        check_picture_path(options.output, options.format);
        check_output_is_no_input(options.output, options.parts);
    }
    if (is_whole(options)) {
        const Picture picture = read_picture(options.parts.front());
        if (!options.output.empty()) {
            write_picture(options.output, picture, options.encoding, {}, options.format);
        }
        return static_cast<int>(ExitCode::done);
    }
    const MergedPicture merged = merge_journals(options.parts);
    print_notes(merged.notes);
    if (merged.missing && !options.allow_missing) {
        throw Error(ExitCode::incomplete, missing_text(merged));
    }
    if (merged.missing) print_note(missing_text(merged));
    if (options.verify > 0) verify(merged, options);
    if (stop_flag() != 0) return 128 + stop_flag();
    if (!options.output.empty()) write_merged(merged, options);
    if (!options.quiet) {
        print_message(fmt::format("{}: {} of {}, image {}\n", printable(merged.header.scene),
                                  counted(options.parts.size(), "part"),
                                  printable(to_string(merged.header.picture)),
                                  hash_text(merged.image_hash)));
    }
    const bool is_finite = !report_non_finite(merged.picture, merged.header.picture.region,
                                              count_non_finite(merged.picture));
    return static_cast<int>(is_finite ? ExitCode::done : ExitCode::non_finite);
}

}  // namespace

void add_merge(const CommandLine& program, Invocation& call) {
    const auto asked = std::make_shared<MergeOptions>();
    MergeOptions& merge = *asked;
    const CommandLine verb =
        program.verb("merge", "merge the parts of a picture written by render --shard");
    verb.arguments("PART", merge.parts,
                   "parts (.mbj) of one picture, in any order; or a whole one (.pfm)", true);
    add_picture_output(verb, merge.output, merge.format,
                       "picture file: .png, .exr, .pfm, .tif, .jpg, ..., or - for standard output "
                       "(default: only check the parts)");
    add_encoding(verb, merge.encoding);
    verb.flag("--allow-missing", merge.allow_missing,
              "write the picture even if parts are missing, which are left black");
    verb.value("--verify", "P%", merge.verify, percent_to(100),
               "render P% of the picture again on threads and compare");
    verb.value("--scene", "SCENE", merge.scene,
               "scene file for --verify (default: the path recorded in the parts)");
    verb.flag("-q,--quiet", merge.quiet, "print only errors");
    verb.when_chosen([asked, &call] {
        settle_picture_output(asked->output, asked->format);
        call.here([asked] { return run_merge(*asked); }, asked->quiet);
    });
}

}  // namespace rt
