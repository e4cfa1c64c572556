// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/text.h"
#include "host/cli/options.h"
#include "host/image/false_color.h"
#include "host/image/image_error.h"
#include "host/image/picture_io.h"
#include "host/print/print_run.h"
#include "host/print/print_stats.h"
#include "host/record/record.h"

namespace rt {

namespace {

/// `mirrorball compare`
struct CompareOptions {
    std::string picture, reference;
    std::optional<double> max_rmse, max_abs;
    std::optional<int> max_pixels;        ///< with a difference over 1/255
    std::string heatmap;                  ///< empty: none
    std::optional<double> heatmap_scale;  ///< default: the largest difference
    ResultFiles results;
    bool clamp = false;  ///< to 0..1, as 8-bit files do
};

struct Comparison {
    Picture picture, reference;
    ImageError error;
    double heatmap_scale = 0;           ///< if there is a heat map
    std::vector<std::string> breaches;  ///< why it fails, in words

    std::size_t pixels() const {
        return picture.pixels.size() / static_cast<std::size_t>(picture.channels);
    }
    bool identical() const { return error.max == 0 && error.non_finite == 0; }
};

void check_same_shape(const Picture& a, const Picture& b, const CompareOptions& options) {
    if (have_same_shape(a, b)) return;
    throw Error(ExitCode::input,
                fmt::format("{} has {}x{} pixels and {}, but {} has {}x{} and {}; compare "
                            "pictures of the same size and channels",
                            options.picture, a.width, a.height, counted(a.channels, "channel"),
                            options.reference, b.width, b.height, b.channels));
}

std::string non_finite_text(const char* name, const Picture& picture) {
    const std::size_t count = count_non_finite(picture);
    if (count == 0) return "";
    const auto [x, y] = first_non_finite(picture);
    return fmt::format("{} of {} not finite, the first at {},{}", counted(count, "pixel"), name, x,
                       y);
}

std::vector<std::string> breaches_of(const Comparison& result, const CompareOptions& options) {
    std::vector<std::string> breaches;
    for (const auto& text :
         {non_finite_text("A", result.picture), non_finite_text("B", result.reference)}) {
        if (!text.empty()) breaches.push_back(text);
    }
    const auto check = [&](const char* name, double value, const char* option,
                           std::optional<double> limit) {
        if (!limit || value <= *limit) return;
        breaches.push_back(fmt::format("{} {:.4g} exceeds {} {:.4g}", name, value, option, *limit));
    };
    const ImageError& error = result.error;
    check("RMSE", error.rmse, "--max-rmse", options.max_rmse);
    check("maximum", error.max, "--max-abs", options.max_abs);
    if (options.max_pixels && error.over_1 > static_cast<std::size_t>(*options.max_pixels)) {
        breaches.push_back(fmt::format("{} over 1/255, exceeding --max-pixels {}",
                                       counted(error.over_1, "pixel"), *options.max_pixels));
    }
    return breaches;
}

Comparison compare_pictures(const CompareOptions& options) {
    check_same_shape(read_picture_header(options.picture).picture,
                     read_picture_header(options.reference).picture, options);
    Comparison result;
    result.picture = read_picture(options.picture);
    result.reference = read_picture(options.reference);
    if (options.clamp) {
        result.picture = clamped(std::move(result.picture));
        result.reference = clamped(std::move(result.reference));
    }
    result.error = image_error(result.picture, result.reference);
    result.heatmap_scale = options.heatmap_scale.value_or(result.error.max);
    result.breaches = breaches_of(result, options);
    return result;
}

void write_heatmap(const Comparison& result, const CompareOptions& options) {
    write_picture(
        options.heatmap, heat_map(result.picture, result.reference, result.heatmap_scale),
        Encoding::display,
        PictureMetadata{{"mirrorball:HeatmapScale", fmt::format("{}", result.heatmap_scale)}});
}

std::string comparison_text(const Comparison& result, const CompareOptions& options) {
    std::string text = fmt::format(
        "{} compared to {}: {}x{} pixels, {}{}\n", printable(options.picture),
        printable(options.reference), result.picture.width, result.picture.height,
        counted(result.picture.channels, "channel"), options.clamp ? ", clamped to 0..1" : "");
    text += error_table(result.error, result.pixels());
    if (!options.heatmap.empty()) {
        text += fmt::format(
            "  heat map    {}: black 0 to yellow {:.4e} by square roots, cyan not finite\n",
            printable(options.heatmap), result.heatmap_scale);
    }
    return text + (result.identical() ? "  identical\n" : "");
}

Json comparison_json(const Comparison& result, const CompareOptions& options) {
    Json json{{"format", "mirrorball-compare"},        {"version", 1},
              {"picture", printable(options.picture)}, {"reference", printable(options.reference)},
              {"width", result.picture.width},         {"height", result.picture.height},
              {"channels", result.picture.channels},   {"clamped", options.clamp},
              {"identical", result.identical()},       {"passed", result.breaches.empty()},
              {"breaches", result.breaches},           {"error", json_of(result.error)}};
    if (result.error.non_finite == result.pixels()) json["error"] = nullptr;
    if (!options.heatmap.empty()) {
        json["heatmap"] = {{"path", printable(options.heatmap)}, {"scale", result.heatmap_scale}};
    }
    return json;
}

int run_compare(const CompareOptions& options) {
    if (options.heatmap_scale && options.heatmap.empty())
        usage_error("--heatmap-scale requires --heatmap");
    options.results.check({options.picture, options.reference}, {options.heatmap});
    if (!options.heatmap.empty()) check_picture_path(options.heatmap);
    const Comparison result = compare_pictures(options);
    if (!options.heatmap.empty()) write_heatmap(result, options);
    options.results.write("--json", [&] { return json_text(comparison_json(result, options)); });
    if (!options.results.take_stdout()) print_result(comparison_text(result, options));
    if (result.breaches.empty()) return static_cast<int>(ExitCode::done);
    print_note(fmt::format("{}", fmt::join(result.breaches, "; ")));
    return static_cast<int>(ExitCode::different);
}

/// A finite number >= 0; 8-bit levels may be written as in 2/255.
double parse_limit(const std::string& text) {
    std::string_view digits = text;
    const bool is_level = digits.ends_with("/255");
    if (is_level) digits.remove_suffix(4);
    const auto value = parse_number<double>(digits);
    if (!value || !std::isfinite(*value) || *value < 0) {
        refuse(text, "expected a number that is not negative, such as 0.01 or 2/255");
    }
    return is_level ? levels(*value) : *value;
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

void add_compare(Verb& program, const Invocation&) {
    const auto asked = std::make_shared<CompareOptions>();
    CompareOptions& compare = *asked;
    Verb& verb = program.verb("compare", "measure the difference between two pictures");
    verb.argument("A", compare.picture, "picture: PNG, EXR, PFM, JPEG, TIFF, HDR, PNM");
    verb.argument("B", compare.reference,
                  "reference picture, of the same size and number of channels");
    verb.value("--max-rmse", "X", compare.max_rmse, parse_limit, "exit 1 if the RMSE exceeds X");
    verb.value("--max-abs", "X", compare.max_abs, parse_limit,
               "exit 1 if any channel differs by more than X");
    verb.value("--max-pixels", "N", compare.max_pixels,
               count_in(0, std::numeric_limits<int>::max()),
               "exit 1 if more than N pixels differ by over 1/255");
    verb.value("--heatmap", "FILE.png", compare.heatmap, parse_heatmap,
               "write a color map of the differences' square roots, from black to yellow");
    verb.value("--heatmap-scale", "X", compare.heatmap_scale, parse_scale,
               "difference shown as yellow (default: the largest)");
    verb.flag("--clamp", compare.clamp, "first clamp values to 0..1, as 8-bit files do");
    compare.results.add(verb, "--json", json_start("compare"),
                        "write JSON, to FILE or to stdout instead of the text");
    verb.run = [asked] { return run_compare(*asked); };
}

}  // namespace rt
