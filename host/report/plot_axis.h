// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace rt {

/// How the numbers along an axis are written.
enum class AxisUnit {
    plain,    ///< 0.5, 20, 4000
    seconds,  ///< 2 ms, 1 s
    power,    ///< 10⁻³, 2·10⁻³
    count,    ///< whole numbers only
};

struct Tick {
    double value = 0;
    std::string label;  ///< empty: a line without a number
};

/// What an axis spans, in data units; both ends are above 0 if it is logarithmic.
struct Axis {
    std::string label;
    double low = 0, high = 1;
    bool logarithmic = false;
    AxisUnit unit = AxisUnit::plain;
    std::vector<Tick> ticks = {};  ///< the axis' own; empty: round numbers
};

/// The axis' own ticks, or round ones inside the axis, in ascending order: decades on a logarithmic
/// axis, with 2 and 5 between them where at most `most_labels` numbers stand; else steps of 1, 2 or
/// 5 times a power of ten.
std::vector<Tick> axis_ticks(const Axis& axis, int most_labels);

/// An axis around the values with a small margin at both ends. A logarithmic one ignores values
/// that are not above 0; without any value it spans 1 to 10 (0 to 1 when linear).
Axis axis_around(const std::string& label, const std::vector<double>& values, bool logarithmic,
                 AxisUnit unit);

/// Maps values of the axis to drawing coordinates.
class AxisScale {
   public:
    /// `from` and `to` are the drawing's coordinates of the axis' low and high ends.
    AxisScale(const Axis& axis, double from, double to);
    double at(double value) const;

   private:
    bool logarithmic_;
    double low_, high_, from_, to_;
};

/// A number with this many significant digits, without an exponent from 1e-4 to 1e9.
std::string significant(double value, int digits);

/// A time with the unit that suits it: "850 µs", "12.3 ms", "1.20 s".
std::string duration_text(double seconds, int digits = 3);

/// "3.4·10⁻⁵": for errors.
std::string scientific_text(double value, int digits = 2);

}  // namespace rt
