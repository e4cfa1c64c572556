// SPDX-License-Identifier: Apache-2.0
#include "host/journal/merge.h"

#include <fmt/format.h>

#include <vector>

#include "host/base/console.h"
#include "host/base/counted.h"
#include "host/base/error.h"
#include "host/base/printable.h"
#include "host/base/temporary_folder.h"
#include "host/image/image_error.h"
#include "host/image/output_path.h"
#include "host/image/picture_io.h"
#include "host/picture/render_stats.h"
#include "host/process/stop_signal.h"
#include "host/verbs/render_steps.h"
#include "host/verbs/verbs.h"
#include "host/verbs/verify_parts.h"

namespace rt {

namespace {

std::string missing_text(const MergedPicture& merged) {
    return fmt::format("{} missing; render --shard {}",
                       counted(merged.missing_pixels, "pixel is", "pixels are"),
                       to_string(*merged.missing));
}

void write_merged(const MergedPicture& merged, const MergeOptions& options) {
    const JournalHeader& header = merged.header;
    PictureMetadata metadata = picture_metadata(header.scene, header.scene_hash, header.settings,
                                                hash_text(merged.image_hash));
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

}  // namespace

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
                                  printable(merged.header.settings), hash_text(merged.image_hash)));
    }
    const bool is_finite =
        !report_non_finite(merged.picture, merged.header.region, count_non_finite(merged.picture));
    return static_cast<int>(is_finite ? ExitCode::done : ExitCode::non_finite);
}

}  // namespace rt
