// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "host/picture/crew.h"
#include "host/print/print_run.h"
#include "host/record/record.h"
#include "host/stress/families.h"
#include "host/stress/judge.h"
#include "host/stress/stress_scenes.h"
#include "tests/refusals.h"

namespace rt::this_file {
namespace {

// The families and their names

TEST(StressGlob, FitsAFamilyOrOneOfItsCases) {
    EXPECT_TRUE(fits_glob("scale-*", "scale-2", "2^-40"));
    EXPECT_TRUE(fits_glob("scale-2", "scale-2", "2^-40"));
    EXPECT_TRUE(fits_glob("scale-2/2^-4?", "scale-2", "2^-40"));
    EXPECT_TRUE(fits_glob("*/2^-40", "scale-2", "2^-40"));
    EXPECT_FALSE(fits_glob("scale", "scale-2", "2^-40"));
    EXPECT_FALSE(fits_glob("scale-2/2^4", "scale-2", "2^-40"));
    EXPECT_FALSE(fits_glob("", "scale-2", "2^-40"));
}

TEST(StressFamilies, AreNamedOnceAndHaveReasons) {
    std::set<std::string> names;
    for (const StressFamily& family : all_stress_families()) {
        EXPECT_TRUE(names.insert(family.name).second) << family.name;
        EXPECT_EQ(family.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"),
                  std::string::npos);
        EXPECT_FALSE(family.why.empty()) << family.name;
        std::set<std::string> labels;
        bool quick = false;
        for (const StressCase& one : family.cases) {
            EXPECT_TRUE(labels.insert(one.label).second) << family.name << "/" << one.label;
            quick = quick || one.quick;
        }
        EXPECT_TRUE(quick) << family.name << " has no quick case";
    }
}

TEST(StressFamilies, AnUnknownGlobListsThem) {
    const auto [code, message] =
        refusal_of([] { chosen_families(all_stress_families(), {"no-such-family"}, {}, false); });
    EXPECT_EQ(code, ExitCode::usage);
    EXPECT_NE(message.find("no-such-family"), message.npos);
    EXPECT_NE(message.find("\n  facing-mirrors"), message.npos);
}

TEST(StressFamilies, AreChosenAndLeftOut) {
    const auto chosen =
        chosen_families(all_stress_families(), {"scale-*", "ties"}, {"scale-10", "ties/b*"}, true);
    ASSERT_EQ(chosen.size(), 2U);
    EXPECT_EQ(chosen[0].name, "scale-2");
    EXPECT_EQ(chosen[1].name, "ties");
    for (const StressFamily& family : chosen) {
        for (const StressCase& one : family.cases) {
            EXPECT_TRUE(one.quick);
            EXPECT_NE(one.label, "ball");
        }
    }
}

// The judge

Scene small_still_life() {
    Scene scene = still_life();
    set_image_size(scene, 40, 30);
    return scene;
}

TEST(StressJudge, TheReferenceItselfIsRight) {
    ReferencePicture reference(small_still_life(), ReferenceKind::quad);
    const PictureFigures figures = judge_stress_picture(reference.as_picture(), reference);
    EXPECT_EQ(figures.wrong + figures.wrong_at_edges + figures.nans, 0U);
    EXPECT_LT(figures.max_error, 1e-7);
    EXPECT_EQ(exceeded_tolerance(figures, StressTolerance{}), "");
}

/// One pixel off by 0.01, then by 0.001.
TEST(StressJudge, ABrokenPictureFails) {
    ReferencePicture reference(small_still_life(), ReferenceKind::quad);
    const Picture right = reference.as_picture();
    Picture picture = right;
    picture.pixels[3 * (25 * 40 + 3)] += 0.01F;
    PictureFigures figures = judge_stress_picture(picture, reference);
    EXPECT_EQ(figures.wrong, 1U);
    EXPECT_NEAR(figures.max_error, 0.01, 1e-6);
    EXPECT_EQ(exceeded_tolerance(figures, StressTolerance{}), "1 pixel is wrong");
    picture = right;
    picture.pixels[3 * (25 * 40 + 3)] += 0.001F;
    figures = judge_stress_picture(picture, reference);
    EXPECT_EQ(figures.wrong, 0U);
    EXPECT_EQ(exceeded_tolerance(figures, StressTolerance{}), "off by 0.001");
}

TEST(StressJudge, RaysMustBeTracedAndRight) {
    StressTolerance tolerance;
    tolerance.most_wrong = 2;
    EXPECT_EQ(exceeded_tolerance(RayFigures{0, 0, 0}, tolerance), "no ray was traced");
    EXPECT_EQ(exceeded_tolerance(RayFigures{10, 2, 1e-5}, tolerance), "");
    EXPECT_EQ(exceeded_tolerance(RayFigures{10, 3, 0}, tolerance), "3 of 10 rays fail");
    EXPECT_EQ(exceeded_tolerance(RayFigures{10, 0, 0.5}, tolerance), "off by 0.5");
    EXPECT_NE(exceeded_tolerance(RayFigures{10, 0, NAN}, tolerance), "");
}

TEST(StressJudge, NaNIsWrongAndInfinityOnlySaturates) {
    ReferencePicture reference(small_still_life(), ReferenceKind::quad);
    Picture picture = reference.as_picture();
    picture.pixels[7] = std::numeric_limits<float>::quiet_NaN();
    PictureFigures figures = judge_stress_picture(picture, reference);
    EXPECT_EQ(figures.nans, 1U);
    EXPECT_EQ(figures.wrong + figures.wrong_at_edges, 1U);
    EXPECT_NE(exceeded_tolerance(figures, StressTolerance{}), "");
    StressTolerance bright;
    bright.may_overflow = true;
    EXPECT_NE(exceeded_tolerance(figures, bright), "");
    figures = {};
    figures.infinities = 1;
    EXPECT_NE(exceeded_tolerance(figures, StressTolerance{}), "");
    EXPECT_EQ(exceeded_tolerance(figures, bright), "");
}

/// A floor's edge against the background runs through some pixels: a change there is tolerated, a
/// change next to it is not.
TEST(StressJudge, EdgesAreWhereTheReferenceChanges) {
    Scene scene = bare_scene();
    scene.lights.clear();
    set_image_size(scene, 10, 10);
    set_orthographic(scene, {0, 0, 5}, {0, 0, 0}, 10);
    // Its right edge lies 0.01 pixel right of the middle of column 5.
    add_quad(scene, {-20, -20, 0}, {0.51, -20, 0}, {0.51, 20, 0}, {-20, 20, 0},
             add_matt(scene, glm::dvec3(1)));
    ReferencePicture reference(scene, ReferenceKind::quad);
    Picture picture = reference.as_picture();
    for (int x = 4; x <= 6; ++x) picture.pixels[static_cast<std::size_t>(3 * x)] += 0.1F;
    const PictureFigures figures = judge_stress_picture(picture, reference);
    EXPECT_EQ(figures.wrong, 2U);
    EXPECT_EQ(figures.wrong_at_edges, 1U);
}

TEST(StressVerdict, OneRowOrOneDisagreementBreaksIt) {
    StressResult result;
    result.families.resize(1);
    result.families[0].cases.resize(1);
    StressCaseResult& one = result.families[0].cases[0];
    one.rows.resize(2);
    EXPECT_TRUE(result.passed());
    one.rows[1].why = "broken";
    EXPECT_FALSE(result.passed());
    one.rows[1].judged = false;
    EXPECT_TRUE(result.passed());
    one.disagreement = "devices differ";
    EXPECT_FALSE(result.passed());
}

TEST(StressVerdict, NothingMeasuredIsNoPass) {
    StressResult result;
    EXPECT_FALSE(result.passed());
    result.families.resize(1);
    EXPECT_FALSE(result.passed());
    result.families[0].cases.resize(1);
    EXPECT_FALSE(result.passed());
    result.families[0].cases[0].rows.resize(1);
    EXPECT_TRUE(result.passed());
}

/// Two cases on threads, the second wrong, and a row in double that is not judged next to each.
StressResult small_result() {
    StressResult result;
    StressFamily family{"scale-2", "scale", "absolute epsilons", {}};
    result.families.push_back({family.name, family.parameter, family.why, {}});
    for (const double value : {1.0, 16.0}) {
        StressCaseResult one;
        one.label = std::to_string(static_cast<int>(value));
        one.value = value;
        StressRow row;
        row.renderer = row.device = "threads";
        row.figures.max_error = value * 1e-5;
        row.why = value > 1 ? "off by 0.00016" : "";
        one.rows.push_back(row);
        row.precision = Precision::float64;
        row.judged = false;
        row.figures.wrong = 123;
        one.rows.push_back(row);
        result.families[0].cases.push_back(one);
    }
    return result;
}

TEST(StressTable, NamesWhatIsBroken) {
    const std::string text = stress_text(small_result(), false);
    EXPECT_NE(text.find("\n  16                       threads float"), std::string::npos);
    EXPECT_NE(text.find("  FAIL: off by 0.00016\n"), std::string::npos);
    EXPECT_EQ(text.find("\n  1 "), std::string::npos);
    EXPECT_NE(text.find("FAIL: 0 of 1 families"), std::string::npos);
    EXPECT_NE(stress_text(small_result(), true).find("threads double"), std::string::npos);
}

TEST(StressJson, SaysTheSame) {
    const Json json = Json::parse(result_json("stress", small_result()));
    EXPECT_FALSE(json["passed"].get<bool>());
    EXPECT_EQ(json["families"][0]["cases"][1]["rows"][0]["verdict"], "fail");
    EXPECT_EQ(json["families"][0]["cases"][1]["rows"][1]["verdict"], "not judged");
    EXPECT_TRUE(json["families"][0]["cases"][0]["bar"]["wrong_at_edges"].is_null());
}

// The runner

TEST(StressRun, CasesThatShouldHaveTheSameBitsAndDoNotFail) {
    StressFamily family{"two", "background", "", {}};
    for (const double blue : {0.5, 0.5, 0.5 + 1e-6}) {
        Scene scene = small_still_life();
        scene.background.z = blue;
        family.cases.push_back(labeled(label_of(blue), blue, same_bits(scene)));
    }
    StressOptions options;
    options.devices = {"threads"};
    options.quiet = true;
    RenderCache cache;
    const StressResult result = run_stress_cases({family}, options, cache);
    ASSERT_EQ(result.families.at(0).cases.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        for (const StressRow& row : result.families[0].cases[i].rows) {
            EXPECT_EQ(row.why, i < 2 ? "" : "bits differ from the first case");
        }
    }
}

/// The verdicts of a trial on threads, in float and in double.
std::vector<std::string> verdicts_of(const RayTrial& trial, StressTolerance tolerance) {
    StressOptions options;
    options.devices = {"threads"};
    options.quiet = true;
    RenderCache cache;
    const StressFamily family{"rays", "", "", {{"1", 0, tolerance, trial, false}}};
    std::vector<std::string> verdicts;
    const StressResult result = run_stress_cases({family}, options, cache);
    for (const auto& row : result.families[0].cases[0].rows) verdicts.emplace_back(row.verdict());
    return verdicts;
}

TEST(StressRun, DoubleMustBeBetterThanFloatAtRays) {
    RayTrial trial{[](auto rays, auto&, auto) { return RayFigures{rays, 0, 1e-6}; }, 100};
    EXPECT_EQ(verdicts_of(trial, {}), (std::vector<std::string>{"pass", "fail"}));
    trial.run = [](auto rays, auto&, auto) { return RayFigures{rays, 5, 1e-12}; };
    EXPECT_EQ(verdicts_of(trial, {.most_wrong = 50}), (std::vector<std::string>{"pass", "fail"}));
    EXPECT_EQ(verdicts_of(trial, {.most_wrong = 1000}), (std::vector<std::string>{"pass", "pass"}));
}

TEST(StressRun, ADeviceThatFailsIsJudgedInFloatToo) {
    const RayTrial trial{
        [](auto, auto&, auto) -> RayFigures { throw Error(ExitCode::device, "x"); }};
    EXPECT_EQ(verdicts_of(trial, {.in_float = false}), (std::vector<std::string>{"fail", "fail"}));
}

// Rays

TEST(RayTrials, ABallThatMostRaysMissIsCounted) {
    Scene scene = bare_scene();
    add_sphere(scene, {0, 0, -3}, 1, add_matt(scene, glm::dvec3(1)));
    set_view(scene, {0, 0, 0}, {0, 0, -1}, 60);
    RayCaster caster = threads_ray_caster();
    EXPECT_EQ(leaving_sphere(scene, 1e-2).run(10000, caster, Precision::float32).failures, 0U);
    caster.in_float = [right = caster.in_float](const FlatScene<float>& flat) {
        return [trace = right(flat)](auto queries, auto answers) {
            trace(queries, answers);
            for (std::size_t i = 0; i < answers.size(); ++i) {
                if (i % 1000 != 0) answers[i].prim = Flat<float>::none;
            }
        };
    };
    EXPECT_GT(leaving_sphere(scene, 1e-2).run(10000, caster, Precision::float32).failures, 3000U);
}

TEST(RayTrials, AHoleInAMeshIsCounted) {
    Scene scene = bare_scene();
    Scene::Mesh mesh = ball_mesh(1);
    mesh.faces.pop_back();
    add_mesh(scene, mesh, add_matt(scene, glm::dvec3(1)));
    set_view(scene, {0, 0, 0}, {0, 0, -1}, 60);
    EXPECT_GT(
        leaks(scene, RayAim::edges).run(10000, threads_ray_caster(), Precision::float32).failures,
        50U);
}

TEST(RayTrials, AreTheSameEachTime) {
    Scene scene = bare_scene();
    add_sphere(scene, {0, 0, -4}, 1e-5, add_matt(scene, glm::dvec3(1)));
    set_view(scene, {0, 0, 0}, {0, 0, -1}, 60);
    const RayFigures first =
        past_sphere(scene).run(20000, threads_ray_caster(), Precision::float32);
    const RayFigures second =
        past_sphere(scene).run(20000, threads_ray_caster(), Precision::float32);
    EXPECT_EQ(first.rays, 20000U);
    EXPECT_EQ(first.failures, second.failures);
    EXPECT_EQ(first.max_error, second.max_error);
}

/// In packets of every width.
#ifdef MIRRORBALL_SANITIZED
constexpr int lane_widths[] = {1, 0};  // what is compiled: 0 is the width of a vector
#else
constexpr int lane_widths[] = {1, 2, 4, 8, 16};
#endif

TEST(LeavingEdges, StaysOnItsSide) {
    for (const Scene::Mesh& mesh : {box_mesh(), wedge_mesh(3), wedge_mesh(150), ball_mesh(1)}) {
        Scene scene = bare_scene();
        add_mesh(scene, mesh, add_matt(scene, glm::dvec3(1)));
        set_view(scene, {0.5, 0.0625, 0.125}, {1, 0, 0}, 60);
        for (const MeshSide side : {MeshSide::inside, MeshSide::outside}) {
            for (const int lanes : lane_widths) {
                const RayCaster caster = threads_ray_caster(lanes);
                EXPECT_EQ(edge_escapes(scene, side).run(10000, caster, Precision::float32).failures,
                          0U);
                EXPECT_EQ(edge_escapes(scene, side).run(10000, caster, Precision::float64).failures,
                          0U);
            }
        }
    }
}

TEST(StressMeshes, AreClosed) {
    for (const Scene::Mesh& mesh : {ball_mesh(2), bumpy_mesh(1), fan_mesh(50),
                                    needle_mesh(6, 3, 1e-6), wedge_mesh(10), box_mesh()}) {
        std::set<std::pair<int, int>> edges;
        for (const auto& face : mesh.faces) {
            for (std::size_t i = 0; i < 3; ++i) {
                EXPECT_TRUE(edges.insert({face[i], face[(i + 1) % 3]}).second);
            }
        }
        for (const auto& [a, b] : edges) EXPECT_TRUE(edges.count({b, a}) == 1);
    }
}

}  // namespace
}  // namespace rt::this_file
