// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/report/plot_axis.h"

namespace rt {

/// The inside of a plot, in the drawing's units, y downwards.
struct PlotFrame {
    double left, top, right, bottom;
};

/// Opens an <svg> of this size with role, title and description for screen readers.
std::string svg_open(const std::string& id, double width, double height, const std::string& title,
                     const std::string& description);

/// Grid lines, numbers and labels of both axes, and the frame's edges.
std::string svg_axes(const PlotFrame& frame, const Axis& x, const Axis& y);

/// Approximate width of a text in drawing units, for the font on narrow screens, which is the
/// largest.
double svg_text_width(const std::string& text);

/// Text at a point; the anchor is start, middle or end.
std::string svg_label(double x, double y, const char* anchor, const std::string& text,
                      const std::string& css_class = "");

/// One of eight shapes around a point, with a tooltip and a source where they are given.
std::string svg_marker(int style, double x, double y, const std::string& title = "",
                       const std::string& source = "");

}  // namespace rt
