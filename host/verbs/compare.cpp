// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "host/base/console.h"
#include "host/base/counted.h"
#include "host/base/error.h"
#include "host/base/printable.h"
#include "host/base/usage_error.h"
#include "host/image/output_path.h"
#include "host/image/picture_io.h"
#include "host/measure/flip.h"
#include "host/measure/heatmap.h"
#include "host/print/print_image_error.h"
#include "host/print/print_run.h"
#include "host/print/print_stats.h"
#include "host/print/result_file.h"
#include "host/verbs/verbs.h"

namespace rt {

namespace {

using Json = nlohmann::ordered_json;

struct Comparison {
    Picture picture, reference;
    ImageError error;
    std::optional<FlipResult> flip;     ///< if requested
    double heatmap_scale = 0;           ///< if there is a heat map
    std::vector<std::string> breaches;  ///< why it fails, in words

    std::size_t pixels() const {
        return picture.pixels.size() / static_cast<std::size_t>(picture.channels);
    }
    bool identical() const { return error.max == 0 && error.non_finite == 0; }
};

/// NaN and infinities stay, to be counted.
void clamp_finite(Picture& picture) {
    for (float& value : picture.pixels) {
        if (std::isfinite(value)) value = std::clamp(value, 0.0f, 1.0f);
    }
}

void check_same_shape(const Picture& a, const Picture& b, const CompareOptions& options) {
    if (have_same_shape(a, b)) return;
    throw Error(ExitCode::input,
                fmt::format("{} has {}x{} pixels and {}, but {} has {}x{} and {}; compare "
                            "pictures of the same size and channels",
                            options.picture, a.width, a.height, counted(a.channels, "channel"),
                            options.reference, b.width, b.height, b.channels));
}

FlipResult flip_of(const Comparison& result) {
    if (result.error.non_finite > 0) return {{}, "some pixels are not finite"};
    return measure_flip(result.picture, result.reference);
}

std::string non_finite_text(const char* name, const Picture& picture) {
    const std::size_t count = count_non_finite(picture);
    if (count == 0) return "";
    const auto [x, y] = first_non_finite(picture);
    return fmt::format("{} of {} not finite, the first at {},{}", counted(count, "pixel"), name, x,
                       y);
}

/// A threshold that cannot be checked is an error, not a pass.
void check_flip(const FlipResult& flip, double limit, std::vector<std::string>& breaches) {
    if (!flip.mean) usage_error("--max-flip: cannot measure FLIP: {}", flip.note);
    if (!(*flip.mean <= limit)) {
        breaches.push_back(fmt::format("FLIP {:.4g} exceeds --max-flip {:.4g}", *flip.mean, limit));
    }
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
    if (options.max_flip && error.non_finite == 0) {
        check_flip(*result.flip, *options.max_flip, breaches);
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
        clamp_finite(result.picture);
        clamp_finite(result.reference);
    }
    result.error = image_error(result.picture, result.reference);
    if (options.flip || options.max_flip) result.flip = flip_of(result);
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
    if (result.flip) {
        text +=
            result.flip->mean
                ? fmt::format("  FLIP        {:.4e} ({})\n", *result.flip->mean, result.flip->note)
                : fmt::format("  FLIP        not measured: {}\n", result.flip->note);
    }
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
              {"breaches", result.breaches},           {"error", error_json(result.error)}};
    if (result.error.non_finite == result.pixels()) json["error"] = nullptr;
    if (result.flip) {
        const FlipResult& flip = *result.flip;
        json["flip"] = {{"mean", flip.mean ? Json(*flip.mean) : Json(nullptr)},
                        {"note", flip.note}};
    }
    if (!options.heatmap.empty()) {
        json["heatmap"] = {{"path", printable(options.heatmap)}, {"scale", result.heatmap_scale}};
    }
    return json;
}

void print_comparison(const Comparison& result, const CompareOptions& options) {
    const std::string json = json_text(comparison_json(result, options));
    if (options.json == "-") return print_result(json);
    write_result(options.json, json);
    print_result(comparison_text(result, options));
}

}  // namespace

int run_compare(const CompareOptions& options) {
    for (const std::string& output : {options.heatmap, options.json}) {
        check_output_is_no_input(output, {options.picture, options.reference});
    }
    if (!options.heatmap.empty()) check_picture_path(options.heatmap);
    check_result_path(options.json, json_start("mirrorball-compare"));
    check_outputs_differ({options.heatmap, options.json});
    const Comparison result = compare_pictures(options);
    if (!options.heatmap.empty()) write_heatmap(result, options);
    print_comparison(result, options);
    if (result.breaches.empty()) return static_cast<int>(ExitCode::done);
    print_note(fmt::format("{}", fmt::join(result.breaches, "; ")));
    return static_cast<int>(ExitCode::different);
}

}  // namespace rt
