// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <vector>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/text.h"
#include "host/cli/options.h"
#include "host/cli/render_pictures.h"
#include "host/image/image_error.h"
#include "host/image/output_file.h"
#include "host/image/picture_io.h"
#include "host/journal/shares.h"

namespace rt {

namespace {

/// `mirrorball merge`
struct MergeOptions {
    std::vector<std::string> parts;
    std::string output;  ///< empty: only check whether they fit; "-": standard output
    std::optional<PictureFormat> format;  ///< of standard output
    Encoding encoding = Encoding::display;
    bool allow_missing = false;
    bool quiet = false;
};

std::string missing_text(const MergedPicture& merged) {
    return fmt::format("{} missing; render --shard {}",
                       counted(merged.missing_pixels, "pixel is", "pixels are"),
                       to_string(*merged.missing));
}

void write_merged(const MergedPicture& merged, const MergeOptions& options) {
    const JournalHeader& header = merged.header;
    PictureMetadata metadata =
        picture_metadata(header.scene, header.scene_hash, to_string(header.picture),
                         hash_text(merged.image_hash), options.encoding);
    if (merged.missing) {
        metadata.emplace_back(partial_mark,
                              fmt::format("without shares {}", to_string(*merged.missing)));
    }
    write_picture(options.output, merged.picture, options.encoding, metadata, options.format);
}

int run_merge(const MergeOptions& options) {
    if (!options.output.empty()) {
        check_picture_path(options.output, options.format);
        check_outputs({options.output}, UsedFiles(options.parts));
    }
    if (options.parts.size() == 1 && options.parts.front().ends_with(".pfm")) {  // a whole picture
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
    if (!options.output.empty()) write_merged(merged, options);
    if (!options.quiet) {
        print_message(fmt::format("{}: {} of {}, image {}\n", printable(merged.header.scene),
                                  counted(options.parts.size(), "part"),
                                  printable(to_string(merged.header.picture)),
                                  hash_text(merged.image_hash)));
    }
    std::vector<std::string> notes;
    const bool is_finite = !note_non_finite(merged.picture, merged.header.picture.region,
                                            count_non_finite(merged.picture), notes);
    print_notes(notes);
    return static_cast<int>(is_finite ? ExitCode::done : ExitCode::non_finite);
}

}  // namespace

void add_merge(Verb& program, const Invocation&) {
    const auto asked = std::make_shared<MergeOptions>();
    MergeOptions& merge = *asked;
    Verb& verb = program.verb("merge", "merge the parts of a picture written by render --shard");
    verb.arguments("PART", merge.parts,
                   "parts (.mbj) of one picture, in any order; or a whole one (.pfm)", true);
    add_picture_output(verb, merge.output, merge.format,
                       "picture file: .png, .exr, .pfm, .tif, .jpg, ..., or - for standard output "
                       "(default: only check the parts)");
    add_encoding(verb, merge.encoding);
    verb.flag("--allow-missing", merge.allow_missing,
              "write the picture even if parts are missing, which are left black");
    verb.flag("-q,--quiet", merge.quiet, "print only errors");
    verb.run = [asked] {
        settle_picture_output(asked->output, asked->format);
        return run_merge(*asked);
    };
}

}  // namespace rt
