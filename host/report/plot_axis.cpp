// SPDX-License-Identifier: Apache-2.0
#include "host/report/plot_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace rt {

namespace {

std::string superscript(int number) {
    constexpr std::array<std::string_view, 10> digits{"⁰", "¹", "²", "³", "⁴",
                                                      "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text = number < 0 ? "⁻" : "";
    for (const char digit : std::to_string(std::abs(number))) {
        text += digits[static_cast<std::size_t>(digit - '0')];
    }
    return text;
}

/// `step` times ten to the `exponent`, as the axis writes it.
std::string tick_label(int step, int exponent, AxisUnit unit) {
    const double value = step * std::pow(10.0, exponent);
    if (unit == AxisUnit::seconds) return duration_text(value, 1);
    if (unit != AxisUnit::power) return significant(value, 1);
    return (step == 1 ? "" : std::to_string(step) + "·") + "10" + superscript(exponent);
}

int decade_of(double value) { return static_cast<int>(std::floor(std::log10(value))); }

std::vector<Tick> log_ticks(const Axis& axis, int most_labels) {
    const int first = decade_of(axis.low), last = decade_of(axis.high);
    const bool has_room = 3 * (last - first + 1) <= most_labels + 2;
    const int label_every = std::max(1, (last - first) / std::max(1, most_labels) + 1);
    std::vector<Tick> ticks;
    for (int exponent = first; exponent <= last; ++exponent) {
        for (const int step : {1, 2, 5}) {
            const double value = step * std::pow(10.0, exponent);
            if (value < axis.low * (1 - 1e-12) || value > axis.high * (1 + 1e-12)) continue;
            const bool named = step == 1 ? exponent % label_every == 0 : has_room;
            if (step != 1 && !has_room && last - first > 3) continue;
            ticks.push_back({value, named ? tick_label(step, exponent, axis.unit) : ""});
        }
    }
    return ticks;
}

std::vector<Tick> linear_ticks(const Axis& axis, int most_labels) {
    const double span = axis.high - axis.low;
    if (!(span > 0)) return {};
    const double rough = span / std::max(1, most_labels);
    const double power = std::pow(10.0, decade_of(rough));
    double step = 10 * power;
    for (const double candidate : {5 * power, 2 * power, power}) {
        if (candidate >= rough * (1 - 1e-9)) step = candidate;
    }
    if (axis.unit == AxisUnit::count) step = std::max(step, 1.0);
    std::vector<Tick> ticks;
    const auto first = static_cast<long>(std::ceil(axis.low / step - 1e-9));
    const auto last = static_cast<long>(std::floor(axis.high / step + 1e-9));
    for (long i = first; i <= last; ++i) {
        const double value = static_cast<double>(i) * step;
        ticks.push_back({value, axis.unit == AxisUnit::seconds ? duration_text(value, 2)
                                                               : fmt::format("{:.6g}", value)});
    }
    return ticks;
}

}  // namespace

std::vector<Tick> axis_ticks(const Axis& axis, int most_labels) {
    if (!axis.ticks.empty()) return axis.ticks;
    return axis.logarithmic ? log_ticks(axis, most_labels) : linear_ticks(axis, most_labels);
}

Axis axis_around(const std::string& label, const std::vector<double>& values, bool logarithmic,
                 AxisUnit unit) {
    Axis axis{label, logarithmic ? 1.0 : 0.0, logarithmic ? 10.0 : 1.0, logarithmic, unit, {}};
    bool empty = true;
    for (const double value : values) {
        if (!std::isfinite(value) || (logarithmic && !(value > 0))) continue;
        axis.low = empty ? value : std::min(axis.low, value);
        axis.high = empty ? value : std::max(axis.high, value);
        empty = false;
    }
    if (empty) return axis;
    if (logarithmic) {
        const double air = std::max(1.25, std::pow(axis.high / axis.low, 0.06));
        axis.low /= air;
        axis.high *= air;
    } else {
        const double span = std::max(axis.high - axis.low, 1e-9 + std::fabs(axis.high) * 0.01);
        axis.low = axis.low >= 0 ? 0 : axis.low - 0.06 * span;
        axis.high += 0.06 * span;
    }
    return axis;
}

AxisScale::AxisScale(const Axis& axis, double from, double to)
    : logarithmic_(axis.logarithmic),
      low_(logarithmic_ ? std::log10(axis.low) : axis.low),
      high_(logarithmic_ ? std::log10(axis.high) : axis.high),
      from_(from),
      to_(to) {}

double AxisScale::at(double value) const {
    if (logarithmic_ && !(value > 0)) return from_;
    const double place = logarithmic_ ? std::log10(value) : value;
    return high_ > low_ ? from_ + (to_ - from_) * (place - low_) / (high_ - low_) : from_;
}

std::string significant(double value, int digits) {
    if (value == 0) return "0";
    if (!std::isfinite(value)) return value > 0 ? "∞" : (value < 0 ? "−∞" : "not a number");
    const double size = std::fabs(value);
    if (size < 1e-4 || size >= 1e9) return scientific_text(value, digits);
    // Rounding may carry into one more digit: 9.996 is 10.0.
    const double rounded = std::stod(fmt::format("{:.{}e}", size, digits - 1));
    return fmt::format("{:.{}f}", value, std::max(0, digits - 1 - decade_of(rounded)));
}

std::string duration_text(double seconds, int digits) {
    if (seconds == 0) return "0\u00a0s";
    const double rounded = std::stod(fmt::format("{:.{}e}", std::fabs(seconds), digits - 1));
    if (rounded >= 1) return significant(seconds, digits) + "\u00a0s";
    if (rounded >= 1e-3) return significant(seconds * 1e3, digits) + "\u00a0ms";
    return significant(seconds * 1e6, digits) + "\u00a0µs";
}

std::string scientific_text(double value, int digits) {
    if (value == 0 || !std::isfinite(value)) return significant(value, digits);
    const std::string text = fmt::format("{:.{}e}", value, digits - 1);
    const auto e = text.find('e');
    return text.substr(0, e) + "·10" + superscript(std::stoi(text.substr(e + 1)));
}

}  // namespace rt
