// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "host/base/parallel.h"
#include "host/base/text.h"
#include "host/picture/render_stats.h"
#include "host/print/print_stats.h"

namespace rt::this_file {
namespace {

/// Passes when the text holds the piece.
testing::AssertionResult holds(const std::string& text, const std::string& piece) {
    if (text.find(piece) != std::string::npos) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "no '" << piece << "' in: " << text;
}

TEST(SecondsSinceProcessStart, CountWhatWasComputedAndWaitedFor) {
    const auto began = std::chrono::steady_clock::now();
    const double before = seconds_since_process_start();
    EXPECT_GE(before, 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const double waited = seconds_since_process_start() - before;
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - began;
    // Unless other tests in this process computed on several threads, for longer than has passed.
    const bool counts_waiting = processor_seconds() < 0.2;
    EXPECT_GE(waited, counts_waiting ? 0.05 - 0.02 : 0);
    EXPECT_LE(waited, passed.count() + 0.01);
    EXPECT_GE(seconds_since_process_start(), processor_seconds() - 0.01);
}

TEST(ShortDeviceName, OfPoclIsItsOwn) {
    EXPECT_EQ(short_device_name("pthread-haswell-AMD EPYC"), "PoCL");
    EXPECT_EQ(short_device_name("cpu-znver4-AMD EPYC"), "PoCL");
    EXPECT_EQ(short_device_name("NVIDIA H100"), "NVIDIA H100");
}

TEST(StatsText, CountsInWords) {
    RenderStats stats;
    stats.scene.flatten.spheres.count = stats.scene.lights = 1;
    EXPECT_TRUE(holds(holdings_text(stats.scene), "1 sphere, 0 cones, 0 triangles, 1 light"));
    stats.device.fallback_from = "a device";
    EXPECT_TRUE(holds(stats_text(stats), "instead of a device, which failed"));
}

}  // namespace
}  // namespace rt::this_file
