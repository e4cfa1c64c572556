// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include "host/image/picture_format.h"
#include "host/options/lists.h"
#include "host/options/verb_options.h"

namespace rt {

namespace {

/// A finite number >= 0; 8-bit levels may be written as in 2/255.
double parse_limit(const std::string& text) {
    std::string_view digits = text;
    const bool is_level = digits.ends_with("/255");
    if (is_level) digits.remove_suffix(4);
    const auto value = parse_number<double>(digits);
    if (!value || !std::isfinite(*value) || *value < 0) {
        refuse(text, "expected a number that is not negative, such as 0.01 or 2/255");
    }
    return is_level ? *value / 255 : *value;
}

double parse_scale(const std::string& text) {
    const double scale = parse_limit(text);
    if (scale == 0) refuse(text, "expected a number above 0");
    return scale;
}

std::string parse_heatmap(const std::string& text) {
    if (picture_format_of_name(text) != PictureFormat::png) refuse(text, "expected a .png file");
    return text;
}

}  // namespace

void add_compare(const CommandLine& program, Options& options) {
    CompareOptions& compare = options.compare;
    const CommandLine verb = program.verb("compare", "measure the difference between two pictures");
    verb.argument("A", compare.picture, "picture: PNG, EXR, PFM, JPEG, TIFF, HDR, PNM");
    verb.argument("B", compare.reference,
                  "reference picture, of the same size and number of channels");
    verb.value("--max-rmse", "X", compare.max_rmse, parse_limit, "exit 1 if the RMSE exceeds X");
    verb.value("--max-abs", "X", compare.max_abs, parse_limit,
               "exit 1 if any channel differs by more than X");
    verb.value("--max-flip", "X", compare.max_flip, parse_limit,
               "exit 1 if the mean FLIP error exceeds X");
    verb.value("--max-pixels", "N", compare.max_pixels,
               count_in(0, std::numeric_limits<int>::max()),
               "exit 1 if more than N pixels differ by over 1/255");
    verb.value("--heatmap", "FILE.png", compare.heatmap, parse_heatmap,
               "write a color map of the differences' square roots, from black to yellow");
    verb.value("--heatmap-scale", "X", compare.heatmap_scale, parse_scale,
               "difference shown as yellow (default: the largest)");
    verb.flag("--flip", compare.flip,
              "also compute NVIDIA's FLIP, if python3 has flip-evaluator (half a second or more)");
    verb.flag("--clamp", compare.clamp, "first clamp values to 0..1, as 8-bit files do");
    add_result_file(verb, "--json", compare.json,
                    "write JSON, to FILE or to stdout instead of the text");
    verb.when_chosen([&] { options.verb = Verb::compare; });
}

}  // namespace rt
