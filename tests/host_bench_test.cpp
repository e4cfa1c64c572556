// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "host/measure/bench.h"
#include "host/measure/converge.h"
#include "host/measure/timing.h"
#include "host/print/print_run.h"

namespace rt::this_file {
namespace {

TEST(Statistics, MedianIsTheMiddleOrTheMeanOfTheTwo) {
    EXPECT_EQ(median({}), 0);
    EXPECT_EQ(median({3}), 3);
    EXPECT_EQ(median({9, 1, 5}), 5);
    EXPECT_EQ(median({4, 1, 9, 2}), 3);
}

TEST(Statistics, OneOutlierMovesTheMadLittle) {
    EXPECT_EQ(median_absolute_deviation({1, 1, 2, 2, 4, 6, 9}), 1);
    EXPECT_EQ(median_absolute_deviation({1, 1, 2, 2, 4, 6, 900}), 1);
    const Spread spread = spread_of({2, 1, 4});
    EXPECT_EQ(spread.median, 2);
    EXPECT_EQ(spread.min, 1);
    EXPECT_EQ(spread.max, 4);
    EXPECT_EQ(spread.noise_percent(), 50);
}

TEST(Amdahl, PredictsThePapersFigures) {
    EXPECT_DOUBLE_EQ(parallel_fraction(9, 10), 0.9);
    EXPECT_EQ(parallel_fraction(1, 0), 0);
    EXPECT_DOUBLE_EQ(amdahl_speed_up(0.9, 1), 1);
    EXPECT_DOUBLE_EQ(amdahl_speed_up(0.9, 2), 1 / 0.55);
    EXPECT_DOUBLE_EQ(amdahl_speed_up(1, 8), 8);
    EXPECT_DOUBLE_EQ(amdahl_speed_up(0, 8), 1);
}

TEST(Pareto, KeepsWhatNothingBeats) {
    const std::vector<Cost> costs{{3, 0.1}, {1, 0.5}, {2, 0.6}, {4, 0.1}, {3, 0.1}, {5, 0.01}};
    EXPECT_EQ(pareto_front(costs), (std::vector<std::size_t>{1, 0, 5}));
    EXPECT_TRUE(pareto_front({}).empty());
}

TEST(Pareto, DigitsThatNobodySeesDecideNothing) {
    const std::vector<Cost> costs{{0.0367, 0.014112}, {0.0435, 0.014111}, {0.0435004, 0.00626}};
    EXPECT_EQ(pareto_front(costs), (std::vector<std::size_t>{0, 2}));
    const std::vector<Cost> as_fast{{1.0004, 0.5}, {1.0001, 0.6}, {1.01, 0.4996}};
    EXPECT_EQ(pareto_front(as_fast), (std::vector<std::size_t>{0}));
    const std::vector<Cost> equal{{1.0001, 0.50004}, {1.0004, 0.50001}};
    EXPECT_EQ(pareto_front(equal), (std::vector<std::size_t>{0}));
}

TEST(Pareto, NaNIsOnNoFront) {
    const std::vector<Cost> costs{{1, std::nan("")}, {2, 0.5}};
    EXPECT_EQ(pareto_front(costs), (std::vector<std::size_t>{1}));
}

TEST(Pareto, OnePointHasNoSlope) {
    EXPECT_FALSE(log_log_slope({}).has_value());
    EXPECT_FALSE(log_log_slope(std::vector<Cost>{{1, 1}}).has_value());
    EXPECT_FALSE(log_log_slope(std::vector<Cost>{{1, 1}, {1, 0.5}, {0, 2}}).has_value());
}

TEST(Pareto, SlopeOfRandomSamplingIsMinusAHalf) {
    const std::vector<Cost> costs{{1, 1}, {4, 0.5}, {16, 0.25}, {0, 1}, {5, 0}};
    EXPECT_NEAR(log_log_slope(costs).value(), -0.5, 1e-12);
}

TEST(Pareto, SlopeIsExactWhereTimesAreNearlyEqual) {
    for (const double step : {1e-3, 1e-6, 1e-9}) {
        const double seconds = 0.0371, later = seconds * (1 + step);
        const std::vector<Cost> costs{{seconds, 4e-3}, {later, 1e-3}};
        const double expected = std::log(0.25) / std::log1p((later - seconds) / seconds);
        EXPECT_NEAR(log_log_slope(costs).value() / expected, 1, 1e-6) << step;
    }
}

TimedRun run_of(double trace, double build, int threads) {
    TimedRun run;
    run.phases.renderer.trace = trace;
    run.phases.renderer.build = build;
    run.device.threads = threads;
    return run;
}

BenchRow threads_row(int threads, const std::vector<double>& traces) {
    BenchRow row;
    row.asked.threads = threads;
    row.asked.device = "threads:" + std::to_string(threads);
    row.asked.schedule = "tiles";
    row.verdict = Verdict::right;
    row.warm_up.push_back(run_of(100, 1, threads));
    for (const double trace : traces) row.repeats.push_back(run_of(trace, 1, threads));
    return row;
}

TEST(Bench, WrongRowHasNoTimingAndIsNoBase) {
    BenchResult result;
    result.rows = {threads_row(1, {9}), threads_row(2, {4})};
    result.rows[0].verdict = Verdict::wrong;
    result.judge();
    EXPECT_FALSE(result.rows[0].figures);
    EXPECT_FALSE(result.rows[1].figures->speed_up);
}

TEST(Bench, RoundsAreThoseThatWereDone) {
    const std::vector<BenchRow> rows{threads_row(1, {9, 9}), threads_row(2, {4})};
    EXPECT_EQ(rounds_text(rows, 2, false), "2 rounds after a warm-up");
    EXPECT_EQ(rounds_text(rows, 4, true), "2 of 4 rounds after a warm-up, interrupted");
    EXPECT_EQ(rounds_text(std::vector{threads_row(1, {9})}, 1, false), "1 round after a warm-up");
    EXPECT_EQ(rounds_text(std::vector{threads_row(1, {})}, 4, true),
              "0 of 4 rounds after a warm-up, interrupted");
}

TEST(Converge, TargetBelowTheFloorIsNotDecided) {
    ConvergeResult result;
    result.reference.halves_rmse = 4e-3;
    ConvergePoint point;
    point.asked.device = "threads";
    point.verdict = Verdict::right;
    for (int i = 0; i < 5; ++i) {
        point.repeats.push_back(run_of(0.5, 0.25, 2));
        point.repeats.back().error.emplace().rmse = 1e-3;
    }
    result.points = {point};
    result.summarize();
    const auto& times = result.targets;
    ASSERT_EQ(times.size(), 4U);
    EXPECT_DOUBLE_EQ(times[0].seconds.value(), 0.5);
    EXPECT_FALSE(times[0].below_floor);
    EXPECT_TRUE(times[2].below_floor);
    EXPECT_TRUE(result.points[0].figures->below_floor);
}

TEST(MachineLoad, CountsTheTimeOfGivenCoresAlone) {
    const std::string stat = "cpu 9 9 9 9\ncpu0 100 0 50 7 7 30 15 5 0 0\ncpu1 900 0 0 0\nintr 1\n";
    cpu_set_t first;
    CPU_ZERO(&first);
    CPU_SET(0, &first);
    std::istringstream lines(stat);
    EXPECT_DOUBLE_EQ(used_seconds(lines, first), 200.0 / static_cast<double>(sysconf(_SC_CLK_TCK)));
    CPU_SET(5, &first);
    std::istringstream again(stat);
    EXPECT_LT(used_seconds(again, first), 0);
}

TEST(MachineLoad, LeavesOutOurOwn) {
    EXPECT_DOUBLE_EQ(load_between({1, 10, 3}, {3, 13, 5}), 0.5);
    EXPECT_DOUBLE_EQ(load_between({1, 10, 3}, {3, 12, 5.1}), 0);
    EXPECT_LT(load_between({1, -1, 3}, {3, 12, 5}), 0);
}

}  // namespace
}  // namespace rt::this_file
