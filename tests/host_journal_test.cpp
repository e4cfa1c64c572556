// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstring>

#include "host/base/error.h"
#include "host/journal/journal_file.h"
#include "host/journal/shares.h"
#include "host/picture/render_picture.h"
#include "host/scene/scene_file.h"
#include "tests/picture_files.h"
#include "tests/refusals.h"
#include "tests/test_random.h"

namespace rt::this_file {
namespace {

constexpr StopFlag never_stopped{0};

class Journals : public ScratchFolder {
   protected:
    std::string bytes_of(const std::string& name) const { return contents(path(name)); }
    void put(const std::string& name, const std::string& bytes) const {
        rt::put(path(name), bytes);
    }
};

RenderSettings small(const std::string& aa, Precision precision = Precision::float32) {
    RenderSettings settings;
    settings.size = {61, 37};
    settings.aa = parse_aa_mode(aa);
    settings.precision = precision;
    settings.tile = {16, 16};
    return settings;
}

/// Renders on threads; messages go to `said`.
RenderStats render(const RenderSettings& settings, std::vector<std::string>* said = nullptr,
                   const StopFlag& stop = never_stopped) {
    static const Scene scene = load_scene(std::string(MIRRORBALL_SCENES_DIR) + "/cornell-box.json");
    Scene changed = scene;
    apply_overrides(changed, settings);
    RenderEvents events;
    events.message = [&](const std::string& line) {
        if (said != nullptr) said->push_back(line);
    };
    const RenderedPicture rendered = render_picture(
        changed, settings, [] { return std::vector{threads_choice()}; }, events, stop);
    return rendered.stats;
}

RenderStats render_shares(RenderSettings settings, const std::string& shares,
                          const std::string& file) {
    settings.shares = parse_shares(shares);
    settings.journal = file;
    return render(settings);
}

/// The end of each record, the header first.
std::vector<std::size_t> record_ends(const std::string& bytes) {
    std::vector<std::size_t> ends;
    for (std::size_t at = journal_magic.size(); at + 12 <= bytes.size();) {
        std::uint32_t length = 0;
        std::memcpy(&length, &bytes[at + 4], 4);
        at += 12 + length;
        ends.push_back(at);
    }
    return ends;
}

TEST_F(Journals, OfSharesMergeToTheWhole) {
    for (const char* aa : {"none", "grid:3", "sobol:4", "adaptive:0.02", "edges:0.01"}) {
        for (const Precision precision : {Precision::float32, Precision::float64}) {
            const RenderSettings settings = small(aa, precision);
            const std::uint64_t whole = render(settings).image_hash;
            for (const int count : {1, 2, 7, 20}) {
                std::vector<std::string> parts;
                for (int i = count; i-- > 0;) {
                    parts.push_back(path(std::to_string(i) + ".mbj"));
                    std::filesystem::remove(parts.back());
                    render_shares(settings, std::to_string(i) + "/" + std::to_string(count),
                                  parts.back());
                }
                const MergedPicture merged = merge_journals(parts);
                EXPECT_EQ(merged.image_hash, whole) << aa << ' ' << count;
                EXPECT_EQ(merged.missing_pixels, 0u);
                EXPECT_TRUE(merged.notes.empty());
                EXPECT_EQ(merge_journals({parts.begin(), parts.begin() + 1}).missing.has_value(),
                          count > 1);
            }
        }
    }
}

/// Truncated anywhere, or with any byte changed, it is continued or restarted with the same
/// picture.
TEST_F(Journals, OfAnyLengthAreGoneOnWith) {
    for (const char* aa : {"grid:2", "adaptive:0.02"}) {
        RenderSettings settings = small(aa);
        const std::uint64_t whole = render(settings).image_hash;
        std::filesystem::remove(path("whole.mbj"));
        render_shares(settings, "0/1", path("whole.mbj"));
        const std::string bytes = bytes_of("whole.mbj");
        const std::vector<std::size_t> ends = record_ends(bytes);
        ASSERT_EQ(ends.back(), bytes.size());
        ASSERT_GT(ends.size(), 12u) << aa;
        std::vector<std::size_t> cuts = ends;
        for (std::size_t cut = 0; cut <= 24; ++cut) cuts.push_back(cut);
        for (std::size_t cut = 25; cut < ends.front() + 12; cut += 31) cuts.push_back(cut);
        Random random(3);
        for (int i = 0; i < 20; ++i) {
            cuts.push_back(
                static_cast<std::size_t>(random.uniform(0, static_cast<double>(bytes.size()))));
        }
        settings.journal = path("cut.mbj");
        settings.journal_delay = 0;
        for (const std::size_t cut : cuts) {
            put("cut.mbj", bytes.substr(0, cut));
            const RenderStats stats = render(settings);
            ASSERT_EQ(stats.image_hash, whole) << aa << " cut at " << cut;
            ASSERT_EQ(stats.resumed > 0, cut >= ends[1]) << cut;
            ASSERT_EQ(stats.resumed == 1 && stats.rays.total() == 0, cut >= ends.back() - 12)
                << cut;
        }
        for (int i = 0; i < 25; ++i) {
            std::string wrong = bytes;
            const auto at =
                static_cast<std::size_t>(random.uniform(0, static_cast<double>(bytes.size())));
            wrong[at] ^= 1;
            put("cut.mbj", wrong);
            ASSERT_EQ(render(settings).image_hash, whole) << aa << " wrong at " << at;
        }
    }
}

TEST_F(Journals, OfASharesRenderThatWasCutAreFinishedByIt) {
    const RenderSettings settings = small("adaptive:0.02");
    const std::uint64_t whole = render(settings).image_hash;
    render_shares(settings, "1/2", path("b.mbj"));
    render_shares(settings, "0/2", path("a.mbj"));
    const std::string bytes = bytes_of("a.mbj");
    for (const std::size_t end : record_ends(bytes)) {
        put("a.mbj", bytes.substr(0, end));
        if (end < bytes.size()) {
            const MergedPicture merged = merge_journals({path("b.mbj"), path("a.mbj")});
            const bool has_all = end == bytes.size() - 12;  // it lacks the record that says so
            EXPECT_EQ(merged.missing, has_all ? std::nullopt : std::optional(Shares{{0}, 2}));
        }
        render_shares(settings, "0/2", path("a.mbj"));
        EXPECT_EQ(merge_journals({path("a.mbj"), path("b.mbj")}).image_hash, whole);
    }
}

TEST_F(Journals, AreWrittenWhileThePictureIsMade) {
    RenderSettings settings = small("grid:2");
    settings.journal = path("p.mbj");
    render(settings);
    EXPECT_FALSE(std::filesystem::exists(settings.journal)) << "not worth it";
    settings.journal_delay = 0;
    StopFlag stop{2};
    std::vector<std::string> said;
    EXPECT_FALSE(render(settings, &said, stop).complete());
    EXPECT_FALSE(std::filesystem::exists(settings.journal)) << "nothing to keep";
    EXPECT_TRUE(said.empty()) << said.front();
}

TEST_F(Journals, OfOtherPicturesAreNotUsed) {
    RenderSettings settings = small("grid:2");
    render_shares(settings, "0/1", path("p.mbj"));
    const std::string bytes = bytes_of("p.mbj");
    settings.journal = path("p.mbj");
    const auto resumed = [&](RenderSettings changed) {
        put("p.mbj", bytes);
        std::vector<std::string> said;
        const RenderStats stats = render(changed, &said);
        EXPECT_EQ(said.size(), 1u);
        changed.journal.clear();
        EXPECT_EQ(stats.image_hash, render(changed).image_hash);
        return stats.resumed;
    };
    EXPECT_EQ(resumed(settings), 1);
    std::vector<RenderSettings> others(6, settings);
    others[0].aa = grid_aa(3);
    others[1].size = {60, 37};
    others[2].max_bounces = 1;
    others[3].precision = Precision::float64;
    others[4].crop = Rect{0, 0, 61, 36};
    others[5].aa = parse_aa_mode("sobol:4");
    for (const RenderSettings& other : others) EXPECT_EQ(resumed(other), 0);
    put("p.mbj", bytes);
    settings.fresh = true;
    EXPECT_EQ(render(settings).resumed, 0);
}

TEST_F(Journals, ThatAreSomethingElseStay) {
    RenderSettings settings = small("grid:2");
    settings.journal = path("p.mbj");
    settings.journal_delay = 0;
    const std::string text = "my thesis";
    put("p.mbj", text);
    std::vector<std::string> said;
    EXPECT_TRUE(render(settings, &said).complete());
    EXPECT_EQ(said.size(), 1u);
    EXPECT_EQ(bytes_of("p.mbj").size(), text.size());
    settings.shares = Shares{{0}, 2};
    settings.fresh = true;
    EXPECT_THROW(render(settings), Error);
    EXPECT_EQ(bytes_of("p.mbj").size(), text.size());
}

TEST_F(Journals, AreOfOneProcessAtATime) {
    render_shares(small("grid:2"), "0/2", path("p.mbj"));
    const JournalFile held(path("p.mbj"));
    const auto [code, message] = refusal_of([&] { const JournalFile second(path("p.mbj")); });
    EXPECT_EQ(code, ExitCode::output);
    EXPECT_NE(message.find("another process is rendering"), message.npos) << message;
}

TEST_F(Journals, CreatedByAnotherProcessAreLeftToIt) {
    JournalFile second(path("p.mbj"));
    render_shares(small("grid:2"), "0/2", path("p.mbj"));
    const JournalFile first(path("p.mbj"));
    const std::string bytes = bytes_of("p.mbj");
    second.append({});
    EXPECT_NE(second.failure(), "");
    second.remove();
    EXPECT_EQ(bytes_of("p.mbj"), bytes);
}

TEST_F(Journals, MergeRefusesWhatDiffers) {
    const RenderSettings settings = small("grid:2");
    render_shares(settings, "0/2", path("a.mbj"));
    render_shares(settings, "0-1/2", path("b.mbj"));
    EXPECT_EQ(merge_journals({path("a.mbj"), path("b.mbj")}).missing_pixels, 0u);
    std::string bytes = bytes_of("a.mbj");
    const std::vector<std::size_t> ends = record_ends(bytes);
    const std::size_t body = ends[0] + 12, length = ends[1] - body;
    Rect tile{};
    std::memcpy(&tile, &bytes[body], sizeof(tile));
    bytes[body + length - 1] ^= 1;  // a driver that computes wrong
    const std::uint32_t crc =
        record_crc(RecordKind::tile, std::as_bytes(std::span(bytes)).subspan(body, length));
    std::memcpy(&bytes[body - 4], &crc, 4);
    put("a.mbj", bytes);
    const Refusal wrong = refusal_of([&] { merge_journals({path("a.mbj"), path("b.mbj")}); });
    EXPECT_EQ(wrong.exit_code, ExitCode::different);
    const std::string place = " differ at " + std::to_string(tile.x + tile.width - 1) + "," +
                              std::to_string(tile.y + tile.height - 1) + ";";
    for (const std::string& words :
         {std::string("a.mbj (threads on "), std::string("b.mbj (threads on "), place}) {
        EXPECT_NE(wrong.message.find(words), std::string::npos) << wrong.message;
    }
    render_shares(small("grid:3"), "1/2", path("c.mbj"));
    const Refusal other = refusal_of([&] { merge_journals({path("b.mbj"), path("c.mbj")}); });
    EXPECT_EQ(other.exit_code, ExitCode::input);
    EXPECT_NE(other.message.find("c.mbj: is not a part of the same picture as"), std::string::npos)
        << other.message;
}

TEST_F(Journals, HaveTheTilesThatAreFinished) {
    Film<float> film(4, 2);
    for (std::size_t i = 0; i < film.rgb.size(); ++i) film.rgb[i] = static_cast<float>(i);
    JournalHeader header;
    header.picture.width = 4;
    header.picture.height = 2;
    header.picture.region = {0, 0, 4, 2};
    JournalFile file(path("f.mbj"));
    file.restart(journal_start(header));
    {
        JournalKeeper<float> keeper(file, film, header.picture.region, 0, true);
        keeper.tile_finished({2, 0, 2, 1});
        keeper.close(false);
    }
    EXPECT_EQ(file.failure(), "");
    std::ifstream stream(path("f.mbj"), std::ios::binary);
    JournalReader reader(stream, bytes_of("f.mbj").size());
    EXPECT_EQ(reader.header(), header);
    const KnownPixels<float> known = read_known_pixels<float>(reader);
    EXPECT_EQ(known.is_rendered, (std::vector<std::uint8_t>{0, 0, 1, 1, 0, 0, 0, 0}));
    EXPECT_TRUE(known.has({2, 0, 2, 1}));
    EXPECT_FALSE(known.has({2, 0, 2, 2}));
    EXPECT_EQ(known.film.rgb[6], 6);
    EXPECT_EQ(known.film.rgb[0], 0);
}

}  // namespace
}  // namespace rt::this_file
