// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "host/image/picture_format.h"
#include "host/number.h"
#include "host/options/lists.h"
#include "host/options/verb_options.h"

namespace rt {

namespace {

/// A finite number >= 0; 8-bit levels may be written as in 2/255.
double parse_limit(const std::string& option, const std::string& text) {
    std::string_view digits = text;
    const bool is_level = digits.ends_with("/255");
    if (is_level) digits.remove_suffix(4);
    const auto value = parse_number<double>(digits);
    if (!value || !std::isfinite(*value) || *value < 0) {
        refuse(option, text, "give a number that is not negative, as in 0.01 or 2/255");
    }
    return is_level ? *value / 255 : *value;
}

void add_limit(const CommandLine& verb, const std::string& option, std::optional<double>& limit,
               const char* help) {
    verb.option(option, "X", help,
                [&limit, option](const std::string& text) { limit = parse_limit(option, text); });
}

void add_thresholds(const CommandLine& verb, CompareOptions& compare) {
    add_limit(verb, "--max-rmse", compare.max_rmse, "exit 1 when the RMSE is above X");
    add_limit(verb, "--max-abs", compare.max_abs, "exit 1 when a channel differs by more than X");
    add_limit(verb, "--max-flip", compare.max_flip, "exit 1 when the mean FLIP is above X");
    verb.option("--max-pixels", "N", "exit 1 when more than N pixels differ by over 1/255",
                [&](const std::string& text) {
                    const auto number = parse_integers(text, 'x');
                    if (!number || number->size() != 1 || number->front() < 0) {
                        refuse("--max-pixels", text, "give a number of pixels");
                    }
                    compare.max_pixels = number->front();
                });
}

void add_heatmap(const CommandLine& verb, CompareOptions& compare) {
    verb.option("--heatmap", "FILE.png", "write a color map of the differences, black to yellow",
                [&](const std::string& text) {
                    if (picture_format_of_name(text) != PictureFormat::png) {
                        refuse("--heatmap", text, "name a .png file");
                    }
                    compare.heatmap = text;
                });
    verb.option("--heatmap-scale", "X",
                "the difference at the top of the color map (default: the largest)",
                [&](const std::string& text) {
                    compare.heatmap_scale = parse_limit("--heatmap-scale", text);
                    if (compare.heatmap_scale == 0)
                        refuse("--heatmap-scale", text, "give a number above 0");
                });
}

}  // namespace

void add_compare(const CommandLine& program, Options& options) {
    CompareOptions& compare = options.compare;
    const CommandLine verb = program.verb("compare", "measure the difference between two images");
    verb.argument("A", compare.picture, "picture: PNG, EXR, PFM, JPEG, TIFF, HDR, PNM");
    verb.argument("B", compare.reference,
                  "reference picture, of the same size and number of channels");
    add_thresholds(verb, compare);
    add_heatmap(verb, compare);
    verb.flag("--flip", compare.flip,
              "also compute NVIDIA's FLIP, if python3 has flip-evaluator (half a second or more)");
    verb.flag("--clamp", compare.clamp, "clamp values to 0..1 first, as 8-bit files do");
    add_result_file(verb, "--json", compare.json,
                    "write JSON: to FILE, or to stdout instead of the text");
    verb.when_chosen([&] { options.verb = Verb::compare; });
}

}  // namespace rt
