// SPDX-License-Identifier: Apache-2.0
#include "host/report/label_placer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "host/report/svg_parts.h"

namespace rt {

namespace {

// Of the type on narrow screens.
constexpr double ascent = 13, descent = 4;
constexpr double ink_step = 5;      ///< between points sampled along a line
constexpr double ring_step = 12;    ///< between the distances at which a label may stand
constexpr double away_cost = 0.25;  ///< per unit of distance; a point of ink costs 3

struct Side {
    double dx, dy;
    const char* anchor;
};

constexpr std::array<Side, 8> sides{{{9, 4, "start"},
                                     {6, -8, "start"},
                                     {6, 18, "start"},
                                     {-6, -8, "end"},
                                     {-6, 18, "end"},
                                     {-9, 4, "end"},
                                     {0, -10, "middle"},
                                     {0, 20, "middle"}}};

/// Beside a spot, and `away` farther out than side by side.
LabelPlace beside(double x, double y, const Side& side, double away, double width) {
    const double dx = side.dx + std::copysign(side.dx == 0 ? 0 : away, side.dx);
    const bool is_level = side.dy == 4;
    const double dy = side.dy + std::copysign(is_level ? 0 : away, side.dy);
    LabelPlace place{x + dx, y + dy, side.anchor, {}};
    const double start = side.anchor[0] == 's'   ? place.x
                         : side.anchor[0] == 'e' ? place.x - width
                                                 : place.x - width / 2;
    place.box = {start, place.y - ascent, start + width, place.y + descent};
    return place;
}

bool overlap(const DrawnBox& a, const DrawnBox& b) {
    return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

}  // namespace

void LabelPlacer::avoid_line(double x1, double y1, double x2, double y2) {
    const int steps = 1 + static_cast<int>(std::hypot(x2 - x1, y2 - y1) / ink_step);
    for (int i = 0; i <= steps; ++i) {
        const double t = static_cast<double>(i) / steps;
        inked_.emplace_back(x1 + t * (x2 - x1), y1 + t * (y2 - y1));
    }
}

/// Infinite where a label is not allowed.
double LabelPlacer::cost_of(const DrawnBox& box) const {
    const bool inside = box.left >= bounds_.left && box.right <= bounds_.right &&
                        box.top >= bounds_.top && box.bottom <= bounds_.bottom;
    const bool is_free = std::none_of(taken_.begin(), taken_.end(),
                                      [&](const DrawnBox& other) { return overlap(box, other); });
    if (!inside || !is_free) return std::numeric_limits<double>::infinity();
    return 3.0 *
           static_cast<double>(std::count_if(inked_.begin(), inked_.end(), [&](const auto& p) {
               return p.first > box.left && p.first < box.right && p.second > box.top &&
                      p.second < box.bottom;
           }));
}

std::optional<LabelPlace> LabelPlacer::place(const std::string& text,
                                             const std::vector<std::pair<double, double>>& spots,
                                             double reach) {
    const double width = svg_text_width(text);
    double least = std::numeric_limits<double>::infinity(), detour = 0;
    std::optional<LabelPlace> best;
    for (const auto& [x, y] : spots) {
        for (const Side& side : sides) {
            for (double away = 0; away <= reach; away += ring_step) {
                const LabelPlace place = beside(x, y, side, away, width);
                const double cost = cost_of(place.box) + detour + away_cost * away;
                if (!(cost < least)) continue;
                least = cost;
                best = place;
            }
            detour += 0.5;
        }
    }
    if (best) taken_.push_back(best->box);
    return best;
}

}  // namespace rt
