// SPDX-License-Identifier: Apache-2.0
#include "tests/native_bits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "tests/native_probes.h"

namespace rt {

namespace {

/// The most items of a launch that are compared with the native probes.
constexpr std::size_t compared_items = 65536;

/// An item's words of T.
template <typename T>
std::string words_of(const std::byte* item, const ProbeOutput& output) {
    std::string text;
    for (std::size_t at = 0; at + sizeof(T) <= output.item_bytes; at += sizeof(T)) {
        T x;
        std::memcpy(&x, item + at, sizeof(T));
        text += fmt::format(" {:a}", x);
    }
    return text;
}

template <typename T>
void expect_same_items(const std::byte* expected, const std::byte* native,
                       const ProbeOutput& output, std::size_t count, const std::string& what) {
    for (std::size_t i = 0; i < count; ++i) {
        const std::byte *a = expected + i * output.item_bytes, *b = native + i * output.item_bytes;
        if (is_same_item(std::is_same_v<T, double>, a, b, output.item_bytes,
                         output.holds_numbers)) {
            continue;
        }
        ADD_FAILURE() << what << ", item " << i << ":" << words_of<T>(b, output) << "\ninstead of"
                      << words_of<T>(a, output);
        return;
    }
}

}  // namespace

std::vector<std::vector<std::byte>> native_results(bool double_precision, int lanes,
                                                   const std::string& function, std::size_t count,
                                                   std::span<const ProbeInput> inputs,
                                                   std::span<const ProbeOutput> outputs) {
    std::vector<std::vector<std::byte>> results;
    std::vector<void*> arrays;
    for (const ProbeInput& input : inputs) arrays.push_back(const_cast<void*>(input.data));
    for (const ProbeOutput& output : outputs) {
        results.emplace_back(count * output.item_bytes);
        arrays.push_back(results.back().data());
    }
    run_native_probe(double_precision, lanes, function, static_cast<std::uint32_t>(count), arrays);
    return results;
}

void expect_native_bits(bool double_precision, const std::string& function, std::size_t count,
                        std::span<const ProbeInput> inputs, std::span<const ProbeOutput> outputs) {
    count = std::min(count, compared_items);
    for (const int lanes : native_probe_lanes) {
        const auto native =
            native_results(double_precision, lanes, function, count, inputs, outputs);
        for (std::size_t i = 0; i < outputs.size(); ++i) {
            const auto* expected = static_cast<const std::byte*>(outputs[i].data);
            const std::string what =
                fmt::format("result {} of probe_{} in {} with {} lanes on pthreads", i, function,
                            double_precision ? "double" : "float", lanes);
            const auto expect_same =
                double_precision ? expect_same_items<double> : expect_same_items<float>;
            expect_same(expected, native[i].data(), outputs[i], count, what);
        }
    }
}

}  // namespace rt
