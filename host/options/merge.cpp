// SPDX-License-Identifier: Apache-2.0
#include "host/options/lists.h"
#include "host/options/picture_output.h"
#include "host/options/verb_options.h"

namespace rt {

void add_merge(const CommandLine& program, Options& options) {
    MergeOptions& merge = options.merge;
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
    verb.when_chosen([&options] {
        settle_picture_output(options.merge.output, options.merge.format);
        options.verb = Verb::merge;
    });
}

}  // namespace rt
