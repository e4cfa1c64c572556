// SPDX-License-Identifier: Apache-2.0
#include "host/report/bars.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/report/html.h"
#include "host/report/plot_axis.h"

namespace rt {

namespace {

constexpr double full_width = 1000, bar_height = 20;  ///< of the longest bar; stretched by the page
constexpr double least_share = 0.005, least_other = 0.001;
constexpr int other_shade = 0;

double drawn_seconds(const Bar& bar) {
    double total = 0;
    for (const BarPart& part : bar.parts) total += part.seconds;
    return total;
}

std::vector<BarPart> named_parts(const Bar& bar) {
    std::vector<BarPart> parts;
    BarPart other{"other", 0, other_shade};
    const double least = least_share * drawn_seconds(bar);
    for (const BarPart& part : bar.parts) {
        if (part.seconds >= least && part.seconds > 0) {
            parts.push_back(part);
        } else {
            other.seconds += part.seconds;
        }
    }
    if (other.seconds > least_other * drawn_seconds(bar)) parts.push_back(other);
    return parts;
}

std::string bar_html(const Bar& bar, double longest) {
    std::string drawing, list;
    double x = 0;
    for (const BarPart& part : named_parts(bar)) {
        const double width = longest > 0 ? full_width * part.seconds / longest : 0;
        const std::string text = html_text(part.label + " " + duration_text(part.seconds));
        drawing += fmt::format(
            "<rect class=\"part p{}\" x=\"{:.2f}\" width=\"{:.2f}\" height=\"{:g}\"><title>{}"
            "</title></rect>\n",
            part.shade, x, width, bar_height, text);
        list += fmt::format(
            "<li><svg class=\"box\" viewBox=\"0 0 10 10\" aria-hidden=\"true\"><rect class=\"part "
            "p{}\" width=\"10\" height=\"10\"/></svg>{}</li>\n",
            part.shade, text);
        x += width;
    }
    return fmt::format(
        "<div class=\"bar s{}\"{}>\n<p>{} <strong>{}</strong></p>\n<svg viewBox=\"0 0 {:g} {:g}\" "
        "preserveAspectRatio=\"none\" aria-hidden=\"true\">\n{}</svg>\n<ul>\n{}</ul>\n</div>\n",
        bar.color, html_attribute("data-source", bar.source), html_text(bar.label),
        duration_text(bar.total), full_width, bar_height, drawing, list);
}

}  // namespace

std::string bars_html(const std::string& title, const std::vector<Bar>& bars) {
    double longest = 0;
    for (const Bar& bar : bars) longest = std::max(longest, drawn_seconds(bar));
    std::string html =
        "<div class=\"bars\" role=\"group\"" + html_attribute("aria-label", title) + ">\n";
    for (const Bar& bar : bars) html += bar_html(bar, longest);
    return html + "</div>\n";
}

}  // namespace rt
