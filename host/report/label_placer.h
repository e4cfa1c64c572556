// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rt {

/// A rectangle of a drawing, y downwards.
struct DrawnBox {
    double left = 0, top = 0, right = 0, bottom = 0;
};

/// Position of a label: the start, middle or end of its baseline.
struct LabelPlace {
    double x = 0, y = 0;
    const char* anchor = "start";
    DrawnBox box;
};

/// Finds room for labels next to what they name: preferably off lines and markers, never over
/// another label or outside. Greedy, in the order of the calls.
class LabelPlacer {
   public:
    explicit LabelPlacer(const DrawnBox& bounds) : bounds_(bounds) {}

    void avoid_line(double x1, double y1, double x2, double y2);
    void avoid_box(const DrawnBox& box) { taken_.push_back(box); }

    /// A place beside one of the spots or up to `reach` farther out, earlier and nearer ones
    /// preferred; empty if the label would overlap another one or the bounds everywhere.
    std::optional<LabelPlace> place(const std::string& text,
                                    const std::vector<std::pair<double, double>>& spots,
                                    double reach = 0);

   private:
    double cost_of(const DrawnBox& box) const;

    DrawnBox bounds_;
    std::vector<DrawnBox> taken_;
    std::vector<std::pair<double, double>> inked_;
};

}  // namespace rt
