// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <glm/geometric.hpp>
#include <string>
#include <thread>
#include <vector>

#include "host/scene/model.h"
#include "host/scene/scene_file.h"
#include "tests/picture_files.h"
#include "tests/refusals.h"

namespace rt::this_file {
namespace {

namespace fs = std::filesystem;
using Positions = std::vector<glm::dvec3>;

class ModelFiles : public ScratchFolder {
   protected:
    std::string write(const std::string& name, const std::string& text) const {
        fs::create_directories((directory_ / name).parent_path());
        put(path(name), text);
        return path(name);
    }
};

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

const std::string ply_triangle =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

std::string scene_with(const std::string& meshes) {
    return R"({"camera": {"from": [0, 0, 5], "at": [0, 0, 0], "fov_degrees": 40},
               "materials": {"gray": {"diffuse": 0.5}, "red": {"diffuse": [1, 0, 0]}},
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
        {"file": "models/a.obj", "material": "gray"})"));
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

TEST_F(ModelFiles, LibrariesOutOfReachAreNotReadAndTheModelIsGray) {
    write("secret.mtl", "newmtl x\nKd 1 0 0\n");
    fs::create_directories(directory_ / "scene/folder.mtl");
    fs::create_symlink(directory_ / "secret.mtl", directory_ / "scene/link.mtl");
    ASSERT_EQ(mkfifo((directory_ / "scene/pipe.mtl").c_str(), 0600), 0);
    for (const std::string name : {"nowhere.mtl", "../secret.mtl", "/etc/passwd", "link.mtl",
                                   "folder.mtl", "pipe.mtl", "C:\\x\\y.mtl", ""}) {
        SCOPED_TRACE(name);
        const std::string model =
            write("scene/a.obj", "mtllib " + name + "\nusemtl x\n" + square + "f 1 2 3\n");
        const std::string scene = write("scene/scene.json", scene_with(R"({"file": "a.obj"})"));
        for (const std::string& path : {model, scene}) {
            const Scene loaded = load_scene(path);
            ASSERT_EQ(loaded.notes.size(), 1u);
            EXPECT_TRUE(loaded.notes[0].starts_with(model + ":1:"));
            EXPECT_EQ(loaded.materials.back().name, "default");
        }
    }
}

TEST_F(ModelFiles, AMaterialOfTheSceneMakesLibrariesNeedless) {
    write("a.obj", "mtllib nowhere.mtl\nusemtl x\n" + square + "f 1 2 3\n");
    const std::string path =
        write("scene.json", scene_with(R"({"file": "a.obj", "material": "red"})"));
    EXPECT_EQ(load_scene(path).meshes[0].face_materials, std::vector<int>{1});
}

TEST_F(ModelFiles, LinksOutOfTheFolderAreRefused) {
    write("secret.ply", ply_triangle);
    fs::create_directories(directory_ / "scene");
    fs::create_symlink(directory_ / "secret.ply", directory_ / "scene/link.ply");
    fs::create_symlink(directory_, directory_ / "scene/up");
    for (const std::string name : {"link.ply", "up/secret.ply"}) {
        const std::string path = write(
            "scene/scene.json", scene_with(R"({"material": "red", "file": ")" + name + "\"}"));
        const Refusal refusal = refusal_of([&] { load_scene(path); });
        EXPECT_EQ(refusal.exit_code, ExitCode::input);
        EXPECT_NE(refusal.message.find("is outside the scene's folder"), std::string::npos);
    }
    fs::create_symlink("../scene/inside.ply", directory_ / "scene/alias.ply");
    write("scene/inside.ply", ply_triangle);
    const std::string path =
        write("scene/scene.json", scene_with(R"({"material": "red", "file": "alias.ply"})"));
    EXPECT_EQ(triangle_count(load_scene(path)), 1u);
}

/// Keeps exchanging two file names on a thread of its own.
class Exchanger {
   public:
    Exchanger(const fs::path& one, const fs::path& other)
        : thread_([one, other, this] {
              while (!done_) {
                  renameat2(AT_FDCWD, one.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE);
              }
          }) {}
    ~Exchanger() {
        done_ = true;
        thread_.join();
    }

   private:
    std::atomic<bool> done_ = false;
    std::thread thread_;
};

TEST_F(ModelFiles, AFileThatBecomesALinkMeanwhileIsNotFollowed) {
    const std::string secret = write(
        "secret.ply", std::string(ply_triangle).replace(ply_triangle.find("0 1 0"), 5, "9 9 9"));
    write("scene/inside.ply", ply_triangle);
    fs::create_symlink(secret, directory_ / "scene/link.ply");
    const std::string path =
        write("scene/scene.json", scene_with(R"({"material": "red", "file": "inside.ply"})"));
    const Exchanger exchanger(directory_ / "scene/inside.ply", directory_ / "scene/link.ply");
    int loaded = 0;
    for (int i = 0; i < 3000; ++i) {
        const Refusal refusal = refusal_of([&] {
            ASSERT_EQ(load_scene(path).meshes.at(0).positions[2], glm::dvec3(0, 1, 0));
            ++loaded;
        });
        EXPECT_TRUE(refusal.exit_code == ExitCode::done || refusal.exit_code == ExitCode::input);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(loaded, 0);
}

TEST_F(ModelFiles, PipesAndFoldersDoNotHang) {
    ASSERT_EQ(mkfifo((directory_ / "pipe.ply").c_str(), 0600), 0);
    fs::create_directories(directory_ / "folder.ply");
    for (const std::string name : {"pipe.ply", "folder.ply"}) {
        const std::string path =
            write("scene.json", scene_with(R"({"material": "red", "file": ")" + name + "\"}"));
        const Refusal refusal = refusal_of([&] { load_scene(path); });
        EXPECT_NE(refusal.message.find("is not a regular file"), std::string::npos);
        const Refusal alone = refusal_of([&] { load_scene((directory_ / name).string()); });
        EXPECT_EQ(alone.exit_code, ExitCode::input);
    }
}

TEST_F(ModelFiles, FileAboveTheSizeCapIsOverTheLimit) {
    const std::string path = write("large.ply", ply_triangle);
    fs::resize_file(path, max_model_bytes + 1);  // sparse: takes no room
    const Refusal refusal = refusal_of([&] { load_scene(path); });
    EXPECT_EQ(refusal.exit_code, ExitCode::limit);
}

TEST_F(ModelFiles, FilesOfAnotherKindAreNamed) {
    const std::string utf16("v\0 \0001\0", 6);
    for (const auto& [text, kind] :
         {std::pair<std::string, std::string>{"<!DOCTYPE html>\n<html>", "is a web page"},
          {"version https://git-lfs.github.com/spec/v1\n", "is a Git LFS pointer"},
          {"\xff\xfe" + utf16, "is UTF-16"}}) {
        for (const std::string name : {"a.obj", "a.ply"}) {
            const std::string path = write(name, text);
            const Refusal refusal = refusal_of([&] { load_scene(path); });
            EXPECT_TRUE(refusal.message.starts_with(path + ": " + kind)) << refusal.message;
            EXPECT_EQ(refusal.message.find('\n'), std::string::npos);
        }
    }
}

TEST_F(ModelFiles, LibrariesAreFoundInAnotherLetterCase) {
    write("sub/Lib.MTL", "newmtl x\nKd 1 0 0\n");
    const Scene scene =
        load_scene(write("a.obj", "mtllib sub/lib.mtl\nusemtl x\n" + square + "f 1 2 3\n"));
    EXPECT_TRUE(scene.notes.empty());
    EXPECT_EQ(scene.materials.at(0).diffuse, glm::dvec3(1, 0, 0));
}

TEST_F(ModelFiles, AMissingModelIsLookedForWhereItIsSaid) {
    const std::string path = write("s/scene.json", scene_with(R"({"file": "no.obj"})"));
    const Refusal refusal = refusal_of([&] { load_scene(path); });
    EXPECT_NE(refusal.message.find("'no.obj' cannot be found or opened in '" +
                                   (directory_ / "s").string() + "'"),
              std::string::npos)
        << refusal.message;
}

TEST_F(ModelFiles, NotesOfASceneAreFew) {
    std::string meshes;
    for (int i = 0; i < 30; ++i) {
        const std::string name = std::to_string(i) + ".obj";
        write(name, "foo\n" + square + "f 1 2 3\n");
        meshes += (i > 0 ? ", " : "") + (R"({"material": "red", "file": ")" + name + "\"}");
    }
    const Scene scene = load_scene(write("scene.json", scene_with(meshes)));
    ASSERT_EQ(scene.notes.size(), 21u);
    EXPECT_EQ(scene.notes.back(), "and 10 more notes");
}

TEST_F(ModelFiles, TransformsThatLeadTooFarAreRefused) {
    write("a.obj", square + "v 9e29 0 0\nf 1 2 5\n");
    const std::string scene =
        write("scene.json",
              scene_with(R"({"material": "red", "transform": {"scale": 2}, "file": "a.obj"})"));
    EXPECT_EQ(refusal_of([&] { load_scene(scene); }).exit_code, ExitCode::input);
}

TEST_F(ModelFiles, DegenerateTrianglesAreANoteNotAMistake) {
    const std::string path = write("a.obj", square + "f 1 2 3\nf 1 1 2\nf 2 2 2\n");
    const Scene scene = load_scene(path);
    EXPECT_EQ(triangle_count(scene), 1u);
    ASSERT_EQ(scene.notes.size(), 1u);
    EXPECT_EQ(scene.notes[0], path + ": ignored 2 zero-area triangles");
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
}  // namespace rt::this_file
