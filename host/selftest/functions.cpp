// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "host/opencl/cl_tiles.h"
#include "host/selftest/selftest.h"

namespace rt {

namespace {

/// The entries of the probe `layout`.
constexpr const char* layout_names[] = {
#define RT_STRUCT(type) "the size of " #type,
#define RT_FIELD(type, member) #type "." #member,
#include "kernels/probes/layout_fields.h"
#undef RT_STRUCT
#undef RT_FIELD
};

template <typename T>
T number_at(const ProbeArray& array, std::size_t byte) {
    T x;
    std::memcpy(&x, array.bytes.data() + byte, sizeof(T));
    return x;
}

/// Before rounding, as good as exact: what a device's own arithmetic must round once.
template <typename T>
std::optional<long double> unrounded(const ProbeRecord& record, std::size_t item) {
    const auto argument = [&](std::size_t k) -> long double {
        return number_at<T>(record.inputs[k], item * sizeof(T));
    };
    if (record.function == "product") return argument(0) * argument(1);
    if (record.function == "quotient") return argument(0) / argument(1);
    if (record.function == "square_root") return std::sqrt(argument(0));
    if (record.function == "fused") return argument(0) * argument(1) + argument(2);
    return {};
}

/// |a - b| in ulps of b.
template <typename T>
double ulps_between(T a, long double b) {
    const T near = std::abs(static_cast<T>(b));
    const T ulp = std::max(std::nextafter(near, std::numeric_limits<T>::infinity()) - near,
                           std::numeric_limits<T>::denorm_min());
    return static_cast<double>(std::abs(static_cast<long double>(a) - b) / ulp);
}

/// By how much results differ, in words.
template <typename T>
std::string error_text(const ProbeRecord& record, const ProbeArray& got, const ProbeArray& right) {
    double worst = 0;
    bool is_exact = false;
    for (std::size_t at = 0; at < right.bytes.size(); at += sizeof(T)) {
        const T x = number_at<T>(got, at), y = number_at<T>(right, at);
        if (x == y || (std::isnan(x) && std::isnan(y))) continue;
        if (!std::isfinite(x) || !std::isfinite(y)) return ", by far";
        const auto exact = unrounded<T>(record, at / right.item_bytes);
        is_exact = exact.has_value();
        worst = std::max(worst, ulps_between(x, exact.value_or(y)));
    }
    if (worst > 1e6) return ", by far";
    return fmt::format(", by up to {:.3g} ulps from the {}", worst,
                       is_exact ? "exact value (0.5 is right)" : "right bits");
}

template <typename Word>
std::string words(const ProbeArray& array, std::size_t item) {
    constexpr const char* format = std::is_integral_v<Word> ? " {:#x}" : " {:a}";
    std::string text;
    const std::size_t begin = item * array.item_bytes, end = begin + array.item_bytes;
    for (std::size_t at = begin; at + sizeof(Word) <= end; at += sizeof(Word)) {
        text += fmt::format(format, number_at<Word>(array, at));
    }
    return text;
}

template <typename T>
std::string item_text(const ProbeArray& array, std::size_t item) {
    return array.holds_numbers ? words<T>(array, item) : words<std::uint32_t>(array, item);
}

template <typename T>
bool is_same_number(const std::byte* a, const std::byte* b) {
    T x, y;
    std::memcpy(&x, a, sizeof(T));
    std::memcpy(&y, b, sizeof(T));
    return (x != x && y != y) || std::memcmp(a, b, sizeof(T)) == 0;
}

/// Whether two items of a result hold the same bits; all NaNs are equal, since IEEE 754 leaves sign
/// and payload to the machine.
bool is_same_item(bool is_double, const std::byte* a, const std::byte* b, std::size_t bytes,
                  bool holds_numbers) {
    if (std::memcmp(a, b, bytes) == 0) return true;
    const auto is_same = is_double ? is_same_number<double> : is_same_number<float>;
    for (std::size_t at = 0; at < bytes && holds_numbers; at += is_double ? 8 : 4) {
        if (!is_same(a + at, b + at)) return false;
    }
    return holds_numbers;
}

template <typename T>
std::string difference(const ProbeRecord& record, const ProbeArray& got, const ProbeArray& right) {
    std::size_t wrong = 0, first = 0;
    for (std::size_t i = record.count; i-- > 0;) {
        const std::size_t at = i * right.item_bytes;
        if (is_same_item(record.is_double, got.bytes.data() + at, right.bytes.data() + at,
                         right.item_bytes, right.holds_numbers)) {
            continue;
        }
        first = i;
        ++wrong;
    }
    if (wrong == 0) return "";
    const std::string both = item_text<T>(got, first) + " instead of" + item_text<T>(right, first);
    if (record.function == "layout") {
        return fmt::format("{} is elsewhere than in C++:{}", layout_names[first], both);
    }
    return fmt::format("{} of {} items differ{}; item {}:{}", wrong, record.count,
                       right.holds_numbers ? error_text<T>(record, got, right) : "", first, both);
}

}  // namespace

std::string difference(const ProbeRecord& right, const ProbeRecord& got) {
    const auto find = right.is_double ? difference<double> : difference<float>;
    for (std::size_t k = 0; k < right.outputs.size(); ++k) {
        std::string found = find(right, got.outputs[k], right.outputs[k]);
        if (!found.empty()) return found;
    }
    return "";
}

std::string what_is_wrong(ProbeDevice& device, const ProbeRecord& record, int lanes,
                          const std::string& more_options, std::size_t most_items) {
    ProbeRecord got = record;
    for (ProbeArray& result : got.outputs) {  // what the kernel must write
        std::ranges::fill(result.bytes, std::byte{0xa5});
    }
    ProgramOptions build;
    build.lanes = lanes;
    build.more = more_options;
    device.launch(build, got, most_items);
    return difference(record, got);
}

ProbeRecord many_items_record(const std::vector<ProbeRecord>& records) {
    ProbeRecord many = *std::find_if(records.begin(), records.end(), [](const ProbeRecord& one) {
        return one.function == "owen_scramble" && !one.is_double;
    });
    many.count = (1u << 20) + 4096;
    for (auto* arrays : {&many.inputs, &many.outputs}) {
        for (ProbeArray& array : *arrays) {  // its items over and over
            const std::size_t once = array.bytes.size();
            array.bytes.resize(std::size_t{many.count} * array.item_bytes);
            for (std::size_t i = once; i < array.bytes.size(); ++i) {
                array.bytes[i] = array.bytes[i - once];
            }
        }
    }
    return many;
}

void check_functions(Checks& checks, const ClDevice& device, const std::string& prefix,
                     bool quick) {
    const std::vector<ProbeRecord> records = recorded_probes();
    ProbeDevice probes(device);
    for (auto one = records.begin(); one != records.end();) {  // records of a function are together
        const auto last = std::find_if(one, records.end(), [&](const ProbeRecord& other) {
            return other.function != one->function || other.is_double != one->is_double;
        });
        const int native =
            one->is_double ? packet_lanes<double>(0, device) : packet_lanes<float>(0, device);
        const bool has_scene = one->inputs.size() >= scene_inputs;  // it takes long to compile
        const bool is_left_out = quick ? one->is_double || has_scene
                                       : one->is_double && (has_scene || !device.has_double);
        for (const int lanes : std::set<int>{native, quick || has_scene ? native : 1}) {
            if (is_left_out) continue;
            checks.run(
                fmt::format("{}{}/{}/{}", prefix, one->function, precision_name(*one), lanes), [&] {
                    std::string why;
                    for (auto each = one; each != last && why.empty(); ++each) {
                        why = what_is_wrong(probes, *each, lanes);
                    }
                    return why;
                });
        }
        one = last;
    }
    if (quick) return;
    checks.run(prefix + "many-items/float/1", [&] {
        const ProbeRecord many = many_items_record(records);
        return what_is_wrong(probes, many, 1, "", many.count);
    });
}

}  // namespace rt
