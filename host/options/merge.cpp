// SPDX-License-Identifier: Apache-2.0
#include "host/options/parse.h"
#include "host/options/picture_output.h"
#include "host/options/verb_options.h"

namespace rt {

void add_merge(const CommandLine& program, Options& options) {
    MergeOptions& merge = options.merge;
    const CommandLine verb =
        program.verb("merge", "merge the parts of a picture that render --shard wrote");
    verb.arguments("PART", merge.parts, "parts (.mbj) of one picture, in any order", true);
    add_picture_output(verb, merge.output, merge.format,
                       "picture file: .png, .exr, .pfm, .tif, .jpg, ... (default: only check the "
                       "parts), or - for standard output");
    add_encoding(verb, merge.encoding);
    verb.flag("--allow-missing", merge.allow_missing,
              "write the picture even if parts are missing; they are black");
    verb.option(
        "--verify", "P%", "render P% of the picture again, here and on threads, and compare",
        [&](const std::string& text) { merge.verify = parse_percent("--verify", text, 100); });
    add_name(verb, "--scene", "SCENE", merge.scene,
             "where --verify finds the scene (default: the path recorded in the parts)");
    verb.flag("-q,--quiet", merge.quiet, "print only errors");
    verb.when_chosen([&options] {
        settle_picture_output(options.merge.output, options.merge.format);
        options.verb = Verb::merge;
    });
}

}  // namespace rt
