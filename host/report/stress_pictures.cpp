// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/image/picture_io.h"
#include "host/measure/heatmap.h"
#include "host/report/html.h"
#include "host/report/sections.h"
#include "host/report/stress_margins.h"

namespace rt {

namespace {

constexpr double map_scale = 1.0 / 255;  ///< the difference at the top of the color map
constexpr int most_families = 4;
constexpr int most_pixels = 160 * 120;  ///< of a picture on the page

/// Clamped to [0, 1]; NaN as white.
Picture shown(Picture picture) {
    for (float& value : picture.pixels) {
        value = std::isnan(value) ? 1.0F : std::clamp(value, 0.0F, 1.0F);
    }
    return picture;
}

std::string figure(const Picture& picture, const std::string& alt, const char* caption) {
    return fmt::format(
        "<figure><img src=\"{}\" width=\"{}\" height=\"{}\"{}><figcaption>{}</figcaption>"
        "</figure>\n",
        png_data_uri(encode_png(picture, Encoding::display)), picture.width, picture.height,
        html_attribute("alt", alt), html_text(caption));
}

std::string shot_figures(const StressFamilyResult& family) {
    const StressShot& shot = *family.shot;
    const std::string name = family.name + "/" + shot.label;
    const Picture worst = shown(shot.worst), reference = shown(shot.reference);
    return fmt::format("<h4>{}</h4>\n<div class=\"pictures three pixels\">\n", html_text(name)) +
           figure(reference, name + ", reference", "Reference.") +
           figure(worst, name + ", worst of mirrorball's pictures", "Worst of mirrorball's.") +
           figure(heat_map(worst, reference, map_scale), name + ", error map",
                  "Difference, 1/255 and more at the top of the color map.") +
           "</div>\n";
}

bool fits_page(const StressFamilyResult& family) {
    return family.shot && family.shot->worst.width * family.shot->worst.height <= most_pixels;
}

}  // namespace

std::string stress_pictures(const StressResult& result) {
    std::string html;
    int shown_families = 0;
    for (const std::size_t i : by_margin(result)) {
        const StressFamilyResult& family = result.families[i];
        if (!fits_page(family) || shown_families == most_families) continue;
        html += shot_figures(family);
        ++shown_families;
    }
    if (html.empty()) return "";
    return "<h3>Worst pictures</h3>\n"
           "<p>From the families with the smallest margin to their tolerance.</p>\n" +
           html;
}

}  // namespace rt
