// SPDX-License-Identifier: Apache-2.0
#include "host/report/svg_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "host/base/text.h"
#include "host/report/html.h"

namespace rt {

namespace {

constexpr int most_x_labels = 8;
constexpr int most_y_labels = 8;

std::string line(double x1, double y1, double x2, double y2, const char* css_class) {
    return fmt::format(
        "<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", css_class,
        x1, y1, x2, y2);
}

/// Those with numbers, by priority: the first, the last, those that begin with a 1, the others.
std::vector<Tick*> by_priority(std::vector<Tick>& ticks) {
    std::vector<Tick*> order;
    for (Tick& tick : ticks) {
        if (!tick.label.empty()) order.push_back(&tick);
    }
    std::ranges::sort(order, {}, [](const Tick* tick) { return tick->value; });
    if (order.size() < 3) return order;
    std::rotate(order.begin() + 1, order.end() - 1, order.end());
    std::stable_partition(order.begin() + 2, order.end(),
                          [](const Tick* tick) { return tick->label.starts_with('1'); });
    return order;
}

/// The ticks, with numbers only where they do not overlap.
std::vector<Tick> with_room(std::vector<Tick> ticks, const AxisScale& scale) {
    std::vector<std::pair<double, double>> taken;
    for (Tick* const tick : by_priority(ticks)) {
        const double at = scale.at(tick->value), half = svg_text_width(tick->label) / 2 + 3;
        const bool is_free = std::none_of(taken.begin(), taken.end(), [&](const auto& other) {
            return at - half < other.second && other.first < at + half;
        });
        if (is_free) taken.emplace_back(at - half, at + half);
        if (!is_free) tick->label.clear();
    }
    return ticks;
}

std::string marker_shape(int style, double x, double y) {
    const auto path = [&](const char* steps) {
        return fmt::format("<path class=\"marker\" d=\"M{:.1f} {:.1f}{}\">", x, y, steps);
    };
    switch (style % 8) {
        case 0:
            return fmt::format("<circle class=\"marker\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\">", x,
                               y);
        case 1:
            return path("m-3.7-3.7h7.4v7.4h-7.4z");
        case 2:
            return path("m0-5l4.7 8.2h-9.4z");
        case 3:
            return path("m0-5.2l5.2 5.2l-5.2 5.2l-5.2-5.2z");
        case 4:
            return path("m0 5l4.7-8.2h-9.4z");
        case 5:
            return path("m-5-1.6h3.4v-3.4h3.2v3.4h3.4v3.2h-3.4v3.4h-3.2v-3.4h-3.4z");
        case 6:
            return path("m-5-2.6h10v5.2h-10z");
        default:
            return path("m-2.6-5h5.2v10h-5.2z");
    }
}

}  // namespace

double svg_text_width(const std::string& text) {
    constexpr double character_width = 8.7;
    const auto characters =
        std::count_if(text.begin(), text.end(), [](char c) { return !is_utf8_continuation(c); });
    return character_width * static_cast<double>(characters);
}

std::string svg_open(const std::string& id, double width, double height, const std::string& title,
                     const std::string& description) {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:g} {:g}\" role=\"img\" "
        "aria-labelledby=\"{}-title {}-desc\"{}>\n<title id=\"{}-title\">{}</title>\n"
        "<desc id=\"{}-desc\">{}</desc>\n",
        width, height, html_text(id), html_text(id), html_attribute("id", id), html_text(id),
        html_text(title), html_text(id), html_text(description));
}

std::string svg_label(double x, double y, const char* anchor, const std::string& text,
                      const std::string& css_class) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y,
                       anchor, css_class.empty() ? "" : html_attribute("class", css_class),
                       html_text(text));
}

std::string svg_axes(const PlotFrame& frame, const Axis& x, const Axis& y) {
    const AxisScale x_scale(x, frame.left, frame.right), y_scale(y, frame.bottom, frame.top);
    std::string svg = "<g class=\"axes\">\n";
    for (const Tick& tick : with_room(axis_ticks(x, most_x_labels), x_scale)) {
        const double at = x_scale.at(tick.value);
        svg += line(at, frame.top, at, frame.bottom, tick.label.empty() ? "grid faint" : "grid");
        if (!tick.label.empty()) svg += svg_label(at, frame.bottom + 18, "middle", tick.label);
    }
    for (const Tick& tick : axis_ticks(y, most_y_labels)) {
        const double at = y_scale.at(tick.value);
        svg += line(frame.left, at, frame.right, at, tick.label.empty() ? "grid faint" : "grid");
        if (!tick.label.empty()) svg += svg_label(frame.left - 8, at + 4.5, "end", tick.label);
    }
    svg += line(frame.left, frame.bottom, frame.right, frame.bottom, "edge");
    svg += line(frame.left, frame.top, frame.left, frame.bottom, "edge");
    svg += svg_label((frame.left + frame.right) / 2, frame.bottom + 40, "middle", x.label, "name");
    svg += svg_label(4, frame.top - 16, "start", y.label, "name");
    return svg + "</g>\n";
}

std::string svg_marker(int style, double x, double y, const std::string& title,
                       const std::string& source) {
    const std::string shape = marker_shape(style, x, y);
    const std::string tip = title.empty() ? "" : "<title>" + html_text(title) + "</title>";
    const std::string group =
        source.empty() ? "<g>" : "<g" + html_attribute("data-source", source) + ">";
    const char* end = shape.starts_with("<circle") ? "</circle>" : "</path>";
    return group + shape + tip + end + "</g>\n";
}

}  // namespace rt
