// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "host/base/parallel.h"
#include "host/image/picture_io.h"
#include "host/picture/render_stats.h"
#include "host/print/print_stats.h"
#include "host/report/bars.h"
#include "host/report/device_colors.h"
#include "host/report/html.h"
#include "host/report/label_placer.h"
#include "host/report/plot_axis.h"
#include "host/report/report_page.h"
#include "host/report/sections.h"
#include "host/report/stress_margins.h"
#include "host/report/svg_plot.h"
#include "host/report/verdict.h"

namespace {

using rt::Axis;
using rt::AxisUnit;

/// Passes when the text holds the piece.
testing::AssertionResult holds(const std::string& text, const std::string& piece) {
    if (text.find(piece) != std::string::npos) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "no '" << piece << "' in: " << text;
}

std::vector<std::string> labels(const std::vector<rt::Tick>& ticks) {
    std::vector<std::string> texts;
    for (const rt::Tick& tick : ticks) {
        if (!tick.label.empty()) texts.push_back(tick.label);
    }
    return texts;
}

std::vector<double> values(const std::vector<rt::Tick>& ticks) {
    std::vector<double> numbers;
    for (const rt::Tick& tick : ticks) numbers.push_back(tick.value);
    return numbers;
}

TEST(SecondsSinceProcessStart, CountWhatWasComputedAndWaitedFor) {
    const auto began = std::chrono::steady_clock::now();
    const double before = rt::seconds_since_process_start();
    EXPECT_GE(before, 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const double waited = rt::seconds_since_process_start() - before;
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - began;
    // Unless other tests in this process computed on several threads, for longer than has passed.
    const bool counts_waiting = rt::processor_seconds() < 0.2;
    EXPECT_GE(waited, counts_waiting ? 0.05 - 0.02 : 0);
    EXPECT_LE(waited, passed.count() + 0.01);
    EXPECT_GE(rt::seconds_since_process_start(), rt::processor_seconds() - 0.01);
}

TEST(AxisTicks, OneDecadeHasTwoAndFive) {
    const Axis axis{"", 1e-3, 1e-2, true, AxisUnit::seconds};
    EXPECT_EQ(labels(rt::axis_ticks(axis, 8)),
              (std::vector<std::string>{"1\u00a0ms", "2\u00a0ms", "5\u00a0ms", "10\u00a0ms"}));
}

TEST(AxisTicks, ManyDecadesHaveTheirPowersOnly) {
    const Axis axis{"", 1e-5, 1, true, AxisUnit::power};
    EXPECT_EQ(labels(rt::axis_ticks(axis, 8)),
              (std::vector<std::string>{"10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "10⁰"}));
}

TEST(AxisTicks, StayInside) {
    for (const bool logarithmic : {false, true}) {
        const Axis axis{"", 0.37, 41, logarithmic, AxisUnit::plain};
        const auto ticks = values(rt::axis_ticks(axis, 8));
        ASSERT_FALSE(ticks.empty());
        EXPECT_GE(ticks.front(), 0.37);
        EXPECT_LE(ticks.back(), 41);
        EXPECT_TRUE(std::is_sorted(ticks.begin(), ticks.end()));
    }
}

TEST(AxisTicks, LinearStepsAreRound) {
    EXPECT_EQ(labels(rt::axis_ticks({"", 0, 4.2, false, AxisUnit::plain}, 5)),
              (std::vector<std::string>{"0", "1", "2", "3", "4"}));
    EXPECT_EQ(labels(rt::axis_ticks({"", 0, 1, false, AxisUnit::plain}, 5)),
              (std::vector<std::string>{"0", "0.2", "0.4", "0.6", "0.8", "1"}));
}

TEST(AxisAround, LeavesOutWhatALogarithmCannotShow) {
    const Axis axis = rt::axis_around("", {0, -1, 1e-3, 1e-1}, true, AxisUnit::power);
    EXPECT_LT(axis.low, 1e-3);
    EXPECT_GT(axis.low, 1e-4);
    EXPECT_GT(axis.high, 1e-1);
    const Axis empty = rt::axis_around("", {}, true, AxisUnit::power);
    EXPECT_LT(empty.low, empty.high);
}

TEST(AxisScale, MapsEndsAndDecades) {
    const rt::AxisScale logarithmic({"", 1, 100, true, AxisUnit::plain}, 50, 250);
    EXPECT_DOUBLE_EQ(logarithmic.at(1), 50);
    EXPECT_DOUBLE_EQ(logarithmic.at(10), 150);
    EXPECT_DOUBLE_EQ(logarithmic.at(100), 250);
    EXPECT_DOUBLE_EQ(logarithmic.at(0), 50);
    const rt::AxisScale downwards({"", 0, 4, false, AxisUnit::plain}, 300, 100);
    EXPECT_DOUBLE_EQ(downwards.at(1), 250);
}

TEST(NumberText, KeepsItsDigits) {
    EXPECT_EQ(rt::significant(1234.4, 3), "1234");
    EXPECT_EQ(rt::significant(9.996, 3), "10.0");
    EXPECT_EQ(rt::significant(0.0499, 2), "0.050");
    EXPECT_EQ(rt::significant(0, 3), "0");
    EXPECT_EQ(rt::duration_text(0.01234), "12.3\u00a0ms");
    EXPECT_EQ(rt::duration_text(0.9996), "1.00\u00a0s");
    EXPECT_EQ(rt::duration_text(42e-6, 2), "42\u00a0µs");
    EXPECT_EQ(rt::scientific_text(3.44e-5), "3.4·10⁻⁵");
    EXPECT_EQ(rt::scientific_text(0), "0");
}

TEST(HtmlText, EscapesWhatHtmlMeans) {
    EXPECT_EQ(rt::html_text("<b a=\"x\" c='y'>&amp;"),
              "&lt;b a=&quot;x&quot; c=&#39;y&#39;&gt;&amp;amp;");
}

TEST(HtmlText, ReplacesWhatIsNoText) {
    EXPECT_EQ(rt::html_text("a\x01\xff\xc3z\xed\xa0\x80"), "a���z���");
    EXPECT_EQ(rt::html_text("Öl ⁻ 🙂"), "Öl ⁻ 🙂");
}

TEST(JsonBlock, CannotBeEndedByItsTexts) {
    const std::string html = rt::json_block("x", {{"name", "</script><!--<script>&"}});
    EXPECT_TRUE(holds(html, R"("\u003c/script>\u003c!--\u003cscript>\u0026")"));
    EXPECT_EQ(html.find("</script>"), html.rfind("</script>"));
}

TEST(PngDataUri, IsBase64) {
    const auto uri = [](std::string_view bytes) {
        return rt::png_data_uri(std::as_bytes(std::span(bytes)));
    };
    EXPECT_EQ(uri("Man"), "data:image/png;base64,TWFu");
    EXPECT_EQ(uri("Ma"), "data:image/png;base64,TWE=");
    EXPECT_EQ(uri("M"), "data:image/png;base64,TQ==");
}

TEST(EncodePng, IsAPng) {
    const rt::Picture picture{1, 1, 3, {1, 0, 0}};
    const auto png = rt::encode_png(picture, rt::Encoding::display);
    ASSERT_GT(png.size(), 8u);
    EXPECT_EQ(std::to_integer<char>(png[1]), 'P');
}

rt::PlotPoint point(double x, double y) {
    rt::PlotPoint point;
    point.x = point.x_low = point.x_high = x;
    point.y = point.y_low = point.y_high = y;
    return point;
}

rt::Plot small_plot() {
    rt::Plot plot;
    plot.id = "p";
    plot.title = "Error & time";
    plot.x = {"time", 1, 100, true, AxisUnit::seconds};
    plot.y = {"error", 0, 10, false, AxisUnit::plain};
    plot.curves.push_back({"<curve>", 0, 1, 1, {point(1, 10), point(10, 5), point(100, 0)}});
    plot.curves[0].points[1].source = "bench#/rows/1";
    return plot;
}

TEST(SvgPlot, DrawsTheData) {
    // The frame is 64 to 396 across and 34 to 278 down.
    const std::string svg = rt::svg_plot(small_plot());
    EXPECT_TRUE(holds(svg, "M64.0 34.0L230.0 156.0L396.0 278.0"));
    EXPECT_TRUE(holds(svg, "data-source=\"bench#/rows/1\""));
    EXPECT_TRUE(holds(svg, "Error &amp; time</title>"));
    EXPECT_TRUE(holds(svg, "name-of-curve s0\">&lt;curve&gt;</text>"));
}

TEST(SvgPlot, FrontStepsDownAndGoesOn) {
    rt::Plot plot = small_plot();
    plot.front = {point(1, 10), point(10, 5)};
    plot.floor = 1;
    const std::string svg = rt::svg_plot(plot);
    EXPECT_TRUE(holds(svg, "M64.0 34.0H230.0V156.0H396.0"));
    EXPECT_TRUE(holds(svg, "class=\"floor\" x=\"64.0\" y=\"253.6\""));
}

TEST(SvgPlot, AnAxisMayNameItsOwnTicks) {
    rt::Plot plot = small_plot();
    plot.x.ticks = {{1, "100²"}, {100, "500²"}};
    const std::string svg = rt::svg_plot(plot);
    EXPECT_TRUE(holds(svg, ">100²</text>"));
    EXPECT_FALSE(holds(svg, ">10 s</text>"));
}

TEST(SvgPlot, NumbersOnAnAxisDoNotTouch) {
    rt::Plot plot = small_plot();
    plot.x.ticks = {{10, "100²"}, {10.5, "200²"}, {90, "500²"}};
    const std::string svg = rt::svg_plot(plot);
    EXPECT_TRUE(holds(svg, ">100²</text>"));
    EXPECT_FALSE(holds(svg, ">200²</text>"));
    EXPECT_TRUE(holds(svg, ">500²</text>"));
}

TEST(SvgPlot, TheLargestNumberOnAnAxisStays) {
    rt::Plot plot = small_plot();
    plot.x.ticks = {{95, "500²"}, {1, "20²"}, {90, "100²"}};
    const std::string svg = rt::svg_plot(plot);
    EXPECT_TRUE(holds(svg, ">20²</text>"));
    EXPECT_FALSE(holds(svg, ">100²</text>"));
    EXPECT_TRUE(holds(svg, ">500²</text>"));
}

TEST(SvgPlot, NeighborsOfOneLabelShareIt) {
    rt::Plot plot = small_plot();
    const auto times = [&](const std::string& text) {
        const std::string svg = rt::svg_plot(plot);
        int found = 0;
        for (auto at = svg.find(text); at != svg.npos; at = svg.find(text, at + 1)) ++found;
        return found;
    };
    plot.curves[0].points[0].label = "none";
    plot.curves.push_back({"other", 1, 1, 1, {point(1.2, 10), point(90, 9)}});
    plot.curves[1].points[0].label = "none";
    EXPECT_EQ(times(">none</text>"), 1);
    plot.curves[1].points[0] = point(60, 9);
    plot.curves[1].points[0].label = "none";
    EXPECT_EQ(times(">none</text>"), 2);
}

bool apart(const rt::DrawnBox& a, const rt::DrawnBox& b) {
    return a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;
}

TEST(LabelPlacer, LabelsStayApartAndInside) {
    rt::LabelPlacer placer({0, 0, 300, 200});
    std::vector<rt::DrawnBox> boxes;
    for (int i = 0; i < 6; ++i) {
        const auto place = placer.place("a device", {{290.0, 100.0 + i}});
        if (!place) continue;
        EXPECT_GE(place->box.left, 0);
        EXPECT_LE(place->box.right, 300);
        for (const rt::DrawnBox& other : boxes) EXPECT_TRUE(apart(place->box, other));
        boxes.push_back(place->box);
    }
    EXPECT_GE(boxes.size(), 2U);
    EXPECT_FALSE(placer.place(std::string(60, 'x'), {{150, 100}}));
}

TEST(LabelPlacer, LeavesLinesFree) {
    rt::LabelPlacer placer({0, 0, 300, 200});
    EXPECT_EQ(placer.place("on the right", {{100, 100}})->y, 104);
    rt::LabelPlacer crossed({0, 0, 300, 200});
    crossed.avoid_line(100, 100, 300, 100);
    const auto place = crossed.place("off the line", {{100, 100}});
    EXPECT_TRUE(place->box.bottom <= 100 || place->box.top >= 100);
}

TEST(LabelPlacer, StandsOffWhereLinesCrowdAPoint) {
    const auto crowded = [] {
        rt::LabelPlacer placer({0, 0, 300, 200});
        for (double x = 40; x <= 160; x += 5) placer.avoid_line(x, 75, x, 125);
        return placer;
    };
    const auto near = crowded().place("a name", {{100, 100}});
    EXPECT_TRUE(near->box.bottom > 75 && near->box.top < 125);
    const auto off = crowded().place("a name", {{100, 100}}, 36);
    EXPECT_TRUE(off->box.bottom <= 75 || off->box.top >= 125);
}

TEST(Bars, AreAsLongAsTheirSecondsAndNameTheirParts) {
    const std::string html = rt::bars_html(
        "t", {{"PoCL", "", 1, 4.01, {{"trace", 3, 5}, {"build", 0.99, 0}, {"upload", 0.01, 4}}}});
    EXPECT_TRUE(holds(html, "class=\"bar s1\""));
    EXPECT_TRUE(holds(html, "class=\"part p5\" x=\"0.00\" width=\"750.00\""));
    EXPECT_TRUE(holds(html, "PoCL <strong>4.01\u00a0s</strong>"));
    EXPECT_TRUE(holds(html, "trace 3.00\u00a0s</li>"));
    EXPECT_TRUE(holds(html, "other 10.0\u00a0ms</li>"));
    EXPECT_FALSE(holds(html, "upload"));
    const std::string exact =
        rt::bars_html("t", {{"threads", "", 0, 3.001, {{"trace", 3, 5}, {"upload", 0.001, 4}}}});
    EXPECT_FALSE(holds(exact, "other"));
}

TEST(HtmlTable, AlignsNumbersAtTheirPoints) {
    const std::string html = rt::html_table(
        {"",
         {"who", "ms", "what"},
         {{{"a"}, {"1.25"}, {"x"}}, {{"b"}, {"103"}, {"2"}}, {{"c"}, {"–"}, {"y"}}}});
    EXPECT_TRUE(holds(html, "<th scope=\"col\" class=\"number\">ms</th>"));
    EXPECT_TRUE(holds(html, "<td class=\"number\">1.25</td>"));
    EXPECT_TRUE(holds(html, "<td class=\"number\" data-pad=\".00\">103</td>"));
    EXPECT_TRUE(holds(html, "<td class=\"number\">–</td>"));
    EXPECT_TRUE(holds(html, "<td>x</td>"));
    EXPECT_TRUE(holds(html, "<td>2</td>"));
}

rt::BenchRow bench_row(const std::string& device, int threads, double trace) {
    rt::BenchRow row;
    row.asked.device_name = device;
    row.asked.device = threads > 0 ? "threads:" + std::to_string(threads) : "0";
    row.asked.uses_threads = threads > 0;
    row.asked.threads = threads;
    row.asked.schedule = threads > 0 ? "tiles" : "";
    row.asked.width = row.asked.height = 100;
    row.verdict = rt::Verdict::right;
    rt::RenderStats run;
    run.device.name = device;
    run.device.threads = threads;
    run.device.schedule = row.asked.schedule;
    run.device.platform = threads > 0 ? "" : "Portable Computing Language";
    run.phases.renderer.trace = trace;
    run.phases.renderer.build = threads > 0 ? 0 : 0.1;
    run.error.emplace().rmse = 2e-7;
    row.repeats = {run, run, run};
    return row;
}

TEST(DeviceColors, AreOneADevice) {
    const std::vector<rt::BenchRow> rows{bench_row("threads", 1, 1), bench_row("threads", 2, 1),
                                         bench_row("x", 0, 1), bench_row("y", 0, 1)};
    const rt::DeviceColors colors(rows);
    EXPECT_EQ(colors.of(rows[0].asked), rt::DeviceColors::threads);
    EXPECT_EQ(colors.of(rows[1].asked), rt::DeviceColors::threads);
    EXPECT_EQ(colors.of(rows[2].asked), 1);
    EXPECT_EQ(colors.of(rows[3].asked), 2);
    rt::ConvergeCase point;
    point.device_name = "y";
    EXPECT_EQ(colors.of(point), 2);
}

TEST(Verdict, SaysWhoIsFastestAndByHowMuch) {
    rt::ReportScene scene;
    scene.has_pictures = false;
    scene.bench.references.emplace_back().scene.name = "a box";
    EXPECT_EQ(rt::verdict_text(scene, 0), "");
    scene.bench.rows = {bench_row("threads", 1, 0.3), bench_row("threads", 2, 0.15),
                        bench_row("x", 0, 0.02)};
    EXPECT_EQ(rt::verdict_text(scene, 0),
              "PoCL traces a box in 20.0\u00a0ms: 15.0 times as fast as one thread");
    EXPECT_EQ(rt::fastest_row(scene, 4)->source, "bench-4#/rows/2");
    const std::string details = rt::verdict_details(scene, 0);
    EXPECT_TRUE(holds(details, "2\u00a0x\u00a02 samples per pixel (grid:2), float."));
    EXPECT_TRUE(holds(details, "With set-up it takes 120\u00a0ms, one thread 300\u00a0ms."));
    EXPECT_TRUE(holds(details,
                      "All 3 measured settings of device, size and sampling gave the right "
                      "picture; float is within RMSE 2.0·10⁻⁷ of double."));
    scene.bench.rows[2].verdict = rt::Verdict::wrong;
    EXPECT_EQ(rt::verdict_text(scene, 0),
              "2 threads trace a box in 150\u00a0ms: 2.00 times as fast as one thread");
    EXPECT_TRUE(
        holds(rt::verdict_details(scene, 0), "Of 3 measured settings, 1 gave a wrong picture"));
}

rt::StressFamilyResult stress_family(const std::string& name, double error, double allowed,
                                     const std::string& broken = "") {
    rt::StressFamilyResult family{name, "size", "it is hard", {}, std::nullopt};
    rt::StressCaseResult one;
    one.label = "1";
    one.tolerance.max_error = allowed;
    one.rows.emplace_back().figures.max_error = error;
    one.rows.front().why = broken;
    family.cases.push_back(one);
    family.shot = rt::StressShot{
        "1", {2, 2, 3, std::vector<float>(12)}, {2, 2, 3, std::vector<float>(12)}, 0};
    return family;
}

TEST(StressMargins, FailuresThenTheTightest) {
    rt::StressResult result;
    result.families = {stress_family("loose", 1e-7, 1e-4), stress_family("tight", 5e-5, 1e-4),
                       stress_family("broken", 1e-9, 1e-4, "2 pixels are wrong"),
                       stress_family("none", 0, 0)};
    EXPECT_EQ(rt::by_margin(result), (std::vector<std::size_t>{2, 1, 0, 3}));
    EXPECT_DOUBLE_EQ(*rt::used_tolerance(result.families[1]), 0.5);
    EXPECT_FALSE(rt::used_tolerance(result.families[3]));
    const std::string html = rt::stress_section(result);
    EXPECT_TRUE(holds(html, "FAIL: 3 of 4 families."));
    EXPECT_LT(html.find(">broken<"), html.find(">tight<"));
    EXPECT_LT(html.find(">tight<"), html.find(">loose<"));
    EXPECT_TRUE(holds(html, "</svg> 50 %"));
    result.families.erase(result.families.begin() + 2);
    EXPECT_TRUE(holds(rt::stress_section(result),
                      "PASS: 3 of 3 families; tight comes closest to "
                      "its tolerance, at 50 % of it."));
}

TEST(StressPictures, AreTheWorstFew) {
    rt::StressResult result;
    for (int i = 1; i <= 9; ++i) {
        result.families.push_back(stress_family("f" + std::to_string(i), i * 1e-5, 1e-4));
    }
    const std::string html = rt::stress_pictures(result);
    EXPECT_TRUE(holds(html, "<h4>f9/1</h4>"));
    EXPECT_TRUE(holds(html, "<h4>f6/1</h4>"));
    EXPECT_FALSE(holds(html, "<h4>f5/1</h4>"));
}

rt::ReportPicture tiny_picture(const std::string& name) {
    rt::ReportPicture shot;
    shot.picture = {16, 16, 3, std::vector<float>(16 * 16 * 3, 0.5f)};
    shot.stats.scene.name = shot.stats.scene.path = name;
    shot.stats.region = {0, 0, 16, 16};
    shot.stats.error = rt::image_error(shot.picture, shot.picture);
    return shot;
}

TEST(RenderStats, TellOfADriverThatCompiledWhileTracing) {
    rt::RenderStats stats;
    stats.phases.renderer.trace = 3;
    stats.phases.renderer.kernel = 0.5;
    EXPECT_TRUE(stats.driver_took_its_time());
    EXPECT_TRUE(holds(rt::stats_text(stats), "kernels ran for only 0.500 s of the 3.000 s"));
    stats.phases.renderer.kernel = 2;
    EXPECT_FALSE(stats.driver_took_its_time());
    stats.phases.renderer.kernel = 0;  // pthreads
    EXPECT_FALSE(stats.driver_took_its_time());
    EXPECT_FALSE(holds(rt::stats_text(stats), "kernels ran for"));
}

TEST(StatsText, CountsInWords) {
    rt::RenderStats stats;
    stats.scene.spheres = stats.scene.lights = 1;
    EXPECT_TRUE(holds(rt::holdings_text(stats), "1 sphere, 0 cones, 0 triangles, 1 light"));
    stats.device.fallback_from = "a device";
    EXPECT_TRUE(holds(rt::stats_text(stats), "instead of a device, which failed"));
}

/// A scene's page of which only timings are there.
rt::Report stopped_report() {
    rt::Report report;
    rt::ReportScene scene;
    scene.has_pictures = scene.complete = false;
    scene.bench.references.emplace_back().scene.name = "half a scene";
    report.scenes.push_back(scene);
    report.environment = {{"program", "mirrorball"}};
    return report;
}

TEST(ReportPage, SaysThatItIsIncomplete) {
    rt::Report report = stopped_report();
    report.stopped = "interrupted (Ctrl-C)";
    const std::string page = rt::report_page(report);
    EXPECT_TRUE(holds(page, "Incomplete: interrupted (Ctrl-C)"));
    EXPECT_TRUE(holds(page, "(incomplete)</title>"));
    EXPECT_FALSE(holds(page, "<h3>Pictures</h3>"));
}

TEST(ReportPage, SaysThatTheMachineWasBusy) {
    rt::Report report = stopped_report();
    report.load_before = 1e3;
    EXPECT_TRUE(holds(rt::report_page(report), "Busy machine (others use 1000.0"));
    report.load_before = 0;
    EXPECT_FALSE(holds(rt::report_page(report), "Busy machine"));
}

TEST(ReportPage, EscapesTheScenesNames) {
    const std::string evil = "</title></script><script>alert('x')</script>\"><img src=x>";
    rt::Report report;
    const rt::ReportPicture shot = tiny_picture(evil);
    rt::ReportScene scene{shot, shot, shot.picture, {}, {}, {{"name", evil}}, {}, std::nullopt};
    report.scenes.push_back(scene);
    report.environment = {{"program", evil}};
    report.commands = {"mirrorball report " + evil};
    const std::string page = rt::report_page(report);
    EXPECT_FALSE(holds(page, "<script>"));
    EXPECT_FALSE(holds(page, "<img src=x"));
    EXPECT_TRUE(holds(page, "&lt;img src=x&gt;"));
}

}  // namespace
