// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "host/scene/model.h"
#include "host/scene/scene_file.h"
#include "tests/refusals.h"

namespace rt::this_file {
namespace {

using Positions = std::vector<glm::dvec3>;
using Faces = std::vector<Scene::Mesh::Face>;

constexpr std::uint32_t none = Scene::Mesh::no_normal;

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Model obj(const std::string& text) { return parse_obj(text, "t.obj", {}); }

/// Parses an OBJ; every library it names contains `library`.
Model obj_with(const std::string& text, const std::string& library) {
    return parse_obj(text, "t.obj", [&](const std::string& name) {
        return LibraryFile{name, library, {}};
    });
}

TEST(ParseObj, BadFilesAreRefusedAsExpected) {
    for (const auto& path : malformed_files(".obj")) {
        expect_announced(path, refusal_of([&] { load_scene(path.string()); }));
    }
}

TEST(ParseObj, BlemishesAreNoted) {
    for (const auto& path : blemished_files(".obj")) {
        expect_announced(path, load_scene(path.string()).notes);
    }
}

TEST(ParseObj, ManyBlemishesOfAKindAreOneNote) {
    std::string text = square + "f 1 2 3\n";
    for (int i = 0; i < 100; ++i) text += "f 1 2 9\nvw 1\n";
    const Model model = obj(text);
    EXPECT_EQ(model.mesh.faces, (Faces{{0, 1, 2}}));
    EXPECT_EQ(model.notes,
              (std::vector<std::string>{
                  "t.obj:6:7: vertex 9 does not exist, only 4 defined above; correct the number "
                  "(100 faces left out)",
                  "t.obj:7:1: unknown statement 'vw'; did you mean 'vn'? (100 statements "
                  "ignored)"}));
}

TEST(ParseObj, FacesThatCannotBeBuiltAreLeftOut) {
    for (const std::string face : {"1 2 5", "0 1 2", "1 2", "", "1 2 x", "1 2 1.5", "-5 1 2",
                                   "1 2 99999999999999999999", "1/1 /2 3", "1,2,3"}) {
        const Model model = obj(square + "f 1 2 3\nf " + face + "\nf 1 3 4");
        EXPECT_EQ(model.mesh.faces, (Faces{{0, 1, 2}, {0, 2, 3}})) << face;
        ASSERT_EQ(model.notes.size(), 1u) << face;
        EXPECT_TRUE(model.notes[0].starts_with("t.obj:6:") &&
                    model.notes[0].ends_with("(1 face left out)"))
            << model.notes[0];
        EXPECT_EQ(refusal_of([&] { obj(square + "f " + face + "\n"); }).exit_code, ExitCode::input);
    }
}

TEST(ParseObj, VerticesThatAreNoNumbersOnlyMatterToTheirFaces) {
    for (const std::string vertex :
         {"nan 0 0", "0 inf 0", "1e31 0 0", "0 0", "", "a b c", "0 0 -1.#IND00"}) {
        const std::string text =
            square + "v " + vertex + "\nvn " + vertex + "\nvn 0 0 1\nf 1 2 3\n";
        const Model unused = obj(text);
        EXPECT_TRUE(unused.notes.empty()) << vertex;
        const Model used = obj(text + "f 1 2 5\nf 5 3 1\nf 1//1 2//1 3//1\nf 1//2 2//2 3//2\n");
        EXPECT_EQ(used.mesh.faces, (Faces{{0, 1, 2}, {0, 1, 2}, {0, 1, 2}})) << vertex;
        EXPECT_EQ(used.mesh.face_normals,
                  (Faces{{none, none, none}, {none, none, none}, {1, 1, 1}}));
        ASSERT_EQ(used.notes.size(), 2u) << vertex;
        EXPECT_TRUE(used.notes[0].starts_with("t.obj:5:") &&
                    used.notes[0].ends_with("(2 faces left out)"))
            << used.notes[0];
        EXPECT_TRUE(used.notes[1].starts_with("t.obj:6:") &&
                    used.notes[1].ends_with("(1 face made flat)"))
            << used.notes[1];
    }
}

TEST(ParseObj, UnknownMaterialsAreGrayWithOneNote) {
    const std::string text = "mtllib lib\n" + square + "usemtl b\nf 1 2 3\nusemtl c\nf 1 3 4\n";
    for (const auto& [library, advice] : {std::pair{"newmtl a\n", "the libraries contain 'a'"},
                                          {"", "the libraries contain none"}}) {
        const Model model = obj_with(text, library);
        EXPECT_EQ(model.materials.back().name, "default");
        EXPECT_EQ(model.notes,
                  std::vector<std::string>{"t.obj:6:8: unknown material 'b'; " +
                                           std::string(advice) + " (2 materials are gray)"});
    }
    EXPECT_EQ(obj_with(square + "usemtl b\nf 1 2 3\n", "").notes,
              std::vector<std::string>{"t.obj:5:8: unknown material 'b'; the file has no mtllib (1 "
                                       "material is gray)"});
}

TEST(ParseObj, LibrariesAreFoundUnderOtherSystemsNames) {
    for (const std::string name : {"models\\lib.mtl", "C:\\x\\bare.mtl", "/home/a b/bare.mtl"}) {
        const Model model =
            parse_obj("mtllib " + name + "\n" + square + "usemtl m\nf 1 2 3\n", "dir/t.obj",
                      [](const std::string& asked) {
                          const bool good = asked == "models/lib.mtl" || asked == "bare.mtl";
                          return LibraryFile{asked, "newmtl m\n", good ? "" : "is not there"};
                      });
        EXPECT_TRUE(model.notes.empty()) << name;
        EXPECT_EQ(model.materials.size(), 1u) << name;
    }
    const Model model = parse_obj(
        "mtllib else.mtl\n" + square + "usemtl m\nf 1 2 3\n", "dir/t.obj",
        [](const std::string& asked) {
            return LibraryFile{asked, "newmtl m\n", asked == "t.mtl" ? "" : "is not there"};
        });
    EXPECT_TRUE(model.notes.empty());
}

TEST(ParseObj, LibrariesOfOneLineAreFoundEachByItself) {
    const auto open = [](const std::string& name) {
        if (name == "a.mtl") return LibraryFile{name, "newmtl a\n", {}};
        if (name == "b.mtl") return LibraryFile{name, "newmtl b\n", {}};
        return LibraryFile{{}, {}, "'" + name + "' is not there"};
    };
    for (const auto& [names, missing] : {std::pair{"a.mtl b.mtl", ""},
                                         {"C:\\x\\a.mtl C:\\x\\b.mtl", ""},
                                         {"a.mtl missing.mtl b.mtl", "'missing.mtl'"},
                                         {"X:\\c.MTL C:\\a.mtl b.mtl no.mtl", "'X:\\c.MTL'"}}) {
        const Model model = parse_obj(
            "mtllib " + std::string(names) + "\n" + square + "usemtl b\nf 1 2 3\n", "t.obj", open);
        ASSERT_EQ(model.materials.size(), 2u) << names;
        EXPECT_EQ(model.mesh.face_materials, std::vector<int>{1}) << names;
        std::vector<std::string> notes;
        if (*missing != 0) {
            notes.push_back(std::string("t.obj:1:8: ") + missing +
                            " is not there; until then its materials are gray (1 library missing)");
        }
        EXPECT_EQ(model.notes, notes);
    }
}

/// This took the square of the number of lines.
TEST(ParseObj, ManyMissingLibrariesAreOneNote) {
    std::string text;
    for (int i = 0; i < 50000; ++i) text += "mtllib x" + std::to_string(i % 5000) + "\n";
    int asked = 0;
    const Model model = parse_obj(text + square + "f 1 2 3\n", "t.obj", [&](const std::string&) {
        ++asked;
        return LibraryFile{{}, {}, "is not there"};
    });
    EXPECT_LT(asked, 1000);
    ASSERT_EQ(model.notes.size(), 1u);
    EXPECT_TRUE(model.notes[0].ends_with("(50000 libraries missing)")) << model.notes[0];
}

TEST(ParseObj, PolygonsThatAreNotFlatLoseNothing) {
    EXPECT_EQ(obj("v 0 0 0\nv 2 0 0\nv 2 2 0\nv 2 2 1\nf 1 2 3 4\n").mesh.faces.size(), 2u);
}

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

TEST(ParseObj, NothingAfterASlashIsNothing) {
    const std::string head = square + "vt 0 0\nvn 0 0 1\n";
    for (const std::string face : {"1// 2// 3//", "1/ 2/ 3/", "1/1/ 2// 3/", "1 2// 3"}) {
        const Scene::Mesh mesh = obj(head + "f " + face + "\n").mesh;
        EXPECT_EQ(mesh.faces, (Faces{{0, 1, 2}})) << face;
        EXPECT_TRUE(mesh.face_normals.empty()) << face;
    }
}

TEST(ParseObj, ColorsOfVerticesMayBeAnything) {
    const Scene::Mesh mesh =
        obj("v 0 0 0 nan nan nan\nv 1 0 0 -1.#IND 0 0\nv 0 1 0 1 inf 0 0 1\nf 1 2 3\n").mesh;
    EXPECT_EQ(mesh.positions, (Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
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

/// The passes over a file disagreed about its vertices here, and faces had indices beyond them.
TEST(ParseObj, ABackslashAtTheEndOfANameBelongsToIt) {
    for (const std::string word : {"usemtl", "mtllib"}) {
        for (const std::string name : {"a\\", " C:\\x\\", "\\\na\\", "a # b\\", "#\\", "\\\n"}) {
            const std::string text =
                "v 0 0 0\nv 1 0 0\n" + word + " " + name + "\nv 0 1 0\nf 1 2 3\nf 1 2 -1\n";
            for (const std::size_t chunk : {1, 100}) {
                const Scene::Mesh mesh = parse_obj(text, "t.obj", {}, {1, chunk}).mesh;
                EXPECT_EQ(mesh.positions, (Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << text;
                EXPECT_EQ(mesh.faces, (Faces{{0, 1, 2}, {0, 1, 2}})) << text;
            }
        }
    }
}

TEST(ParseObj, PointsAndLinesAreCounted) {
    const Model model = obj(square + "p 1\nl 1 2\nf 1 2 3\n");
    EXPECT_EQ(model.notes,
              std::vector<std::string>{
                  "t.obj:5:1: points and lines (p, l) are not drawn (2 statements ignored)"});
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

TEST(ParseObj, WithoutItsLibraryAModelIsGrayWithANote) {
    const std::string text = "mtllib a.mtl\nmtllib b.mtl\n" + square +
                             "usemtl in a\nf 1 2 3\nusemtl in b\nf 1 2 4\nusemtl\nf 1 3 4\n";
    const Model model = parse_obj(text, "t.obj", [](const std::string& name) {
        if (name == "a.mtl") return LibraryFile{name, "newmtl in a\nKd 1 0 0\n", {}};
        return LibraryFile{{}, {}, "'b.mtl' is not there; look"};
    });
    ASSERT_EQ(model.materials.size(), 2u);
    EXPECT_EQ(model.materials[1].name, "default");
    EXPECT_EQ(model.mesh.face_materials, (std::vector<int>{0, 1, 1}));
    EXPECT_EQ(model.notes,
              std::vector<std::string>{"t.obj:2:8: 'b.mtl' is not there; look; until then its "
                                       "materials are gray (1 library missing)"});
}

TEST(ParseObj, MaterialsWithoutANameAreTheDefault) {
    const Model model =
        obj_with("mtllib lib\n" + square + "usemtl a\nf 1 2 3\nusemtl  \nf 1 3 4\n", "newmtl a\n");
    EXPECT_EQ(model.mesh.face_materials, (std::vector<int>{0, 1}));
    EXPECT_TRUE(model.notes.empty());
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

/// Everything that depends on earlier lines: indices, materials, joined lines, polygons.
std::string long_obj(int times) {
    std::string text = "\xEF\xBB\xBFmtllib lib\n";
    for (int i = 0; i < times; ++i) {
        const std::string x = std::to_string(10 * i);
        text += "v " + x + " 0 0\nv " + x + " 1 \\\n0 # joined\\\nvn 0 0 1\r\nv 1" + x +
                " 1 0\rv 1" + x + " 0 0\n# v 1 2\nv 1" + x + " 0.5 0\nvt 0 \\\r\n 0\n";
        text += "f -5 -4 -3\nusemtl " + std::string(i % 3 == 0 ? "b" : "a") +
                "\nf -5//-1 -2//1 -3//-1 -4//1\n";
        text += i % 2 == 0 ? "f 1 2 -1 4\n" : "usemtl\nl 1 2\nf -5 -4 -1 -3 -2\nf 5 4 3 2 1\n";
    }
    return text;
}

TEST(ParseObj, ChunksAndThreadsChangeNothing) {
    const auto open = [](const std::string& name) {
        return LibraryFile{name, "newmtl a\nnewmtl b\n", {}};
    };
    const std::string text = long_obj(40);
    const Model whole = parse_obj(text, "t.obj", open, {1, text.size()});
    EXPECT_GT(whole.mesh.faces.size(), 200u);
    for (const std::size_t chunk : {1, 7, 100, 1000}) {
        for (const int threads : {1, 3}) {
            const Model cut = parse_obj(text, "t.obj", open, {threads, chunk});
            EXPECT_EQ(cut.mesh.positions, whole.mesh.positions);
            EXPECT_EQ(cut.mesh.normals, whole.mesh.normals);
            EXPECT_EQ(cut.mesh.faces, whole.mesh.faces);
            EXPECT_EQ(cut.mesh.face_normals, whole.mesh.face_normals);
            EXPECT_EQ(cut.mesh.face_materials, whole.mesh.face_materials);
            EXPECT_EQ(cut.notes, whole.notes);
        }
    }
}

TEST(ParseObj, ChunksAndThreadsFindTheSameBlemishes) {
    std::string text = long_obj(5) + "f 1 2 26\nv 1 2\nf 1 2 26\nf 1 2 27\nfoo\nv nan 0 0\n" +
                       long_obj(5) + "f 1//1 2//1 3//99\np 1\n";
    for (int i = 0; i < 12; ++i) text += "f 1 2 999\nvn 1\n";
    const Model whole = parse_obj(text, "t.obj", {}, {1, text.size()});
    EXPECT_EQ(whole.notes.size(), 5u);
    for (const std::size_t chunk : {1, 50, 1000}) {
        for (const int threads : {1, 3}) {
            const Model cut = parse_obj(text, "t.obj", {}, {threads, chunk});
            EXPECT_EQ(cut.notes, whole.notes);
            EXPECT_EQ(cut.mesh.faces, whole.mesh.faces);
            EXPECT_EQ(cut.mesh.face_normals, whole.mesh.face_normals);
        }
    }
}

}  // namespace
}  // namespace rt::this_file
