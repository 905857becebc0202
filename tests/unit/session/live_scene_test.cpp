// A scene that stays: changes and poses make only the records again that depend on them, and all records are
// those of a scene that comes to the same state at once.
#include "session/live_scene.h"

#include <algorithm>
#include <initializer_list>

#include "scene/geometry.h"
#include "support/png_writer.h"
#include "unit/load/gltf/gltf_fixture.h"

namespace candela {
namespace {

const std::string LAMP = R"({"type": "principled", "emission": [1, 2, 3]})";
const std::string SKY = R"({"file": "sky.hdr"})";

BufferSet set_of(std::initializer_list<uint32_t> buffers) {
    BufferSet set;
    for (const uint32_t buffer : buffers)
        set.set(buffer);
    return set;
}

class LiveSceneTest : public Gltf {
  protected:
    // Two copies of a mesh that is large enough for instances; "move" moves the first. Besides, a triangle
    // that "morph" bends, and one that "hide" shrinks to a point at 1 s.
    LiveSceneTest() {
        constexpr uint32_t SIDE = 129;
        std::vector<float> places;
        std::vector<uint32_t> corners;
        for (uint32_t i = 0; i < SIDE * SIDE; ++i) {
            const uint32_t x = i % SIDE, y = i / SIDE;
            places.insert(places.end(), {float(x) / SIDE, float(y) / SIDE, 0.0f});
            if (x + 1 < SIDE && y + 1 < SIDE)
                corners.insert(corners.end(), {i, i + 1, i + SIDE, i + 1, i + SIDE + 1, i + SIDE});
        }
        GltfFile file;
        file.root["materials"] = {{{"name", "paint"}, {"doubleSided", true}}};
        file.show({{"attributes", {{"POSITION", file.add("VEC3", places)}}},
                   {"indices", file.add("SCALAR", corners)},
                   {"material", 0}});
        file.push("nodes", {{"mesh", 0}, {"translation", {0, 0, -3}}});
        const size_t target = file.add<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 0.5f});
        file.show({{"attributes", {{"POSITION", file.add_corner()}}},
                   {"material", 0},
                   {"targets", {{{"POSITION", target}}}}},
                  {{"translation", {2, 0, 0}}});
        file.show({{"attributes", {{"POSITION", file.add_corner()}}}, {"material", 0}},
                  {{"translation", {-2, 0, 0}}});
        const size_t times = file.add<float>("SCALAR", {0, 1});
        const auto animate = [&](const char* name, int node, const char* path, size_t values) {
            const Json target_of = {{"node", node}, {"path", path}};
            file.push("animations", {{"name", name},
                                     {"samplers", {{{"input", times}, {"output", values}}}},
                                     {"channels", {{{"sampler", 0}, {"target", target_of}}}}});
        };
        animate("move", 0, "translation", file.add<float>("VEC3", {0, 0, 0, 0.25f, 0, -1}));
        animate("morph", 2, "weights", file.add<float>("SCALAR", {0, 1}));
        animate("hide", 3, "scale", file.add<float>("VEC3", {1, 1, 1, 0, 0, 0}));
        folder_.write("m.gltf", file.document("m.bin"));
        folder_.write("m.bin", file.bytes);
        // Two texels, so bright that only the lamp's power decides how often the sky is chosen.
        const std::string texels{"\x80\x80\x80\x88\x40\x40\x80\x88", 8};
        folder_.write("sky.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + texels);
        folder_.write("red.png",
                      encode_png({.size = uvec2(1), .bits = 8, .color = png_rgb, .samples = {250, 20, 30}}));
    }

    // The scene has a lamp whose emission is that of its material, and which is wider than all else.
    void write(const std::string& lamp, const std::string& sky) {
        folder_.write("scene.json", R"({"scene": "m.gltf",
            "cameras": {"main": {"position": [0, 1, 9], "look_at": [0, 0, 0], "vertical_fov": 40}},
            "materials": {"lamp": )" + lamp +
                                        R"(}, "environment": )" + sky + R"(, "shapes": [
            {"type": "quad", "material": "lamp", "vertices": [[-5, 6, -5], [5, 6, -5], [5, 6, 5], [-5, 6, 5]]}
            ]})");
    }
    LiveScene loaded(const GltfOptions& options = {}) {
        LiveScene scene;
        scene.load(folder_.path() / "scene.json", {.gltf = options});
        EXPECT_EQ(scene.take_warnings(), std::vector<std::string>{});
        return scene;
    }

    // Expects that the scene has changed by this since its last update, that the records differ in these
    // buffers, and that they are those of a build of all.
    static void expect_update(LiveScene& scene, const SceneChange& change, const BufferSet& buffers) {
        ASSERT_TRUE(scene.pending());
        EXPECT_TRUE(*scene.pending() == change);
        EXPECT_EQ(scene.update(), buffers);
        EXPECT_TRUE(scene.pending() && !scene.pending()->any());
        EXPECT_EQ(scene.records().arrays, build_gpu_scene(scene.scene()).arrays);
    }
    static void expect_equal(LiveScene& a, LiveScene b) {
        a.update();
        b.update();
        EXPECT_EQ(a.records().arrays, b.records().arrays);
    }
};

TEST_F(LiveSceneTest, ChangesMakeAgainWhatDependsOnThem) {
    write(LAMP, SKY);
    LiveScene scene = loaded();
    EXPECT_FALSE(scene.pending());
    EXPECT_TRUE(scene.update().all());
    ASSERT_EQ(scene.records().instances.size(), 2u);
    scene.change(
        R"({"cameras": {"main": {"position": [1, 1, 9], "look_at": [0, 0, 0], "vertical_fov": 30}}})");
    expect_update(scene, {}, {});
    scene.change(R"({"environment": {"file": "sky.hdr", "intensity": 2}})");
    expect_update(scene, {.environment = true}, set_of({BUFFER_ENVIRONMENT}));
    const std::string sky = R"({"file": "sky.hdr", "intensity": 2, "rotation": 30})";
    scene.change(R"({"environment": )" + sky + "}");
    expect_update(scene, {.rotation = true}, {});
    scene.change(R"({"materials": {"paint": {"type": "diffuse", "reflectance": 0.3}}})");
    expect_update(scene, {.materials = true}, set_of({BUFFER_MATERIALS}));
    const std::string lamp = R"({"type": "principled", "emission": [3, 2, 1]})";
    scene.change(R"({"materials": {"lamp": )" + lamp + "}}");
    expect_update(scene, {.radiance = true, .materials = true}, set_of({BUFFER_LIGHTS}));
    write(lamp, sky);
    LiveScene same = loaded();
    same.change(R"({"materials": {"paint": {"type": "diffuse", "reflectance": 0.3}}})");
    expect_equal(same, std::move(scene));
}

// A shape that is another one, and images, whose numbers change.
TEST_F(LiveSceneTest, LampsGoOutAndImagesComeAndGo) {
    write(LAMP, SKY);
    LiveScene scene = loaded();
    scene.update();
    const uint32_t last = uint32_t(scene.scene().shapes.size()) - 1;
    scene.change(R"({"materials": {"lamp": {"type": "mirror"}}})");
    expect_update(scene, {.materials = true, .shapes = {last}},
                  set_of({BUFFER_MATERIALS, BUFFER_LIGHTS, BUFFER_SURFACES}));
    const std::string red = R"({"type": "diffuse", "reflectance": {"image": "red.png"}})";
    scene.change(R"({"materials": {"lamp": )" + red + "}}");
    EXPECT_TRUE(scene.pending()->images);
    scene.change(R"({"materials": {"lamp": )" + LAMP + "}}");
    EXPECT_TRUE(*scene.pending() == (SceneChange{.materials = true, .images = true, .shapes = {last}}));
    expect_equal(scene, loaded());
}

TEST_F(LiveSceneTest, PosesMakeAgainWhatMoves) {
    write(LAMP, SKY);
    LiveScene scene = loaded();
    scene.update();
    for (const char* name : {"m.gltf", "m.bin"})
        folder_.write(name, "");  // So that nothing can be read again.
    scene.pose(0.5, "move");
    const auto is_first_copy = [&](const Shape& shape) {
        const auto* mesh = std::get_if<MeshInstance>(&shape.geometry);
        return mesh != nullptr && mesh->transform.matrix()[3].z == -0.5;
    };
    const auto& shapes = scene.scene().shapes;
    const auto moved = uint32_t(std::ranges::find_if(shapes, is_first_copy) - shapes.begin());
    expect_update(scene, {.moved = {moved}}, set_of({BUFFER_NODES}));
    scene.pose(0.5, "morph");
    EXPECT_EQ(scene.pending()->moved, std::vector<uint32_t>{moved});
    EXPECT_EQ(scene.pending()->meshes.size(), 1u);
    scene.update();
    EXPECT_EQ(scene.records().arrays, build_gpu_scene(scene.scene()).arrays);
    scene.pose(1.0, "hide");
    EXPECT_FALSE(scene.pending());  // Another number of shapes.
    scene.pose(std::nullopt, std::nullopt);
    scene.change(R"({"environment": {"radiance": 1}})");
    EXPECT_FALSE(scene.pending());
}

TEST_F(LiveSceneTest, ChangesStayInOtherPoses) {
    write(LAMP, SKY);
    const std::string paint = R"({"materials": {"paint": {"type": "diffuse", "reflectance": 0.3}}})";
    const std::string rest = R"({"cameras": {"left": {"position": [-9, 1, 0], "look_at": [0, 0, 0],
        "vertical_fov": 30}}, "environment": {"radiance": 1}, "materials": {"lamp": {"type": "principled",
        "emission": 2, "base_color": {"image": "red.png"}}}})";
    LiveScene scene = loaded();
    scene.change(paint);
    scene.update();
    scene.change(rest);
    scene.pose(0.75, "move");
    LiveScene same = loaded({.animation = "move", .time = 0.75});
    same.change(rest);
    same.change(paint);
    EXPECT_EQ(scene.scene().cameras, same.scene().cameras);
    expect_equal(scene, std::move(same));
    // Now all is there that the next pose needs.
    scene.pose(0.5, "move");
    EXPECT_TRUE(scene.pending() && !scene.pending()->materials && !scene.pending()->environment &&
                !scene.pending()->images);
}

// The scene with the lamp's transform, or without the lamp, is that of a file.
TEST_F(LiveSceneTest, ObjectsMoveAndHideWithoutTheRest) {
    write(LAMP, SKY);
    LiveScene scene = loaded();
    scene.update();
    const auto at_first = scene.records().arrays;
    const std::vector<Shape> shapes = scene.scene().shapes;
    const auto copy = std::ranges::find_if(shapes, [&](const Shape& shape) {
        const auto* mesh = std::get_if<MeshInstance>(&shape.geometry);
        return mesh != nullptr && scene.scene().meshes[mesh->mesh].triangles.size() > 1;
    });
    const auto index = uint32_t(copy - shapes.begin());
    const std::string name = scene.scene().objects[copy->object];
    const auto change = [&](const std::string& what) {
        scene.change(R"({"objects": {")" + name + "\": {" + what + "}}}");
    };
    change(R"("transform": [{"translate": [0.25, 0, -1]}])");
    expect_update(scene, {.moved = {index}}, set_of({BUFFER_NODES}));
    change(R"("visible": false)");  // The other copy is then alone.
    EXPECT_TRUE(*scene.pending() == SceneChange{.shapes = {index}});
    scene.update();
    EXPECT_EQ(scene.records().arrays, build_gpu_scene(scene.scene()).arrays);
    EXPECT_EQ(triangle_count(scene.scene()), 2 * 128 * 128 + 2 + 2);
    change(R"("visible": true, "transform": [])");
    EXPECT_EQ(scene.pending()->shapes, std::vector<uint32_t>{index});
    scene.update();
    EXPECT_EQ(scene.records().arrays, at_first);
    scene.change(R"({"objects": {"quad 0": {"visible": false}}})");
    scene.update();
    EXPECT_EQ(scene.records().arrays, build_gpu_scene(scene.scene()).arrays);
    scene.pose(0.5, "move");  // It stays hidden, and what was moved stays where it is.
    EXPECT_FALSE(scene.scene().shapes.back().visible);
    scene.change(R"({"objects": {"quad 0": {"visible": true}}})");
    scene.pose(std::nullopt, std::nullopt);
    scene.update();
    EXPECT_EQ(scene.records().arrays, at_first);
}

// A mesh of an object, and the punctual lights: the other meshes' trees stay, and so do the changes in a
// pose.
TEST_F(LiveSceneTest, OtherMeshesAndLightsAreThoseOfAFile) {
    const auto write = [&](const std::string& mesh, const std::string& lights) {
        folder_.write("scene.json", R"({"scene": "m.gltf",
            "cameras": {"main": {"position": [0, 1, 9], "look_at": [0, 0, 0], "vertical_fov": 40}},
            "materials": {"wall": {"type": "diffuse", "reflectance": 0.5}}, "lights": [)" +
                                        lights +
                                        R"(], "shapes": [{"type": "mesh", "name": "wall", "material": "wall",
            "transform": [{"translate": [0, 1, 0]}], )" +
                                        mesh + "}]}");
    };
    const std::string lamp = R"({"type": "point", "position": [0, 3, 1], "intensity": 5})";
    const std::string sun = R"({"type": "directional", "direction": [0, -1, 0], "irradiance": 1})";
    const std::string mesh =
        R"("positions": [[0, 0, 0], [2, 0, 0], [0, 1, 0], [2, 1, 1]], "triangles": [[0, 1, 2], [1, 3, 2]])";
    write(R"("positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]])", lamp);
    LiveScene scene = loaded();
    scene.update();
    scene.change(R"({"meshes": {"wall": {)" + mesh + R"(}}, "lights": [)" + sun + ", " + lamp + "]}");
    ASSERT_TRUE(scene.pending());
    EXPECT_TRUE(scene.pending()->lights && scene.pending()->meshes.size() == 1u);
    EXPECT_TRUE(scene.pending()->shapes.empty() && !scene.pending()->materials);
    write(mesh, sun + ", " + lamp);
    expect_equal(scene, loaded());
    scene.pose(0.5, "move");
    expect_equal(scene, loaded({.animation = "move", .time = 0.5}));
}

// Materials that the change would read otherwise, and options that the file has no use for.
TEST_F(LiveSceneTest, WhatFailsLeavesTheScene) {
    write(LAMP, SKY);
    LiveScene scene = loaded();
    scene.update();
    const auto before = scene.records().arrays;
    EXPECT_NE(error_of([&] { scene.pose(0.5, "jump"); }).find("jump"), std::string::npos);
    EXPECT_NE(error_of([&] { scene.change(R"({"materials": {"wall": {"type": "mirror"}}})"); }).find("wall"),
              std::string::npos);
    EXPECT_NE(error_of([&] { scene.load(folder_.path() / "none.json", {}); }).find("none.json"),
              std::string::npos);
    expect_update(scene, {}, {});
    scene.pose(0.0, "move");  // As the nodes stand, and the options are those of the last pose that worked.
    scene.update();
    EXPECT_EQ(scene.records().arrays, before);
}

}  // namespace
}  // namespace candela
