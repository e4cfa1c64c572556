// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "host/scene/model.h"
#include "host/scene/scene_file.h"
#include "tests/refusals.h"

namespace rt::this_file {
namespace {

using Positions = std::vector<glm::dvec3>;
using Faces = std::vector<Scene::Mesh::Face>;

TEST(ParsePly, BadFilesAreRefusedAsExpected) {
    for (const auto& path : malformed_files(".ply")) {
        expect_announced(path, refusal_of([&] { load_scene(path.string()); }));
    }
}

TEST(ParsePly, BlemishesAreNoted) {
    for (const auto& path : blemished_files(".ply")) {
        expect_announced(path, load_scene(path.string()).notes);
    }
}

/// Builds the data of a PLY file value by value, as text or as bytes of either order.
class PlyData {
   public:
    explicit PlyData(std::string format) : format_(std::move(format)) {}

    template <typename T>
    PlyData& add(T value) {
        if (format_ == "ascii") {
            text_ += std::to_string(value) + " ";
            return *this;
        }
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), &value, sizeof(T));
        const bool little = format_ == "binary_little_endian";
        if (little != (std::endian::native == std::endian::little)) {
            std::reverse(bytes.begin(), bytes.end());
        }
        text_.append(bytes.begin(), bytes.end());
        return *this;
    }

    void end_row() {
        if (format_ == "ascii") text_ += "\n";
    }

    std::string file(const std::string& header, const std::string& line_end = "\n") const {
        std::string text = "ply\nformat " + format_ + " 1.0\n" + header + "end_header\n";
        for (std::size_t at = 0; line_end != "\n" && (at = text.find('\n', at)) != text.npos;) {
            text.replace(at, 1, line_end);
            at += line_end.size();
        }
        return text + text_;
    }

   private:
    std::string format_, text_;
};

constexpr const char* formats[] = {"ascii", "binary_little_endian", "binary_big_endian"};

/// Every scalar type, in vertices, lists and list lengths, with unknown elements and properties in
/// between.
std::string ply_of_all_types(const std::string& format, const std::string& line_end) {
    PlyData data(format);
    data.add<std::int16_t>(2).add<double>(0.5).add<double>(0.25).end_row();
    for (int i = 0; i < 4; ++i) {
        data.add<std::uint8_t>(200).add<double>(i % 2).add<std::uint8_t>(2);
        data.add<float>(1.5f).add<float>(2.5f).add<float>(static_cast<float>(i / 2));
        data.add<std::int8_t>(-3).add<float>(0).add<double>(0).add<std::int16_t>(1).end_row();
    }
    data.add<std::int32_t>(-7).end_row();
    data.add<std::uint32_t>(1).add<float>(9).add<std::int8_t>(3);
    data.add<std::uint16_t>(0).add<std::uint16_t>(1).add<std::uint16_t>(2).end_row();
    data.add<std::uint32_t>(0).add<std::int8_t>(4);
    data.add<std::uint16_t>(0).add<std::uint16_t>(1).add<std::uint16_t>(3).add<std::uint16_t>(2);
    data.end_row();
    return data.file(
        "comment made by hand\nobj_info nothing\n"
        "element before 1\nproperty list short float64 stuff\n"
        "element vertex 4\nproperty uchar red\nproperty double x\n"
        "property list uint8 float32 uv\nproperty float y\nproperty char z\n"
        "property float nx\nproperty float64 ny\nproperty int16 nz\n"
        "element between 1\nproperty int32 n\n"
        "element face 2\nproperty list uint float texture\n"
        "property list int8 ushort vertex_index\n",
        line_end);
}

TEST(ParsePly, AllFormatsAndTypesGiveTheSameMesh) {
    for (const std::string format : formats) {
        for (const std::string line_end : {"\n", "\r\n", "\r"}) {
            SCOPED_TRACE(format);
            const Scene::Mesh mesh = parse_ply(ply_of_all_types(format, line_end), "t.ply").mesh;
            EXPECT_EQ(mesh.positions, (Positions{{0, 0, -3}, {1, 0, -3}, {0, 1, -3}, {1, 1, -3}}));
            EXPECT_EQ(mesh.normals, Positions(4, glm::dvec3(0, 0, 1)));
            EXPECT_EQ(mesh.faces, (Faces{{0, 1, 2}, {0, 1, 3}, {0, 3, 2}}));
            EXPECT_EQ(mesh.face_normals, mesh.faces);
            EXPECT_EQ(mesh.face_materials, std::vector<int>{-1});
        }
    }
}

TEST(ParsePly, EveryCutOfABinaryFileIsRefused) {
    for (const std::string format : {"binary_little_endian", "binary_big_endian"}) {
        const std::string whole = ply_of_all_types(format, "\n");
        for (std::size_t size = 0; size < whole.size(); ++size) {
            const Refusal refusal = refusal_of([&] { parse_ply(whole.substr(0, size), "t.ply"); });
            EXPECT_EQ(refusal.exit_code, ExitCode::input) << size;
        }
    }
}

TEST(ParsePly, TheLastLineOfTheHeaderMayEndOtherwise) {
    for (const std::string format : {"binary_little_endian", "binary_big_endian"}) {
        const Scene::Mesh mesh = parse_ply(ply_of_all_types(format, "\n"), "t.ply").mesh;
        for (const auto& [ends, last] :
             {std::pair{"\n", "\r\n"}, {" \n", "\r\n"}, {"\r\n", "\n"}}) {
            std::string text = ply_of_all_types(format, ends);
            const std::size_t mark = text.find("end_header") + std::strlen("end_header");
            text.replace(mark, std::strlen(ends), last);
            const Model model = parse_ply(text, "t.ply");
            EXPECT_EQ(model.mesh.positions, mesh.positions);
            EXPECT_EQ(model.mesh.faces, mesh.faces);
            EXPECT_TRUE(model.notes.empty());
        }
    }
}

TEST(ParsePly, BytesAfterTheEndAreNoted) {
    const std::string whole = ply_of_all_types("binary_little_endian", "\n");
    EXPECT_TRUE(parse_ply(whole + "\n", "t.ply").notes.empty());
    const Model model = parse_ply(whole + "more of it", "t.ply");
    ASSERT_EQ(model.notes.size(), 1u);
    EXPECT_EQ(model.notes[0],
              "t.ply: end: more data follows than the header declares; correct its counts (1 end "
              "ignored)");
}

/// Two strips in one list, as in Stanford's models, one of which turns a corner.
std::string ply_of_strips(const std::string& format) {
    PlyData data(format);
    for (int i = 0; i < 6; ++i) {
        data.add<float>(static_cast<float>(i / 2)).add<float>(static_cast<float>(i % 2));
        data.add<float>(0).end_row();
    }
    data.add<int>(10);
    for (const int i : {0, 1, 2, 3, -1, 2, 3, 4, 5, -1}) data.add<int>(i);
    data.end_row();
    data.add<int>(5);
    for (const int i : {0, 2, 2, 1, 3}) data.add<int>(i);
    data.end_row();
    return data.file(
        "element vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 2\nproperty list int int vertex_indices\n");
}

TEST(ParsePly, StripsAreTriangles) {
    for (const std::string format : formats) {
        SCOPED_TRACE(format);
        const Model model = parse_ply(ply_of_strips(format), "t.ply");
        EXPECT_EQ(model.mesh.faces, (Faces{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}, {2, 1, 3}}));
        EXPECT_TRUE(model.notes.empty());
    }
}

TEST(ParsePly, PositionsAreFloatsExactly) {
    PlyData data("binary_big_endian");
    for (const float x : {0.1f, 1e-30f, -3e29f, 1.f, 2.f, 3.f, 4.f, 5.f, 7.f}) data.add(x);
    data.add<std::uint8_t>(3).add<int>(2).add<int>(0).add<int>(1);
    const Scene::Mesh mesh =
        parse_ply(data.file("element vertex 3\nproperty float x\nproperty float y\n"
                            "property float z\nelement face 1\n"
                            "property list uchar int vertex_indices\n"),
                  "t.ply")
            .mesh;
    EXPECT_EQ(mesh.positions[0], glm::dvec3(0.1f, 1e-30f, -3e29f));
    EXPECT_EQ(mesh.faces, (Faces{{2, 0, 1}}));
}

/// A grid of squares, each as two triangles or one quadrilateral; `last` is the last face.
std::string ply_grid(const std::string& format, int side, bool quads,
                     const std::vector<int>& last = {}) {
    PlyData data(format);
    for (int i = 0; i < side * side; ++i) {
        data.add<std::uint8_t>(9).add<float>(static_cast<float>(i % side)).add<double>(i / side);
        data.add<std::int16_t>(static_cast<std::int16_t>(i % 7));
        data.add<float>(0).add<float>(0).add<float>(1).end_row();
    }
    int count = 0;
    const auto add = [&](const std::vector<int>& corners) {
        data.add<std::int16_t>(-1).add<std::uint8_t>(static_cast<std::uint8_t>(corners.size()));
        for (const int corner : corners)
            data.add<std::uint16_t>(static_cast<std::uint16_t>(corner));
        data.add<float>(0.5f).end_row();
        ++count;
    };
    for (int i = 0; i < side * (side - 1) - 1; ++i) {
        if (i % side == side - 1) continue;
        if (quads) add({i, i + 1, i + side + 1, i + side});
        if (!quads) add({i, i + 1, i + side}), add({i + 1, i + side + 1, i + side});
    }
    if (!last.empty()) add(last);
    return data.file("element vertex " + std::to_string(side * side) +
                     "\nproperty uchar red\nproperty float x\nproperty double y\nproperty short z\n"
                     "property float nx\nproperty float ny\nproperty float nz\nelement face " +
                     std::to_string(count) +
                     "\nproperty short flags\nproperty list uchar ushort vertex_indices\n"
                     "property float quality\n");
}

/// The notes without the places, which are lines in text and rows in bytes.
std::vector<std::string> without_places(std::vector<std::string> notes) {
    for (std::string& note : notes) note.erase(0, note.find(": the polygon"));
    return notes;
}

/// ASCII is the reference: it is read row by row.
TEST(ParsePly, RowsReadSideBySideAreTheSame) {
    for (const bool quads : {false, true}) {
        for (const std::vector<int>& last :
             {std::vector<int>{}, {0, 1, 2}, {0, 1, 13, 12}, {0, 1, 2, 14, 12}, {0, 13, 1, 12}}) {
            const Model text = parse_ply(ply_grid("ascii", 12, quads, last), "t.ply");
            EXPECT_GT(text.mesh.faces.size(), 200u);
            for (const std::string format : {"binary_little_endian", "binary_big_endian"}) {
                for (const std::size_t chunk : {1, 100, 1 << 20}) {
                    const Model bytes =
                        parse_ply(ply_grid(format, 12, quads, last), "t.ply", {3, chunk});
                    EXPECT_EQ(bytes.mesh.positions, text.mesh.positions);
                    EXPECT_EQ(bytes.mesh.normals, text.mesh.normals);
                    EXPECT_EQ(bytes.mesh.faces, text.mesh.faces);
                    EXPECT_EQ(without_places(bytes.notes), without_places(text.notes));
                }
            }
        }
    }
}

TEST(ParsePly, BlemishesInRowsReadSideBySideAreToldByTheirRows) {
    for (const std::size_t chunk : {1, 1 << 20}) {
        const ReadPace pace{3, chunk};
        const std::string text = ply_grid("binary_little_endian", 12, false, {0, 1, 144});
        const Model model = parse_ply(text, "t.ply", pace);
        EXPECT_EQ(model.mesh.faces.size(), 242u);
        EXPECT_EQ(model.notes,
                  std::vector<std::string>{"t.ply: element 'face' 242: vertex 144 does not exist, "
                                           "there are 144, counted from 0; correct the number (1 "
                                           "face left out)"});
        std::string infinite = ply_grid("binary_little_endian", 12, false);
        const float bad = std::numeric_limits<float>::infinity();
        const std::size_t row = infinite.find("end_header\n") + 11 + 100 * 27;
        std::memcpy(infinite.data() + row + 1, &bad, sizeof bad);
        EXPECT_EQ(
            parse_ply(infinite, "t.ply", pace).notes,
            std::vector<std::string>{"t.ply: element 'vertex' 100: 'x' is inf; write a number "
                                     "from -1e30 to 1e30 (6 faces left out)"});
    }
}

const std::string corners_header =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string corners = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
const std::string list = "property list int int vertex_indices\n";

Model text_ply(const std::string& header, const std::string& rows) {
    return parse_ply("ply\nformat ascii 1.0\n" + header + "end_header\n" + rows, "t.ply");
}

TEST(ParsePly, RowsThatAreNoFacesAreLeftOut) {
    for (const std::string row : {"0", "2 0 1", "3 0 1 4", "3 0 1 -1", "-3 0 1 2", "3 0 1", "x",
                                  "3 0 1 1.5", "10001", "3 0 1 x"}) {
        const Model model = text_ply(corners_header + "element face 3\n" + list,
                                     corners + "3 0 1 2\n" + row + "\n3 0 1 3.0\n");
        EXPECT_EQ(model.mesh.faces, (Faces{{0, 1, 2}, {0, 1, 3}})) << row;
        ASSERT_EQ(model.notes.size(), 1u) << row;
        EXPECT_TRUE(model.notes[0].starts_with("t.ply:15:") &&
                    model.notes[0].ends_with("(1 face left out)"))
            << model.notes[0];
    }
}

TEST(ParsePly, ATextThatEndsEarlyLosesItsLastFaces) {
    const Model model =
        text_ply(corners_header + "element face 4\n" + list, corners + "3 0 1 2\n3 0 1 3\n3 1 2\n");
    EXPECT_EQ(model.mesh.faces, (Faces{{0, 1, 2}, {0, 1, 3}}));
    ASSERT_EQ(model.notes.size(), 1u);
    EXPECT_TRUE(model.notes[0].ends_with("(2 faces left out)")) << model.notes[0];
}

TEST(ParsePly, VerticesThatAreNoNumbersOnlyMatterToTheirFaces) {
    for (const std::string vertex : {"nan 0 0", "0 1e31 0", "0 0", "a 0 0"}) {
        const std::string header =
            "element vertex 5\nproperty float x\nproperty float y\nproperty float z\n";
        const auto with = [&](const std::string& faces, const std::string& count) {
            return text_ply(header + "element face " + count + "\n" + list,
                            corners + vertex + "\n" + faces);
        };
        EXPECT_TRUE(with("3 0 1 2\n", "1").notes.empty()) << vertex;
        const Model model = with("3 0 1 2\n3 0 1 4\n", "2");
        EXPECT_EQ(model.mesh.faces, (Faces{{0, 1, 2}}));
        ASSERT_EQ(model.notes.size(), 1u);
        EXPECT_TRUE(model.notes[0].starts_with("t.ply:14:") &&
                    model.notes[0].ends_with("(1 face left out)"))
            << model.notes[0];
    }
}

/// As exporters write the normals of vertices without a face.
TEST(ParsePly, NormalsThatAreNoNumbersLoseNothingElse) {
    const std::string header =
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float "
        "nx\n"
        "property float ny\nproperty float nz\nelement face 1\n";
    for (const std::string number : {"nan", "-nan", "inf", "NaN", "1e999", "-nan(ind)"}) {
        const Model model = text_ply(
            header + list, "0 0 0 0 0 1\n1 0 0 0 " + number + " 1\n" + "0 1 0 0 0 1\n3 0 1 2\n");
        EXPECT_EQ(model.mesh.faces, (Faces{{0, 1, 2}})) << number;
        EXPECT_EQ(model.mesh.normals, (Positions{{0, 0, 1}, {0, 0, 0}, {0, 0, 1}})) << number;
        ASSERT_EQ(model.notes.size(), 1u) << number;
        EXPECT_TRUE(model.notes[0].ends_with("(1 normal ignored)")) << model.notes[0];
    }
}

TEST(ParsePly, CommentsMayEndWithABackslash) {
    const Model model = text_ply(
        "comment C:\\x\\\nobj_info \\\n" + corners_header + "comment \\\r\nelement face 1\n" + list,
        corners + "3 0 1 2\n");
    EXPECT_EQ(model.mesh.faces, (Faces{{0, 1, 2}}));
    EXPECT_TRUE(model.notes.empty());
}

TEST(ParsePly, HeadersMayHaveLinesAndPropertiesOfTheirOwn) {
    const Model model = text_ply("made by hand\n" + corners_header +
                                     "property uchar pad\nproperty uchar pad\nproperty real\n"
                                     "element face 1\n" +
                                     list,
                                 "0 0 0 1 2 3\n1 0 0 1 2 3\n0 1 0 1 2 3\n0 0 1 1 2 3\n3 0 1 2\n");
    EXPECT_EQ(model.mesh.faces, (Faces{{0, 1, 2}}));
    EXPECT_EQ(model.notes, std::vector<std::string>{
                               "t.ply:3:1: unknown word 'made' in the header (1 line ignored)"});
}

}  // namespace
}  // namespace rt::this_file
