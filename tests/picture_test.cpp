// SPDX-License-Identifier: Apache-2.0
//
// Whole pictures: the same bits from every renderer, and how far float is from double.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "host/base/files.h"
#include "host/flatten/flat_scene.h"
#include "host/picture/picture_journal.h"
#include "host/scene/scene_file.h"
#include "tests/render_helpers.h"

namespace rt::test::this_file {
namespace {

/// The scene at 160 pixels wide, to keep the tests short.
Scene load_small(const std::filesystem::path& file) {
    Scene scene = load_scene(file.string());
    set_image_size(scene, 160, std::max(1, 160 * scene.height / scene.width));
    return scene;
}

ThreadsOptions threads(int count, Schedule schedule) { return {count, schedule}; }

class EveryScene : public testing::TestWithParam<std::filesystem::path> {};

enum class Compiled { with_own_features, with_own_features_too, with_all_features };

template <typename T>
void expect_one_hash(const Scene& scene, Compiled compiled = Compiled::with_own_features_too) {
    const std::uint64_t hash = hash_of(render_on_threads<T>(scene, threads(1, Schedule::tiles)));
    const Rect odd_tile{0, 0, 13, 7};
    for (const int count : {2, 7}) {
        EXPECT_EQ(hash_of(render_on_threads<T>(scene, threads(count, Schedule::tiles), odd_tile)),
                  hash);
        EXPECT_EQ(hash_of(render_on_threads<T>(scene, threads(count, Schedule::buffers))), hash);
    }
    // Samples as work items with all features alone: one program for all scenes.
    for (const auto& [launch, all_features] :
         {std::pair{Launch::pixel, false}, {Launch::pixel, true}, {Launch::sample, true}}) {
        if (compiled == (all_features ? Compiled::with_own_features : Compiled::with_all_features))
            continue;
        const ClOptions options = cl_options(launch, all_features);
        EXPECT_EQ(hash_of(render_on_device<T>(scene, options)), hash);
        EXPECT_EQ(hash_of(render_on_device<T>(scene, options, odd_tile)), hash);
    }
}

TEST_P(EveryScene, FloatHasTheSameBitsFromEveryRenderer) {
    expect_one_hash<float>(load_small(GetParam()));
}

TEST_P(EveryScene, DoubleHasTheSameBitsFromEveryRenderer) {
    if (!test_device().has_double) GTEST_SKIP() << test_device().name << " has no double";
    const bool has_own_program = GetParam().stem() == "cornell-box" || GetParam().stem() == "glass";
    expect_one_hash<double>(load_small(GetParam()), has_own_program
                                                        ? Compiled::with_own_features_too
                                                        : Compiled::with_all_features);
}

TEST_P(EveryScene, FloatStaysNearDouble) {
    const Scene scene = load_small(GetParam());
    const ImageError error =
        film_error(render_on_threads<float>(scene), render_on_threads<double>(scene));
    EXPECT_EQ(error.non_finite, 0u);
    EXPECT_LE(error.rmse, 1e-3);
    EXPECT_LE(error.over_1, 12u);  // of 19200: pixels on hard edges may flip
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, testing::ValuesIn(scene_files()), scene_name);

/// Every sampling mode, on two scenes, with every renderer.
class EveryAaMode : public testing::TestWithParam<std::tuple<const char*, Filter>> {
   protected:
    Scene scene(const char* stem) const {
        Scene made = load_named_scene(stem);
        set_image_size(made, 80, 60);
        made.aa = parse_aa_mode(std::get<0>(GetParam())).value();
        made.filter = std::get<1>(GetParam());
        return made;
    }
};

TEST_P(EveryAaMode, HasTheSameBitsFromEveryRenderer) {
    // One program with all features for all modes but those in rounds, whose programs compile long.
    const Compiled compiled = scene("cornell-box").aa.fixed_samples() ? Compiled::with_all_features
                                                                      : Compiled::with_own_features;
    if (compiled == Compiled::with_all_features) expect_one_hash<float>(scene("cornell-box"));
    for (const char* stem : {"cornell-box", "vertex-normals"}) {
        expect_one_hash<float>(scene(stem), compiled);
        if (test_device().has_double) expect_one_hash<double>(scene(stem), compiled);
    }
}

INSTANTIATE_TEST_SUITE_P(AaModes, EveryAaMode,
                         testing::Values(std::make_tuple("grid:3", Filter::box),
                                         std::make_tuple("sobol:7", Filter::box),
                                         std::make_tuple("sobol:258", Filter::box),
                                         std::make_tuple("adaptive:0.05", Filter::box),
                                         std::make_tuple("edges:0.003", Filter::box),
                                         std::make_tuple("grid:3", Filter::tent),
                                         std::make_tuple("sobol:16", Filter::gaussian),
                                         std::make_tuple("grid:4", Filter::mitchell)));

TEST(PictureJournal, DiscardsWhatIsBeingWritten) {
    const TemporaryFolder folder;
    RenderSettings settings;
    settings.journal = folder.name() + "/picture.mbj";
    settings.journal_delay = 1e-3;
    RenderStats stats;
    stats.picture.region = {0, 0, 2048, 2048};
    const FlatScene<float> scene = flatten<float>(load_named_scene("empty"));
    const Film<float> film(2048, 2048);
    PictureJournal<float> journal(settings, stats, scene, {}, [](const std::string&) {});
    journal.begin(film);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    journal.tile_finished(stats.picture.region);
    journal.discard();
    EXPECT_FALSE(std::filesystem::exists(settings.journal));
}

class PaperScene : public testing::TestWithParam<int> {
   protected:
    Scene scene() const {
        Scene paper = load_named_scene("cornell-box");
        paper.aa = grid_aa(GetParam());
        return paper;
    }
};

TEST_P(PaperScene, FloatIsWithin1e4OfDoubleDiagonalsIncluded) {
    const ImageError error =
        film_error(render_on_device<float>(scene()), render_on_threads<double>(scene()));
    EXPECT_EQ(error.non_finite, 0u);
    EXPECT_LE(error.rmse, 1e-4);
    EXPECT_LE(error.over_1, 10u);
}

TEST(PaperSceneOblong, FloatStaysNearDoubleOnTheDiagonals) {
    Scene scene = load_named_scene("cornell-box");
    scene.aa = grid_aa(1);
    set_image_size(scene, 24, 20);
    const ImageError error =
        film_error(render_on_threads<float>(scene), render_on_threads<double>(scene));
    EXPECT_EQ(error.over_1, 0u);
}

INSTANTIATE_TEST_SUITE_P(Grids, PaperScene, testing::Values(1, 2));

}  // namespace
}  // namespace rt::test::this_file
