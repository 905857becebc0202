// Formats by the file's extension; meshes that are scenes of their own.
#include "load/load.h"

#include <tuple>

#include <gtest/gtest.h>

#include "image/image_io.h"
#include "scene/geometry.h"
#include "unit/load/gltf/gltf_fixture.h"
#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

const std::string OBJ_TRIANGLE = "v 10 0 0\nv 11 0 0\nv 10 2 0\n";

std::string replaced_all(const std::string& text, char old, const std::string& by) {
    std::string result;
    for (const char c : text)
        result += c == old ? by : std::string(1, c);
    return result;
}

class Load : public testing::Test {
  protected:
    Scene load(const std::string& name, const std::string& text) {
        folder_.write(name, text);
        return load_scene(folder_.path() / name);
    }

    // The camera sees the whole box, and little else.
    static void expect_view_of_everything(const Scene& scene) {
        ASSERT_EQ(scene.cameras.size(), 1u);
        const Camera& camera = scene.cameras[0];
        EXPECT_EQ(camera.name, "default");
        const DoubleBox box = bounds(scene);
        const dvec3 forward = normalize(camera.look_at - camera.position);
        double widest = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            const dvec3 p(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                          corner & 4 ? box.hi.z : box.lo.z);
            const double angle = std::acos(dot(normalize(p - camera.position), forward));
            EXPECT_LT(angle, 0.5 * double(camera.vertical_fov));
            widest = std::max(widest, angle);
        }
        EXPECT_GT(widest, 0.1 * double(camera.vertical_fov));
    }

    SceneFolder folder_;
};

TEST_F(Load, AnObjFileIsAScene) {
    const Scene scene = load("m.OBJ", OBJ_TRIANGLE + "f 1 2 3\n");
    expect_view_of_everything(scene);
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_EQ(scene.files, std::vector{folder_.path() / "m.OBJ"});
    ASSERT_EQ(scene.shapes.size(), 1u);
    EXPECT_EQ(std::get<DiffuseMaterial>(scene.materials.at(scene.shapes[0].material).model).reflectance,
              vec3(0.5f));
    ASSERT_TRUE(scene.environment);
    EXPECT_EQ(scene.environment->radiance, std::vector<vec3>{vec3(1)});
}

TEST_F(Load, AnObjFileKeepsItsMaterialsAndLamps) {
    folder_.write("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl lamp\nKd 0\nKe 5 6 7\n");
    const Scene scene =
        load("m.obj", OBJ_TRIANGLE + "mtllib m.mtl\nf 1 2 3\nusemtl red\nf 1 2 3\nusemtl lamp\nf 3 2 1\n");
    expect_view_of_everything(scene);
    ASSERT_EQ(scene.shapes.size(), 3u);
    EXPECT_EQ(scene.materials[scene.shapes[1].material].name, "m.obj/red");
    EXPECT_EQ(scene.shapes[2].emission->radiance, vec3(5, 6, 7));
    EXPECT_FALSE(scene.environment) << "a lamp is light enough";
    EXPECT_EQ(scene.files.size(), 2u);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_EQ(folder_.without_folder(scene.warnings[0]),
              "m.obj: 1 face has no material (usemtl); shown in grey");
}

TEST_F(Load, APlyFileIsAScene) {
    const Scene scene = load("m.ply",
                             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                             "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                             "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    expect_view_of_everything(scene);
    EXPECT_EQ(triangle_count(scene), 1u);
    EXPECT_TRUE(scene.environment);
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_EQ(scene.files, std::vector{folder_.path() / "m.ply"});
}

TEST_F(Load, MessagesNameTheFile) {
    EXPECT_EQ(folder_.without_folder(error_of([&] { load("m.obj", "v 0 0 0\n"); })),
              "m.obj: the file has no faces (lines \"f 1 2 3\"); is it a Wavefront OBJ file?");
    EXPECT_EQ(
        folder_.without_folder(error_of([&] { load("m.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n"); })),
        "m.obj: the mesh has no triangle with an area; check its positions");
    EXPECT_EQ(folder_.without_folder(error_of([&] { load("m.ply", "v 0 0 0\n"); })),
              "m.ply: the file does not begin with the line \"ply\"; is it a PLY file?");
}

TEST_F(Load, AnyOtherExtensionIsJson) {
    for (const char* name : {"a.json", "a.scene", "a", "obj"})
        EXPECT_EQ(load(name, scene_of(R"({"type": "sphere", "emission": 1})")).shapes.size(), 1u);
}

TEST_F(Load, WhatAFileHoldsDecidesBeforeItsName) {
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    for (const char* name : {"m.obj", "m.json", "m", "m.ply.txt"})
        EXPECT_EQ(triangle_count(load(name, ply)), 1u) << name;
    EXPECT_EQ(triangle_count(load("m.obj", "\xEF\xBB\xBF" + ply)), 1u);
    EXPECT_EQ(triangle_count(load("m.obj", replaced_all(ply, '\n', "\r\n"))), 1u);

    GltfFile file;
    file.push("meshes", {{"primitives", {{{"attributes", {{"POSITION", file.add_corner()}}}}}}});
    file.root["nodes"] = {{{"mesh", 0}}};
    folder_.write("m.bin", file.bytes);
    const std::string text = file.document("m.bin");
    for (const char* name : {"m.json", "m", "m.GLB", "m.vrm"})
        EXPECT_EQ(triangle_count(load(name, text)), 1u) << name;
    const std::string binary = glb_of(glb_chunk("JSON", text + std::string(3 - (text.size() + 3) % 4, ' ')));
    for (const char* name : {"m.vrm", "m.obj", "m.ply", "m.json", "m"})
        EXPECT_EQ(triangle_count(load(name, binary)), 1u) << name;
}

TEST_F(Load, APointerOfGitLfsIsNamedAsOne) {
    const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:0123\nsize 12345\n";
    const auto message = [](const std::string& name) {
        return "cannot read \"" + name +
               "\": it is a pointer of Git LFS, not the file itself; run `git lfs pull`";
    };
    for (const std::string name : {"m.obj", "m.ply", "m.glb", "m.gltf", "m.json", "m"})
        EXPECT_EQ(folder_.without_folder(error_of([&] { load(name, pointer); })), message(name));
    folder_.write("sky.exr", pointer);
    EXPECT_EQ(folder_.without_folder(error_of([&] { read_exr_header(folder_.path() / "sky.exr"); })),
              message("sky.exr"));
    GltfFile file;
    file.push("meshes", {{"primitives", {{{"attributes", {{"POSITION", file.add_corner()}}}}}}});
    file.root["nodes"] = {{{"mesh", 0}}};
    folder_.write("m.bin", pointer);
    EXPECT_EQ(folder_.without_folder(error_of([&] { load("m.gltf", file.document("m.bin")); })),
              "m.gltf#/buffers/0/uri: " + message("m.bin"));
}

// Its second node shows the mesh again. A file is read in pieces of 64 KiB.
TEST_F(Load, ProgressIsTold) {
    using News = std::vector<std::tuple<std::string, size_t, size_t>>;
    constexpr size_t PIECE = 65536;
    News news;
    const auto note = [&](const char* what, size_t done, size_t of) { news.emplace_back(what, done, of); };
    GltfFile file;
    file.bytes.resize(2 * PIECE);
    const Json corner = {{"attributes", {{"POSITION", file.add_corner()}}}};
    file.push("meshes", {{"primitives", {corner, corner, {{"attributes", Json::object()}}}}});
    file.root["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}}};
    const std::string document = file.document("m.bin");
    folder_.write("m.gltf", document);
    folder_.write("m.bin", file.bytes);
    const size_t size = file.bytes.size();
    News expected{{"bytes", document.size(), document.size()},
                  {"bytes", PIECE, size},
                  {"bytes", 2 * PIECE, size},
                  {"bytes", size, size}};
    for (const size_t i : {1, 2, 3, 6})  // The second node shows the same mesh.
        expected.emplace_back("meshes", i, 6);
    load_scene(folder_.path() / "m.gltf", {.progress = note});
    EXPECT_EQ(news, expected);

    news.clear();
    const std::string disk = R"({"type": "disk", "center": [0, 0, 0], "normal": [0, 1, 0], "emission": 1})";
    folder_.load(
        R"({"scene": "m.gltf", "objects": {"o": [)" + disk + R"(]}, "shapes": [)" + disk + ", " + disk + "]}",
        {}, note);
    for (size_t i = 1; i <= 3; ++i)
        expected.emplace_back("shapes", i, 3);
    EXPECT_EQ(news, expected);
}

}  // namespace
}  // namespace candela
