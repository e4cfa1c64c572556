// SPDX-License-Identifier: Apache-2.0
#include "host/report/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/report/html.h"
#include "host/report/label_placer.h"
#include "host/report/svg_parts.h"

namespace rt {

namespace {

// Small, so that type stays readable where the drawing is scaled to a narrow screen; names of
// curves that end at the right edge stand outside the frame.
constexpr double plot_width = 480, plot_height = 330;
constexpr PlotFrame frame{64, 34, 396, 278};
constexpr double shared_label_distance = 60;  ///< nearer points of one label share it
constexpr double curve_label_reach = 36;      ///< the curve's color ties a distant name to it

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
            frame.left, top, frame.right - frame.left, frame.bottom - top);
    }

    std::string floor_label() const {
        if (!plot_.floor) return "";
        const double top = std::clamp(y_.at(*plot_.floor), frame.top, frame.bottom);
        return svg_label(frame.right - 6, std::min(top + 15, frame.bottom - 5), "end",
                         plot_.floor_label, "small halo");
    }

    /// The noise range of the repeats: out along the low values, back along the high ones.
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
                svg_marker(curve.marker, x_.at(point.x), y_.at(point.y), point.title, point.source);
        }
        return svg;
    }

    /// From the curve's first point to where it would be with its kernels rebuilt.
    std::string build_offset(const PlotCurve& curve) const {
        if (curve.points.empty() || !curve.points.front().x_with_build) return "";
        const PlotPoint& point = curve.points.front();
        const double y = y_.at(point.y);
        const double to = std::min(x_.at(*point.x_with_build), frame.right);
        return fmt::format(
            "<path class=\"offset\" d=\"M{:.1f} {:.1f}H{:.1f}{}\">"
            "<title>{}</title></path>\n",
            x_.at(point.x), y, to, to < frame.right ? "m0 -5v10" : "",
            html_text(point.title +
                      "; with its kernels built: " + duration_text(*point.x_with_build)));
    }

    std::string curve(const PlotCurve& curve) const {
        std::string svg = fmt::format("<g class=\"s{} d{}{}\">\n", curve.color % plot_styles,
                                      curve.dash % plot_styles, curve.is_hollow ? " hollow" : "");
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

    /// Names of curves, then of points, where there is room for them.
    std::string labels() const {
        LabelPlacer placer({frame.left + 2, 2, plot_width - 2, frame.bottom - 2});
        avoid_ink(placer);
        std::string svg;
        for (const PlotCurve& curve : plot_.curves) svg += curve_label(placer, curve);
        if (!plot_.front.empty()) {
            svg += placed_label(placer, plot_.front_label, spots_of(plot_.front), "small halo");
        }
        for (const PlotCurve& curve : plot_.curves) {
            for (const PlotPoint& point : curve.points) {
                if (has_labeled_neighbor(point)) continue;
                svg += placed_label(placer, point.label, spots_of({point}), "small halo");
            }
        }
        return svg;
    }

   private:
    using Spots = std::vector<std::pair<double, double>>;

    /// Whether an earlier point with the same label is so close that one label serves both.
    bool has_labeled_neighbor(const PlotPoint& point) const {
        for (const PlotCurve& curve : plot_.curves) {
            for (const PlotPoint& other : curve.points) {
                if (&other == &point) return false;
                const double distance =
                    std::hypot(x_.at(other.x) - x_.at(point.x), y_.at(other.y) - y_.at(point.y));
                if (other.label == point.label && distance < shared_label_distance) return true;
            }
        }
        return false;
    }

    void avoid_ink(LabelPlacer& placer) const {
        placer.avoid_box({frame.left, 0, frame.right, frame.top - 8});  // the y axis' name
        if (plot_.floor) {
            const double top = std::clamp(y_.at(*plot_.floor), frame.top, frame.bottom);
            placer.avoid_box({frame.left, top, frame.right, top + 19});
        }
        for (const PlotCurve& curve : plot_.curves) {
            const Spots spots = spots_of(curve.points);
            for (std::size_t i = 0; i < spots.size(); ++i) {
                const auto [x, y] = spots[i];
                const auto [next_x, next_y] = spots[std::min(i + 1, spots.size() - 1)];
                placer.avoid_line(x, y, next_x, next_y);
                placer.avoid_line(x - 5, y, x + 5, y);
            }
            if (curve.points.empty() || !curve.points.front().x_with_build) continue;
            placer.avoid_line(spots[0].first, spots[0].second,
                              x_.at(*curve.points.front().x_with_build), spots[0].second);
        }
        const Spots steps = spots_of(plot_.front);
        for (std::size_t i = 0; i < steps.size(); ++i) {
            const double to = i + 1 < steps.size() ? steps[i + 1].first : frame.right;
            placer.avoid_line(steps[i].first, steps[i].second, to, steps[i].second);
            if (i + 1 < steps.size())
                placer.avoid_line(to, steps[i].second, to, steps[i + 1].second);
        }
    }

    /// Beside the curve's last point, else its first, else any.
    std::string curve_label(LabelPlacer& placer, const PlotCurve& curve) const {
        Spots spots = spots_of(curve.points);
        if (spots.size() > 1) std::swap(spots.front(), spots.back());
        if (spots.size() > 2) std::swap(spots[1], spots.back());
        return placed_label(placer, curve.label, spots,
                            fmt::format("small halo name-of-curve s{}", curve.color % plot_styles),
                            curve_label_reach);
    }

    std::string placed_label(LabelPlacer& placer, const std::string& text, const Spots& spots,
                             const std::string& css_class, double reach = 0) const {
        if (text.empty()) return "";
        const auto place = placer.place(text, spots, reach);
        return place ? svg_label(place->x, place->y, place->anchor, text, css_class) : "";
    }

    Spots spots_of(const std::vector<PlotPoint>& points) const {
        Spots spots;
        for (const PlotPoint& point : points) spots.emplace_back(x_.at(point.x), y_.at(point.y));
        return spots;
    }

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
    return svg + painter.floor_label() + painter.labels() + "</svg>\n";
}

}  // namespace rt
