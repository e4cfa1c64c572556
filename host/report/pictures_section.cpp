// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/base/text.h"
#include "host/image/picture_io.h"
#include "host/measure/heatmap.h"
#include "host/measure/picture_judge.h"
#include "host/report/html.h"
#include "host/report/labels.h"
#include "host/report/plot_axis.h"
#include "host/report/rows.h"
#include "host/report/sections.h"

namespace rt {

namespace {

constexpr double error_map_scale = 0.25;  ///< the difference at the top of the color map

struct Image {
    std::string alt, caption;
    std::string source;
    std::optional<Rect> marked = std::nullopt;  ///< framed in the picture
};

/// A frame around a window of a picture, in black and white to stand out on anything.
std::string frame_svg(const Picture& picture, const Rect& window) {
    const auto box = [&](const char* css_class) {
        return fmt::format("<rect class=\"{}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>",
                           css_class, window.x, window.y, window.width, window.height);
    };
    return fmt::format("<svg class=\"mark\" viewBox=\"0 0 {} {}\" aria-hidden=\"true\">{}{}</svg>",
                       picture.width, picture.height, box("under"), box("over"));
}

std::string image_figure(const Picture& picture, const Image& image) {
    return fmt::format(
        "<figure{}><div class=\"picture\"><img src=\"{}\" width=\"{}\" height=\"{}\"{}>{}</div>"
        "<figcaption>{}</figcaption></figure>\n",
        image.source.empty() ? "" : html_attribute("data-source", image.source),
        png_data_uri(encode_png(picture, Encoding::display)), picture.width, picture.height,
        html_attribute("alt", image.alt), image.marked ? frame_svg(picture, *image.marked) : "",
        html_text(image.caption));
}

Picture cropped(const Picture& picture, const Rect& window) {
    Picture part{window.width, window.height, picture.channels, {}};
    for (int y = window.y; y < window.y + window.height; ++y) {
        const auto first =
            picture.pixels.begin() +
            (static_cast<std::ptrdiff_t>(y) * picture.width + window.x) * picture.channels;
        part.pixels.insert(part.pixels.end(), first,
                           first + static_cast<std::ptrdiff_t>(window.width) * picture.channels);
    }
    return part;
}

/// Sum of the differences within a window.
double difference_in(const Picture& a, const Picture& b, const Rect& window) {
    const Picture part_a = cropped(a, window), part_b = cropped(b, window);
    double sum = 0;
    for (std::size_t i = 0; i < part_a.pixels.size(); ++i) {
        const double difference = std::fabs(std::clamp(part_a.pixels[i], 0.0f, 1.0f) -
                                            std::clamp(part_b.pixels[i], 0.0f, 1.0f));
        if (std::isfinite(difference)) sum += difference;
    }
    return sum;
}

/// The square window, a fifth of the width, where anti-aliasing changes the picture most.
Rect telling_window(const Picture& plain, const Picture& smooth) {
    const int side = std::min({std::max(16, plain.width / 5), plain.width, plain.height});
    const int step = std::max(1, side / 4);
    Rect best{0, 0, side, side};
    double most = -1;
    for (int y = 0; y + side <= plain.height; y += step) {
        for (int x = 0; x + side <= plain.width; x += step) {
            const double difference = difference_in(plain, smooth, {x, y, side, side});
            if (difference <= most) continue;
            most = difference;
            best = {x, y, side, side};
        }
    }
    return best;
}

std::string error_text(const RenderStats& stats) {
    const ImageError& error = *stats.error;
    return fmt::format(
        "RMSE {}, PSNR {}\u00a0dB, {} of {} pixels off by more than 1/255, {} by more than 8/255",
        scientific_text(error.rmse), significant(error.psnr, 3), error.over_1,
        stats.region.pixels(), error.over_8);
}

/// The picture's own run is one of many, so the time is the benchmark's median, if it has one.
std::string made_text(const RenderStats& stats, const BenchResult& bench) {
    const auto seconds = trace_median(bench, stats);
    return fmt::format("{}, {}{}, {}", sampling_text(stats.aa),
                       seconds ? "traced in " + duration_text(*seconds) + " on " : "on ",
                       device_label(stats), precision_name(stats.double_precision));
}

std::string color_scale() {
    Picture bar{128, 1, 3, {}};
    for (int i = 0; i < bar.width; ++i) {
        const auto color = heat_color(i / 127.0);
        bar.pixels.insert(bar.pixels.end(), color.begin(), color.end());
    }
    return fmt::format(
        "<p class=\"scale\">0 <img src=\"{}\" alt=\"Color scale of the error maps: black for no "
        "difference over purple and orange to pale yellow for {} and more\"> {} or more, where "
        "black to white is 1</p>\n",
        png_data_uri(encode_png(bar, Encoding::display)), error_map_scale, error_map_scale);
}

std::string whole_pictures(const ReportScene& scene, const Rect& window,
                           const std::string& source) {
    const std::string name = scene.plain.stats.scene.name;
    const auto figure = [&](const ReportPicture& shot, const char* kind, const char* key) {
        return image_figure(shot.picture,
                            {fmt::format("{}, {}", name, kind),
                             fmt::format("{}: {}.", kind, made_text(shot.stats, scene.bench)),
                             source + key, window});
    };
    return "<div class=\"pictures\">\n" + figure(scene.plain, "Plain", "/plain") +
           figure(scene.smooth, "Anti-aliased", "/smooth") + "</div>\n";
}

std::string crops(const ReportScene& scene, const Rect& window) {
    const std::string where =
        fmt::format("{} pixels from {},{}, enlarged", size_text(window.width, window.height),
                    window.x, window.y);
    const auto figure = [&](const Picture& picture, const char* kind) {
        return image_figure(cropped(picture, window),
                            {fmt::format("{} crop of {}", kind, scene.plain.stats.scene.name),
                             fmt::format("{}: {}.", kind, where), ""});
    };
    return "<h3>Edges, close up</h3>\n<p>The part of the picture that anti-aliasing changes "
           "most: the frame in the pictures above.</p>\n<div class=\"pictures three pixels\">\n" +
           figure(scene.plain.picture, "Plain") + figure(scene.smooth.picture, "Anti-aliased") +
           figure(scene.reference, "Converged") + "</div>\n";
}

std::string error_maps(const ReportScene& scene, const std::string& source) {
    const auto figure = [&](const ReportPicture& shot, const char* kind, const char* key) {
        return image_figure(
            heat_map(clamped(shot.picture), scene.reference, error_map_scale),
            {fmt::format("Error map of the {} picture: bright along edges where it is wrong. {}",
                         kind, error_text(shot.stats)),
             fmt::format("{}: {}.", kind, error_text(shot.stats)), source + key});
    };
    return fmt::format(
               "<h3>Error maps</h3>\n<p>The largest channel difference of each pixel from the "
               "converged picture: the mean of two pictures in double precision, {} and {}.</p>\n",
               html_text(scene.converge.reference.aa_a), html_text(scene.converge.reference.aa_b)) +
           "<div class=\"pictures\">\n" + figure(scene.plain, "Plain", "/plain/error") +
           figure(scene.smooth, "Anti-aliased", "/smooth/error") + "</div>\n" + color_scale();
}

}  // namespace

std::string pictures_section(const ReportScene& scene, std::size_t index) {
    const std::string source = fmt::format("pictures-{}#", index);
    const Rect window = telling_window(scene.plain.picture, scene.smooth.picture);
    return "<h3>Pictures</h3>\n" + whole_pictures(scene, window, source) + crops(scene, window) +
           error_maps(scene, source);
}

}  // namespace rt
