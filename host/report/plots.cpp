// SPDX-License-Identifier: Apache-2.0
#include "host/report/plots.h"

#include "host/report/html.h"

namespace rt {

std::string plot_figure(const Plot& plot, const std::string& caption) {
    return "<figure class=\"plot\">" + svg_plot(plot) + "<figcaption>" + caption +
           "</figcaption></figure>\n";
}

PlotPoint plain_point(double x, double y, const std::string& title, const std::string& source) {
    PlotPoint point;
    point.x = point.x_low = point.x_high = x;
    point.y = point.y_low = point.y_high = y;
    point.title = title;
    point.source = source;
    return point;
}

void fit_axes(Plot& plot) {
    std::vector<double> x, y;
    for (const PlotCurve& curve : plot.curves) {
        for (const PlotPoint& point : curve.points) {
            x.insert(x.end(), {point.x, point.x_low, point.x_high});
            y.insert(y.end(), {point.y, point.y_low, point.y_high});
        }
    }
    plot.x = axis_around(plot.x.label, x, plot.x.logarithmic, plot.x.unit);
    plot.y = axis_around(plot.y.label, y, plot.y.logarithmic, plot.y.unit);
}

}  // namespace rt
