// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "host/error.h"
#include "host/scene/affine.h"
#include "host/scene/beneath.h"
#include "host/scene/json_file.h"
#include "host/scene/mesh_builder.h"
#include "host/scene/mesh_finish.h"
#include "host/scene/model_file.h"
#include "host/scene/mtl_file.h"
#include "host/scene/obj_file.h"
#include "host/scene/ply_file.h"
#include "host/scene/scene_file.h"
#include "host/scene/text_file.h"

namespace rt {
namespace {

namespace fs = std::filesystem;
using Face = Scene::Mesh::Face;
using Positions = std::vector<glm::dvec3>;
using Faces = std::vector<Face>;
using Strings = std::vector<std::string>;

constexpr std::uint32_t none = Scene::Mesh::no_normal;

struct Refusal {
    ExitCode exit_code = ExitCode::done;
    std::string message;
};

template <class F>
Refusal refusal_of(F action) {
    try {
        action();
    } catch (const Error& error) {
        return {error.exit_code(), error.what()};
    }
    return {};
}

/// A folder of its own, gone after the test.
class ModelFiles : public testing::Test {
   protected:
    ModelFiles() { fs::create_directories(folder_); }
    ~ModelFiles() override { fs::remove_all(folder_); }

    std::string write(const std::string& name, const std::string& text) const {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return (folder_ / name).string();
    }

    const fs::path folder_ =
        fs::temp_directory_path() / ("mirrorball-models-" + std::to_string(::getpid()));
};

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Model obj(const std::string& text) { return parse_obj(text, "t.obj", {}); }

/// An OBJ whose every library is this text.
Model obj_with(const std::string& text, const std::string& library) {
    return parse_obj(text, "t.obj", [&](const std::string& name) {
        return LibraryFile{name, library, {}};
    });
}

// --- malformed files -----------------------------------------------------------------------------

void load_anything(const fs::path& path) {
    if (path.extension() == ".mtl") {
        parse_mtl(read_text_file(path.string(), 1000), path.string());
    } else {
        load_scene(path.string());
    }
}

/// "line:column: text", or " text" where there is no line, from lines with the mark "expect " in
/// the file's comments or from the .expect file beside.
std::vector<std::string> expectations(fs::path path) {
    std::vector<std::string> result;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line) && line != "end_header";) {
        for (const std::string mark : {"# expect ", "comment expect "}) {
            if (line.starts_with(mark)) result.push_back(line.substr(mark.size()));
        }
    }
    std::ifstream beside(path.replace_extension(".expect"));
    for (std::string line; std::getline(beside, line);) result.push_back(line);
    return result;
}

std::vector<fs::path> bad_models() {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(MIRRORBALL_BAD_SCENES_DIR)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("obj-") || name.starts_with("mtl-") || name.starts_with("ply-")) {
            if (entry.path().extension() != ".expect") files.push_back(entry.path());
        }
    }
    return files;
}

TEST(Models, BadFilesAreRefusedAsExpected) {
    const auto files = bad_models();
    EXPECT_GE(files.size(), 100u);
    for (const fs::path& path : files) {
        SCOPED_TRACE(path.string());
        const Refusal refusal = refusal_of([&] { load_anything(path); });
        EXPECT_EQ(refusal.exit_code, ExitCode::input);
        const auto expected = expectations(path);
        EXPECT_FALSE(expected.empty());
        for (const std::string& text : expected) {
            const std::string line = path.string() + ":" + text;
            EXPECT_NE(refusal.message.find(line), std::string::npos)
                << "expected " << line << "\nbut got  " << refusal.message;
        }
        const auto lines = std::count(refusal.message.begin(), refusal.message.end(), '\n') + 1;
        EXPECT_EQ(static_cast<std::size_t>(lines), expected.size()) << refusal.message;
    }
}

TEST(Models, AtMostTwentyMistakesAreReported) {
    std::string text;
    for (int i = 0; i < 100; ++i) text += "v nan 0 0\n";
    const Refusal refusal = refusal_of([&] { obj(text); });
    EXPECT_EQ(std::count(refusal.message.begin(), refusal.message.end(), '\n'), 19);
}

// --- polygons ------------------------------------------------------------------------------------

/// Twice the area of each triangle along z; all must be positive.
double total_area(const Positions& corners, const Faces& triangles) {
    double total = 0;
    for (const auto& [a, b, c] : triangles) {
        const double area = glm::cross(corners[b] - corners[a], corners[c] - corners[a]).z / 2;
        EXPECT_GT(area, 0);
        total += area;
    }
    return total;
}

double shoelace(const Positions& corners) {
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        sum += glm::cross(corners[i], corners[(i + 1) % corners.size()]).z / 2;
    }
    return sum;
}

/// The triangles that a builder makes of one more face.
Faces split(MeshBuilder& builder, const Positions& corners) {
    builder.mesh.faces.clear();
    builder.mesh.positions = corners;
    std::vector<std::uint32_t> face(corners.size());
    std::iota(face.begin(), face.end(), 0u);
    builder.add_face(face, {});
    return builder.mesh.faces;
}

Faces triangulate(const Positions& corners) {
    MeshBuilder builder;
    return split(builder, corners);
}

TEST(MeshFaces, ConvexPolygonIsAFan) {
    const Positions corners = {{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 2, 0}, {0, 2, 0}};
    EXPECT_EQ(triangulate(corners), (Faces{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(MeshFaces, ConcaveQuadIsCutAtItsDent) {
    const Positions dart = {{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}};
    const Faces triangles = triangulate(dart);
    ASSERT_EQ(triangles.size(), 2u);
    EXPECT_DOUBLE_EQ(total_area(dart, triangles), 1.0);
}

TEST(MeshFaces, EveryStartAndEveryAxisGiveTheSameArea) {
    const Positions shape = {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {3, 3, 0},
                             {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};  // a U of area 8
    for (std::size_t start = 0; start < shape.size(); ++start) {
        Positions turned = shape;
        std::rotate(turned.begin(), turned.begin() + static_cast<long>(start), turned.end());
        const Faces triangles = triangulate(turned);
        EXPECT_EQ(triangles.size(), 6u);
        EXPECT_DOUBLE_EQ(total_area(turned, triangles), 8.0);
        for (int axis = 1; axis < 3; ++axis) {
            Positions elsewhere;
            for (const glm::dvec3& p : turned) {
                elsewhere.push_back(axis == 1 ? glm::dvec3(p.z, p.x, p.y)
                                              : glm::dvec3(p.y, p.z, p.x));
            }
            EXPECT_EQ(triangulate(elsewhere), triangles);
        }
    }
}

TEST(MeshFaces, WindingIsThePolygons) {
    const Positions clockwise = {{0, 0, 0}, {0, 2, 0}, {0.5, 0.5, 0}, {2, 0, 0}};
    for (const auto& [a, b, c] : triangulate(clockwise)) {
        EXPECT_LT(glm::cross(clockwise[b] - clockwise[a], clockwise[c] - clockwise[a]).z, 0);
    }
}

TEST(MeshFaces, CornersOnStraightLinesStayCorners) {
    const Positions square = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0},
                              {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
    const Faces triangles = triangulate(square);
    EXPECT_EQ(triangles.size(), 6u);
    EXPECT_DOUBLE_EQ(total_area(square, triangles), 4.0);
}

TEST(MeshFaces, StarsCombsAndSpiralsKeepTheirArea) {
    Positions star, comb, spiral;
    for (int i = 0; i < 200; ++i) {
        const double angle = i * 3.14159265358979 / 100, radius = i % 2 == 0 ? 1 : 0.4;
        star.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    for (int i = 0; i < 100; ++i) comb.emplace_back(i, i % 2 == 0 ? 0 : 0.5, 0);
    for (int i = 99; i >= 0; --i) comb.emplace_back(i, i % 2 == 0 ? 0.6 : 5, 0);
    for (int side = 0; side < 2; ++side) {
        for (int k = 0; k < 300; ++k) {
            const int i = side == 0 ? k : 299 - k;
            const double angle = 0.1 * i, radius = 1 + 0.1 * angle + (side == 0 ? 0.3 : 0);
            spiral.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
        }
    }
    for (const Positions& shape : {star, comb, spiral}) {
        const Faces triangles = triangulate(shape);
        EXPECT_EQ(triangles.size(), shape.size() - 2);
        EXPECT_NEAR(total_area(shape, triangles), shoelace(shape), 1e-9);
    }
}

TEST(MeshFaces, AHoleReachedThroughASlitStaysOpen) {
    const Positions ring = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                            {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
    EXPECT_DOUBLE_EQ(total_area(ring, triangulate(ring)), 12.0);
}

TEST(MeshFaces, FacesNeedNotBeFlat) {
    const Positions saddle = {{0, 0, 0}, {1, 0, 1}, {1, 1, 0}, {0, 1, 1}};
    EXPECT_EQ(triangulate(saddle).size(), 2u);
    Positions crown;
    for (int i = 0; i < 20; ++i) {
        crown.emplace_back(std::cos(i * 0.314159), std::sin(i * 0.314159), i % 2);
    }
    MeshBuilder builder;
    EXPECT_EQ(split(builder, crown).size(), 18u);
    EXPECT_TRUE(builder.notes("f").empty());
}

TEST(MeshFaces, FacesWithoutAreaAreLeftOutWithANote) {
    MeshBuilder builder;
    EXPECT_TRUE(split(builder, {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}).empty());
    EXPECT_EQ(builder.notes("f"), Strings{"f: 1 polygon without area left out"});
    EXPECT_TRUE(split(builder, Positions(5, glm::dvec3(7, 8, 9))).empty());
    EXPECT_EQ(builder.notes("f"), Strings{"f: 2 polygons without area left out"});
}

TEST(MeshFaces, FacesThatCrossThemselvesAreFansWithANote) {
    MeshBuilder builder;
    const Positions bow = {{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 1, 0}};
    EXPECT_EQ(split(builder, bow), (Faces{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(builder.notes("f"),
              Strings{"f: 1 polygon crosses itself or is too intricate: it may look wrong"});
    Positions pentagram;
    for (int i = 0; i < 5; ++i) {
        pentagram.emplace_back(std::cos(i * 2.513274), std::sin(i * 2.513274), 0);
    }
    EXPECT_EQ(split(builder, pentagram), (Faces{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
    EXPECT_EQ(builder.notes("f"),
              Strings{"f: 2 polygons cross themselves or are too intricate: they may look wrong"});
}

TEST(MeshFaces, IntricateFacesAreFansOnceTheBudgetIsSpent) {
    Positions comb = {{-1, 0, 0}};
    for (int tooth = 0; tooth < 3300; ++tooth) {
        comb.emplace_back(0, 2 * tooth, 0);
        comb.emplace_back(1e6, 2 * tooth + 0.5, 0);
        comb.emplace_back(0, 2 * tooth + 1, 0);
    }
    comb.emplace_back(-1, 2 * 3300, 0);
    MeshBuilder builder;
    EXPECT_NEAR(total_area(comb, split(builder, comb)), shoelace(comb), 1);
    for (int i = 0; i < 20; ++i) EXPECT_EQ(split(builder, comb).size(), comb.size() - 2);
    ASSERT_EQ(builder.notes("f").size(), 1u);
    EXPECT_NE(builder.notes("f")[0].find("are too intricate"), std::string::npos);
    const Positions dart = {{2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}, {0, 0, 0}};
    EXPECT_DOUBLE_EQ(total_area(dart, split(builder, dart)), 1.0);
}

TEST(MeshFaces, ScaleDoesNotMatter) {
    for (const double s : {1e-200, 1e-30, 1e30}) {
        Positions dart = {{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}};
        for (glm::dvec3& corner : dart) corner *= s;
        EXPECT_EQ(triangulate(dart).size(), 2u) << s;
    }
}

// --- OBJ -----------------------------------------------------------------------------------------

TEST(ParseObj, EveryFormOfIndicesMeansTheSameFace) {
    const std::string head = square + "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nvn 0 0 2\nvn 0 0 3\n";
    const Faces expected = {{0, 1, 2}};
    for (const std::string face : {"1 2 3", "1/1 2/2 3/3", "-4 -3 -2", "-4/-3 -3/-2 -2/-1"}) {
        const Scene::Mesh mesh = obj(head + "f " + face + "\n").mesh;
        EXPECT_EQ(mesh.faces, expected) << face;
        EXPECT_TRUE(mesh.face_normals.empty()) << face;
    }
    for (const std::string face :
         {"1//1 2//2 3//3", "1/1/1 2/2/2 3/3/3", "-4//-3 -3//-2 -2//-1", "-4/1/-3 2/-2/2 3//3"}) {
        const Scene::Mesh mesh = obj(head + "f " + face + "\n").mesh;
        EXPECT_EQ(mesh.faces, expected) << face;
        EXPECT_EQ(mesh.face_normals, expected) << face;
    }
}

TEST(ParseObj, NegativeIndicesCountFromWhereTheyStand) {
    const Scene::Mesh mesh =
        obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -4 -3 -1\n").mesh;
    EXPECT_EQ(mesh.faces, (Faces{{0, 1, 2}, {0, 1, 3}}));
}

TEST(ParseObj, PolygonsAreCutWithTheirNormals) {
    const Scene::Mesh mesh =
        obj(square + "vn 1 0 0\nvn 0 1 0\nvn 0 0 1\nvn 1 1 1\nf 1//4 2//3 3//2 4//1\n").mesh;
    EXPECT_EQ(mesh.faces, (Faces{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(mesh.face_normals, (Faces{{3, 2, 1}, {3, 1, 0}}));
}

TEST(ParseObj, FlatFacesAmongSmoothOnesHaveNoNormals) {
    const Scene::Mesh mesh = obj(square + "vn 0 0 1\nf 1 2 3\nf 1//1 2//1 3//1\nf 1 3 4\n").mesh;
    EXPECT_EQ(mesh.face_normals, (Faces{{none, none, none}, {0, 0, 0}, {none, none, none}}));
}

TEST(ParseObj, LinesAreTakenAsTheyCome) {
    const Scene::Mesh mesh = obj("\xEF\xBB\xBF# comment \\\n\n  v 0 0 0 # no w\r\nv\t1 0 \\\n 0\r"
                                 "v +1 1e0 -0 1.0\nv 0 1 1e-999 0.5 0.5 0.5\ng a b\no name\n"
                                 "s off\nusemtl x\nf 1 2 \\\r\n3\nf 1 3 4")
                                 .mesh;
    EXPECT_EQ(mesh.positions, (Positions{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.faces, (Faces{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(mesh.face_materials, std::vector<int>{-1});
}

TEST(ParseObj, PointsAndLinesAreCounted) {
    const Model model = obj(square + "p 1\nl 1 2\nf 1 2 3\n");
    ASSERT_EQ(model.notes.size(), 1u);
    EXPECT_EQ(model.notes[0], "t.obj: 2 lines of points or lines (p, l) left out");
}

TEST(ParseObj, FacesWearTheMaterialsTheyName) {
    const Model model = obj_with(
        "mtllib lib\n" + square + "f 1 2 3\nusemtl b\nf 1 2 3\nf 1 2 4\nusemtl a b\nf 1 3 4\n",
        "newmtl a b\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n");
    ASSERT_EQ(model.materials.size(), 3u);
    EXPECT_EQ(model.materials[2].name, "default");
    EXPECT_EQ(model.mesh.face_materials, (std::vector<int>{2, 1, 1, 0}));
}

TEST(ParseObj, OneMaterialForAllIsOneIndex) {
    const Model model =
        obj_with("usemtl b\n" + square + "f 1 2 3 4\nmtllib lib\n", "newmtl a\nnewmtl b\n");
    EXPECT_EQ(model.mesh.face_materials, std::vector<int>{1});
    EXPECT_EQ(model.materials.size(), 2u);
}

TEST(ParseObj, LibrariesAreOneNameOrSeveralAndTheFirstDefinitionCounts) {
    std::vector<std::string> asked;
    const auto open = [&](const std::string& name) {
        asked.push_back(name);
        if (name.find(' ') != name.npos) return LibraryFile{{}, {}, "no such file"};
        return LibraryFile{name, "newmtl m\nKd " + std::string(name == "a" ? "1" : "0.5"), {}};
    };
    const Model model =
        parse_obj("mtllib a b\nmtllib a\nusemtl m\n" + square + "f 1 2 3\n", "t.obj", open);
    EXPECT_EQ(asked, (std::vector<std::string>{"a b", "a", "b"}));
    ASSERT_EQ(model.materials.size(), 1u);
    EXPECT_EQ(model.materials[0].diffuse, glm::dvec3(1));
}

// --- MTL -----------------------------------------------------------------------------------------

Scene::Material mtl(const std::string& lines) {
    return parse_mtl("newmtl m\n" + lines, "t.mtl").materials.at(0);
}

TEST(ParseMtl, ColoursAndHighlights) {
    const auto material = mtl("Ka 0.1 0.2 0.3\nKd .4 .5 .6\nKs 0.7\nNs 96.5\nillum 2\n");
    EXPECT_EQ(material.name, "m");
    EXPECT_EQ(material.ambient, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(material.diffuse, glm::dvec3(0.4, 0.5, 0.6));
    EXPECT_EQ(material.specular, glm::dvec3(0.7));
    EXPECT_EQ(material.shininess, 96.5);
    EXPECT_EQ(material.mirror, glm::dvec3(0));
    EXPECT_EQ(material.transmission, glm::dvec3(0));
    EXPECT_TRUE(material.two_sided);
}

TEST(ParseMtl, IlluminationModelsChooseWhatIsTraced) {
    const std::string words = "Kd 0.8\nKs 0.5\nNi 1.5\nd 0.25\nillum ";
    for (int illum = 0; illum <= 10; ++illum) {
        SCOPED_TRACE(illum);
        const auto material = mtl(words + std::to_string(illum) + "\n");
        const bool glass = illum == 4 || illum == 6 || illum == 7 || illum == 9;
        EXPECT_EQ(material.specular, glm::dvec3(illum >= 2 ? 0.5 : 0));
        EXPECT_EQ(material.mirror, glm::dvec3(illum >= 3 && illum <= 8 ? 0.5 : 0));
        EXPECT_EQ(material.transmission, glm::dvec3(glass ? 0.75 : 0));
        EXPECT_EQ(material.diffuse, glm::dvec3(glass ? 0.2 : 0.8));
        EXPECT_EQ(material.ior, glass ? 1.5 : 1.0);
        EXPECT_EQ(material.two_sided, !glass);
    }
}

TEST(ParseMtl, TransparencyIsTheRestOfDissolveWhichWins) {
    EXPECT_EQ(mtl("illum 6\nTr 0.75\n").transmission, glm::dvec3(0.75));
    EXPECT_EQ(mtl("illum 6\nd 1\nTr 1\n").transmission, glm::dvec3(0));
    EXPECT_EQ(mtl("illum 6\nTr 1\nd -halo 0.5\nTf 1 0.5 0\n").transmission,
              glm::dvec3(0.5, 0.25, 0));
}

TEST(ParseMtl, WhatIsNotDrawnIsCounted) {
    const auto library = parse_mtl("newmtl m\nmap_Kd a b.png\nKe 0 0 0\nKd 1\n", "t.mtl");
    ASSERT_EQ(library.notes.size(), 1u);
    EXPECT_TRUE(library.notes[0].starts_with("t.mtl: 2 statements left out, the first 'map_Kd'"));
}

// --- PLY -----------------------------------------------------------------------------------------

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

/// Every scalar type, in vertices, lists and their lengths, with elements and properties between
/// that nobody asked for.
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

TEST(ParsePly, BytesAfterTheEndAreNoted) {
    const std::string whole = ply_of_all_types("binary_little_endian", "\n");
    EXPECT_TRUE(parse_ply(whole + "\n", "t.ply").notes.empty());
    const Model model = parse_ply(whole + "more of it", "t.ply");
    ASSERT_EQ(model.notes.size(), 1u);
    EXPECT_EQ(model.notes[0], "t.ply: 10 bytes after the last element left out");
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

// --- transforms ----------------------------------------------------------------------------------

void expect_near(glm::dvec3 a, glm::dvec3 b) {
    EXPECT_LT(glm::length(a - b), 1e-14) << a.x << " " << a.y << " " << a.z;
}

glm::dvec3 apply(const Affine& affine, glm::dvec3 p) {
    return affine.linear * p + affine.translation;
}

TEST(MakeAffine, StepsComeInTheDocumentedOrder) {
    // (1, 2, 3) scaled is (2, 6, 12); about x by 90 it is (2, -12, 6); about y by 90, (6, -12, -2);
    // about z by 90, (12, 6, -2).
    const Affine affine = make_affine({2, 3, 4}, {90, 90, 90}, {100, 200, 300});
    EXPECT_EQ(apply(affine, {1, 2, 3}), glm::dvec3(112, 206, 298));
    const double s = std::sqrt(0.5);
    expect_near(apply(make_affine({1, 1, 1}, {0, 0, 45}, {0, 0, 0}), {1, 0, 0}), {s, s, 0});
    expect_near(apply(make_affine({1, 1, 1}, {0, 45, 0}, {0, 0, 0}), {1, 0, 0}), {s, 0, -s});
    expect_near(apply(make_affine({1, 1, 1}, {45, 0, 0}, {0, 0, 0}), {0, 1, 0}), {0, s, s});
    EXPECT_EQ(apply(make_affine({1, 1, 1}, {0, 0, -450}, {0, 0, 0}), {1, 0, 0}),
              glm::dvec3(0, -1, 0));
}

TEST(NormalMatrix, SingularOnesHaveNone) {
    EXPECT_FALSE(normal_matrix(glm::dmat3(0)));
    EXPECT_FALSE(normal_matrix(glm::dmat3(1, 2, 3, 4, 5, 6, 7, 8, 9)));
    EXPECT_FALSE(normal_matrix(glm::dmat3(1, 0, 0, 0, 1, 0, 1, 1, 0)));
    EXPECT_TRUE(normal_matrix(glm::dmat3(1e-9, 0, 0, 0, 1e20, 0, 0, 0, -1)));
}

/// A triangle in the plane x + y = 1, with its normal.
Scene::Mesh slanted() {
    Scene::Mesh mesh;
    mesh.positions = {{1, 0, 0}, {0, 1, 0}, {1, 0, 1}};
    mesh.normals = {{5, 5, 0}};
    mesh.faces = {{0, 1, 2}};
    mesh.face_normals = {{0, 0, 0}};
    mesh.face_materials = {0};
    return mesh;
}

glm::dvec3 normal_of(const Scene::Mesh& mesh, std::size_t face) {
    const auto [a, b, c] = mesh.faces[face];
    return glm::normalize(
        glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]));
}

TEST(FinishMesh, NormalsStayAtRightAnglesToTheirFaces) {
    for (const glm::dvec3 scale : {glm::dvec3(1, 1, 1), glm::dvec3(2, 1, 1), glm::dvec3(3, 5, 7),
                                   glm::dvec3(1e-20, 1e-20, 1e-20), glm::dvec3(-1, 1, 1),
                                   glm::dvec3(-2, -3, -4), glm::dvec3(-1, -1, 5)}) {
        Scene::Mesh mesh = slanted();
        finish_mesh(mesh, make_affine(scale, {10, 20, 30}, {0, 0, 0}));
        expect_near(mesh.normals[0], normal_of(mesh, 0));
        EXPECT_NEAR(glm::length(mesh.normals[0]), 1, 1e-15);
    }
    Scene::Mesh mesh = slanted();
    finish_mesh(mesh, make_affine({2, 1, 1}, {0, 0, 0}, {0, 0, 0}));
    expect_near(mesh.normals[0], glm::dvec3(1, 2, 0) / std::sqrt(5.0));
}

TEST(FinishMesh, MirroringTurnsFacesRound) {
    Scene::Mesh mesh = slanted();
    mesh.normals = {{1, 1, 0}, {1, 1, 0}, {1, 1, 0}};
    mesh.face_normals = {{0, 1, 2}};
    finish_mesh(mesh, make_affine({1, 1, -1}, {0, 0, 0}, {0, 0, 0}));
    EXPECT_EQ(mesh.faces, (Faces{{0, 2, 1}}));
    EXPECT_EQ(mesh.face_normals, (Faces{{0, 2, 1}}));
}

TEST(FinishMesh, TrianglesWithoutAreaGo) {
    Scene::Mesh mesh = slanted();
    mesh.faces = {{0, 0, 1}, {0, 1, 2}, {2, 2, 2}};
    mesh.face_normals = mesh.faces;
    mesh.normals = {{1, 1, 0}, {0, 0, 0}, {0, 0, 1}};
    mesh.face_materials = {4, 5, 6};
    const MeshLosses losses = finish_mesh(mesh, {});
    EXPECT_EQ(losses.zero_areas, 2u);
    EXPECT_EQ(losses.zero_normals, 1u);
    EXPECT_EQ(mesh.faces, (Faces{{0, 1, 2}}));
    EXPECT_EQ(mesh.face_normals, (Faces{{none, none, none}}));
    EXPECT_EQ(mesh.face_materials, std::vector<int>{5});
}

// --- in scenes -----------------------------------------------------------------------------------

const std::string ply_triangle =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

std::string scene_with(const std::string& meshes) {
    return R"({"camera": {"from": [0, 0, 5], "at": [0, 0, 0], "fov_degrees": 40},
               "materials": {"grey": {"diffuse": 0.5}, "red": {"diffuse": [1, 0, 0]}},
               "meshes": [)" +
           meshes + "]}";
}

TEST_F(ModelFiles, MeshesStandInAJsonScene) {
    write("models/a.obj", "mtllib a.mtl\nusemtl blue\n" + square + "f 1 2 3 4\n");
    write("models/a.mtl", "newmtl blue\nKd 0 0 1\n");
    write("b.PLY", ply_triangle);
    const std::string path = write("scene.json", scene_with(R"(
        {"file": "models/a.obj", "transform": {"scale": 2, "translate": [1, 2, 3]}},
        {"file": "b.PLY", "material": "red",
         "transform": [0, -1, 0, 5,  1, 0, 0, 6,  0, 0, 1, 7,  0, 0, 0, 1]},
        {"file": "models/a.obj", "material": "grey"})"));
    const Scene scene = load_scene(path);
    ASSERT_EQ(scene.meshes.size(), 3u);
    EXPECT_EQ(scene.meshes[0].positions[2], glm::dvec3(3, 4, 3));
    EXPECT_EQ(scene.meshes[1].positions, (Positions{{5, 6, 7}, {5, 7, 7}, {4, 6, 7}}));
    ASSERT_EQ(scene.materials.size(), 3u);
    EXPECT_EQ(scene.materials[2].name, "blue");
    EXPECT_EQ(scene.meshes[0].face_materials, std::vector<int>{2});
    EXPECT_EQ(scene.meshes[1].face_materials, std::vector<int>{1});
    EXPECT_EQ(scene.meshes[2].face_materials, std::vector<int>{0});
    EXPECT_EQ(triangle_count(scene), 5u);
}

TEST_F(ModelFiles, ObjWithoutMaterialsNeedsOneFromTheScene) {
    write("a.obj", square + "f 1 2 3\n");
    const std::string path = write("scene.json", scene_with(R"({"file": "a.obj"})"));
    const Refusal refusal = refusal_of([&] { load_scene(path); });
    EXPECT_EQ(refusal.exit_code, ExitCode::input);
    EXPECT_TRUE(refusal.message.starts_with(path + ":3:"));
    EXPECT_NE(refusal.message.find("a mesh has no \"material\""), std::string::npos);
}

TEST_F(ModelFiles, AMaterialOfTheSceneMakesLibrariesNeedless) {
    write("a.obj", "mtllib nowhere.mtl\nusemtl x\n" + square + "f 1 2 3\n");
    const std::string path =
        write("scene.json", scene_with(R"({"file": "a.obj", "material": "red"})"));
    EXPECT_EQ(load_scene(path).meshes[0].face_materials, std::vector<int>{1});
}

TEST_F(ModelFiles, LinksOutOfTheFolderAreRefused) {
    write("secret.ply", ply_triangle);
    fs::create_directories(folder_ / "scene");
    fs::create_symlink(folder_ / "secret.ply", folder_ / "scene/link.ply");
    fs::create_symlink(folder_, folder_ / "scene/up");
    for (const std::string name : {"link.ply", "up/secret.ply"}) {
        const std::string path = write(
            "scene/scene.json", scene_with(R"({"material": "red", "file": ")" + name + "\"}"));
        const Refusal refusal = refusal_of([&] { load_scene(path); });
        EXPECT_EQ(refusal.exit_code, ExitCode::input);
        EXPECT_NE(refusal.message.find("lies outside of the scene's folder"), std::string::npos);
    }
    fs::create_symlink("../scene/inside.ply", folder_ / "scene/alias.ply");
    write("scene/inside.ply", ply_triangle);
    const std::string path =
        write("scene/scene.json", scene_with(R"({"material": "red", "file": "alias.ply"})"));
    EXPECT_EQ(triangle_count(load_scene(path)), 1u);
}

TEST_F(ModelFiles, PipesAndFoldersDoNotHang) {
    ASSERT_EQ(mkfifo((folder_ / "pipe.ply").c_str(), 0600), 0);
    fs::create_directories(folder_ / "folder.ply");
    for (const std::string name : {"pipe.ply", "folder.ply"}) {
        const std::string path =
            write("scene.json", scene_with(R"({"material": "red", "file": ")" + name + "\"}"));
        const Refusal refusal = refusal_of([&] { load_scene(path); });
        EXPECT_NE(refusal.message.find("is not a regular file"), std::string::npos);
        const Refusal alone = refusal_of([&] { load_scene((folder_ / name).string()); });
        EXPECT_EQ(alone.exit_code, ExitCode::input);
    }
}

TEST_F(ModelFiles, FileAboveTheSizeCapIsOverTheLimit) {
    const std::string path = write("large.ply", ply_triangle);
    fs::resize_file(path, max_model_bytes + 1);  // sparse: takes no room
    const Refusal refusal = refusal_of([&] { load_scene(path); });
    EXPECT_EQ(refusal.exit_code, ExitCode::limit);
}

TEST_F(ModelFiles, DegenerateTrianglesAreANoteNotAMistake) {
    const std::string path = write("a.obj", square + "f 1 2 3\nf 1 1 2\nf 2 2 2\n");
    const Scene scene = load_scene(path);
    EXPECT_EQ(triangle_count(scene), 1u);
    ASSERT_EQ(scene.notes.size(), 1u);
    EXPECT_EQ(scene.notes[0], path + ": 2 triangles without area left out");
}

TEST_F(ModelFiles, AModelAloneFillsThePicture) {
    const std::string path = write("shape.ply", ply_triangle);
    const Scene scene = load_scene(path);
    EXPECT_EQ(scene.name, "shape");
    EXPECT_EQ(scene.lights.size(), 2u);
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_TRUE(scene.materials[0].two_sided);
    EXPECT_EQ(scene.meshes[0].face_materials, std::vector<int>{0});
    EXPECT_EQ(scene.camera.at, glm::dvec3(0.5, 0.5, 0));
    const glm::dvec3 view = scene.camera.from - scene.camera.at;
    EXPECT_NEAR(std::asin(std::sqrt(0.5) / glm::length(view)), 20 * 3.14159265358979 / 180, 1e-12);
    EXPECT_GT(view.y, 0);
    EXPECT_GT(view.x, 0);
    EXPECT_GT(view.z, view.x);
}

TEST_F(ModelFiles, AnObjAloneFindsItsLibraryBesideIt) {
    write("sub/a.mtl", "newmtl blue\nKd 0 0 1\nKs 0.5\nillum 3\n");
    const Scene scene =
        load_scene(write("sub/a.obj", "mtllib a.mtl\nusemtl blue\n" + square + "f 1 2 3\n"));
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.materials[0].mirror, glm::dvec3(0.5));
}

}  // namespace
}  // namespace rt
