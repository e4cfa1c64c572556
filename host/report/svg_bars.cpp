// SPDX-License-Identifier: Apache-2.0
#include "host/report/svg_bars.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "host/report/html.h"
#include "host/report/svg_parts.h"

namespace rt {

namespace {

constexpr double chart_width = 620, bar_height = 22, row_height = 52, top = 8;
constexpr double left = 12, right = 520;  ///< of the longest bar; its total stands to the right
constexpr double least_width_with_text = 62;

double total_of(const Bar& bar) {
    double total = 0;
    for (const BarPart& part : bar.parts) total += part.seconds;
    return total;
}

std::string part_svg(const BarPart& part, double x, double y, double width) {
    std::string svg = fmt::format(
        "<rect class=\"part p{}\" x=\"{:.2f}\" y=\"{:.1f}\" width=\"{:.2f}\" "
        "height=\"{:g}\"><title>{}</title></rect>\n",
        part.style, x, y, width, bar_height,
        html_text(part.label + " " + duration_text(part.seconds)));
    if (width >= least_width_with_text) {
        svg += svg_label(x + width / 2, y + 15.5, "middle", part.label,
                         fmt::format("small on-part on-p{}", part.style));
    }
    return svg;
}

std::string bar_svg(const Bar& bar, double y, double longest) {
    const double scale = longest > 0 ? (right - left) / longest : 0;
    std::string svg = "<g" + html_attribute("data-source", bar.source) + ">\n";
    svg += svg_label(left, y + 14, "start", bar.label);
    double x = left;
    for (const BarPart& part : bar.parts) {
        const double width = part.seconds * scale;
        if (width < 0.05) continue;
        svg += part_svg(part, x, y + 21, width);
        x += width;
    }
    svg += svg_label(x + 8, y + 37, "start", duration_text(total_of(bar)), "strong");
    return svg + "</g>\n";
}

}  // namespace

std::string svg_bars(const BarChart& chart) {
    double longest = 0;
    for (const Bar& bar : chart.bars) longest = std::max(longest, total_of(bar));
    const double height = top + row_height * static_cast<double>(chart.bars.size());
    std::string svg = svg_open(chart.id, chart_width, height, chart.title, chart.description);
    double y = top;
    for (const Bar& bar : chart.bars) {
        svg += bar_svg(bar, y, longest);
        y += row_height;
    }
    return svg + "</svg>\n";
}

std::string bars_legend(const BarChart& chart) {
    std::map<int, std::string> kinds;
    for (const Bar& bar : chart.bars) {
        for (const BarPart& part : bar.parts) {
            if (part.seconds > 0) kinds.emplace(part.style, part.label);
        }
    }
    std::string html = "<ul class=\"legend\">\n";
    for (const auto& [style, label] : kinds) {
        html += fmt::format(
            "<li><svg viewBox=\"0 0 14 14\" class=\"box\" aria-hidden=\"true\">"
            "<rect class=\"part p{}\" width=\"14\" height=\"14\"/></svg> {}</li>\n",
            style, html_text(label));
    }
    return html + "</ul>\n";
}

}  // namespace rt
