// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "host/scene/mtl_file.h"
#include "host/scene/text_file.h"
#include "tests/refusals.h"

namespace rt::this_file {
namespace {

Scene::Material mtl(const std::string& lines) {
    return parse_mtl("newmtl m\n" + lines, "t.mtl").materials.at(0);
}

TEST(ParseMtl, BlemishesAreNoted) {
    for (const auto& path : blemished_files(".mtl", "mtl-")) {
        const FileText text = read_text_file(path.string(), 1000);
        expect_announced(path, parse_mtl(text.view(), path.string()).notes);
    }
}

TEST(ParseMtl, ExponentsNearZeroMeanNoHighlight) {
    for (const std::string exponent : {"0", "0.1", "-1.960784"}) {
        const auto material = mtl("Kd 0.8\nKs 0.8\nillum 3\nNs " + exponent + "\n");
        EXPECT_EQ(material.specular, glm::dvec3(0)) << exponent;
        EXPECT_EQ(material.mirror, glm::dvec3(0.8)) << exponent;
    }
    EXPECT_EQ(mtl("Ks 0.8\nNs 1\n").specular, glm::dvec3(0.8));
    EXPECT_TRUE(parse_mtl("newmtl m\nNs 0\nKs .8 .8 .8\n", "t.mtl").notes.empty());
}

TEST(ParseMtl, AnAmbientOfOneIsAnExportersDefaultUnlessTheColorIsWhite) {
    EXPECT_EQ(mtl("Ka 1 1 1\nKd 0.8 0.1 0.1\n").ambient, glm::dvec3(0.8, 0.1, 0.1));
    EXPECT_EQ(mtl("Ka 1 1 1\nKd 1 1 1\n").ambient, glm::dvec3(1));
    EXPECT_EQ(mtl("Ka 1 1 1\n").ambient, glm::dvec3(1));
    EXPECT_EQ(mtl("Ka 0.9 1 1\nKd 0.5\n").ambient, glm::dvec3(0.9, 1, 1));
}

TEST(ParseMtl, WhatCannotBeReadLeavesTheDefault) {
    const auto material = mtl("Kd nan 0 0\nKs -1 2e6 .5\nNi -1\nd x\nTr 7\nillum 6\nTf 1 1\n");
    EXPECT_EQ(material.diffuse, glm::dvec3(0));
    EXPECT_EQ(material.mirror, glm::dvec3(0, 1e6, 0.5));
    EXPECT_EQ(material.transmission, glm::dvec3(1));
    EXPECT_EQ(material.ior, 1);
}

TEST(ParseMtl, TheFirstOfTwoMaterialsOfANameCounts) {
    const auto library = parse_mtl(
        "newmtl m\nKd 1 0 0\nnewmtl m\nKd 0 1 0\nnewmtl\nKd 0 0 1\nnewmtl n\nKd 1\n", "t.mtl");
    ASSERT_EQ(library.materials.size(), 2u);
    EXPECT_EQ(library.materials[0].diffuse, glm::dvec3(1, 0, 0));
    EXPECT_EQ(library.materials[1].name, "n");
    ASSERT_EQ(library.notes.size(), 1u);
    EXPECT_TRUE(library.notes[0].ends_with("the first counts (2 statements ignored)"));
}

TEST(ParseMtl, ColorsAndHighlights) {
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

TEST(ParseMtl, AnIndexOfZeroIsFineWhereNothingIsGlass) {
    EXPECT_EQ(mtl("Ni 0\nillum 2\n").ior, 1);
    EXPECT_EQ(mtl("Ni 0\nd 0.5\n").ior, 1);
    EXPECT_EQ(mtl("illum 4\nNi 0\nd 1\n").ior, 1);
}

/// This took the square of the number of lines.
TEST(ParseMtl, ManyMaterialsOfANameAreOneNote) {
    std::string text;
    for (int i = 0; i < 200000; ++i) text += "newmtl m\n";
    const auto library = parse_mtl(text, "t.mtl");
    ASSERT_EQ(library.notes.size(), 1u);
    EXPECT_TRUE(library.notes[0].ends_with("(199999 statements ignored)")) << library.notes[0];
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
    EXPECT_EQ(library.notes[0],
              "t.mtl:2:1: unknown statement 'map_Kd': textures and extensions are not supported (2 "
              "statements ignored)");
}

}  // namespace
}  // namespace rt::this_file
