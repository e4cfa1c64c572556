// SPDX-License-Identifier: Apache-2.0
#include "host/report/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/report/html.h"
#include "host/report/svg_parts.h"

namespace rt {

namespace {

constexpr double plot_width = 620, plot_height = 400;
constexpr PlotFrame frame{72, 34, 604, 344};

/// Draws the parts of one plot, each as a piece of SVG.
class Painter {
   public:
    explicit Painter(const Plot& plot)
        : plot_(plot), x_(plot.x, frame.left, frame.right), y_(plot.y, frame.bottom, frame.top) {}

    std::string floor() const {
        if (!plot_.floor) return "";
        const double top = std::clamp(y_.at(*plot_.floor), frame.top, frame.bottom);
        return fmt::format(
                   "<rect class=\"floor\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
                   "height=\"{:.1f}\"/>\n",
                   frame.left, top, frame.right - frame.left, frame.bottom - top) +
               svg_label(frame.right - 6, std::min(top + 15, frame.bottom - 5), "end",
                         plot_.floor_label, "small");
    }

    /// The range of the repeats: along one edge of low values, back along the high ones.
    std::string band(const PlotCurve& curve) const {
        std::string path;
        for (const PlotPoint& point : curve.points) path += step(point.x_low, point.y_low, path);
        for (auto point = curve.points.rbegin(); point != curve.points.rend(); ++point) {
            path += step(point->x_high, point->y_high, path);
        }
        return path.empty() ? "" : "<path class=\"band\" d=\"" + path + "z\"/>\n";
    }

    std::string line(const PlotCurve& curve) const {
        std::string path;
        for (const PlotPoint& point : curve.points) path += step(point.x, point.y, path);
        const char* css_class = curve.is_prediction ? "line prediction" : "line";
        return fmt::format("<path class=\"{}\" d=\"{}\"/>\n", css_class, path);
    }

    std::string markers(const PlotCurve& curve) const {
        std::string svg;
        for (const PlotPoint& point : curve.points) {
            svg +=
                svg_marker(curve.shape, x_.at(point.x), y_.at(point.y), point.title, point.source);
        }
        return svg;
    }

    /// From the curve's first point to where it would be with its kernels built anew.
    std::string build_offset(const PlotCurve& curve) const {
        if (curve.points.empty() || !curve.points.front().x_with_build) return "";
        const PlotPoint& point = curve.points.front();
        const double y = y_.at(point.y);
        const double to = std::min(x_.at(*point.x_with_build), frame.right);
        return fmt::format(
            "<path class=\"offset\" d=\"M{:.1f} {:.1f}H{:.1f}m0 -5v10\">"
            "<title>{}</title></path>\n",
            x_.at(point.x), y, to,
            html_text(curve.label +
                      " with its kernels built: " + duration_text(*point.x_with_build)));
    }

    std::string curve(const PlotCurve& curve) const {
        std::string svg = fmt::format("<g class=\"s{} d{}\">\n", curve.color % plot_styles,
                                      curve.shape % plot_styles);
        if (!curve.is_prediction) svg += band(curve) + build_offset(curve);
        svg += line(curve);
        if (!curve.is_prediction) svg += markers(curve);
        return svg + "</g>\n";
    }

    std::string front() const {
        std::string path;
        for (const PlotPoint& point : plot_.front) {
            const double x = x_.at(point.x), y = y_.at(point.y);
            path += path.empty() ? fmt::format("M{:.1f} {:.1f}", x, y)
                                 : fmt::format("H{:.1f}V{:.1f}", x, y);
        }
        if (path.empty()) return "";
        return fmt::format("<path class=\"front\" d=\"{}H{:.1f}\"/>\n", path, frame.right);
    }

    /// Names beside points, each only where no earlier one stands.
    std::string labels() const {
        std::string svg;
        std::vector<std::pair<double, double>> taken;
        for (const PlotCurve& curve : plot_.curves) {
            for (const PlotPoint& point : curve.points) {
                if (point.label.empty()) continue;
                const double x = x_.at(point.x) + 8, y = y_.at(point.y) - 8;
                const bool free = std::none_of(taken.begin(), taken.end(), [&](const auto& other) {
                    return std::fabs(other.first - x) < 74 && std::fabs(other.second - y) < 15;
                });
                const bool inside = x < frame.right - 60;
                if (!free) continue;
                taken.emplace_back(x, y);
                svg += svg_label(inside ? x : x - 16, y, inside ? "start" : "end", point.label,
                                 "small halo");
            }
        }
        return svg;
    }

   private:
    std::string step(double x, double y, const std::string& before) const {
        return fmt::format("{}{:.1f} {:.1f}", before.empty() ? "M" : "L", x_.at(x), y_.at(y));
    }

    const Plot& plot_;
    const AxisScale x_, y_;
};

}  // namespace

std::string svg_plot(const Plot& plot) {
    const Painter painter(plot);
    std::string svg = svg_open(plot.id, plot_width, plot_height, plot.title, plot.description);
    svg += painter.floor() + svg_axes(frame, plot.x, plot.y) + painter.front();
    for (const PlotCurve& curve : plot.curves) svg += painter.curve(curve);
    return svg + painter.labels() + "</svg>\n";
}

std::string plot_legend(const Plot& plot) {
    std::string html = "<ul class=\"legend\">\n";
    const auto item = [&](const std::string& drawing, const std::string& label) {
        html += "<li><svg viewBox=\"0 0 34 14\" aria-hidden=\"true\" focusable=\"false\">" +
                drawing + "</svg> " + html_text(label) + "</li>\n";
    };
    for (const PlotCurve& curve : plot.curves) {
        const std::string marker = curve.is_prediction ? "" : svg_marker(curve.shape, 17, 7);
        item(fmt::format("<g class=\"s{} d{}\"><path class=\"line{}\" d=\"M1 7H33\"/>{}</g>",
                         curve.color % plot_styles, curve.shape % plot_styles,
                         curve.is_prediction ? " prediction" : "", marker),
             curve.label);
    }
    if (!plot.front.empty()) item("<path class=\"front\" d=\"M1 7H33\"/>", plot.front_label);
    return html + "</ul>\n";
}

}  // namespace rt
