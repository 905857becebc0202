// OBJ files that bring their own materials into a scene.
#include <gtest/gtest.h>

#include "scene/geometry.h"
#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

const std::string FOUR_CORNERS = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
constexpr const char* OBJ_SHAPE = R"({"type": "obj", "file": "m.obj"})";

class ObjMaterials : public testing::Test {
  protected:
    ObjMaterials() { folder_.write("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl lamp\nKd 0\nKe 5 6 7\n"); }

    // Writes m.obj: the corners of a square, and `text` from line 5 on.
    void write(const std::string& text) { folder_.write("m.obj", FOUR_CORNERS + text); }

    Scene load(const std::string& text, const std::string& shapes = OBJ_SHAPE) {
        write(text);
        return folder_.load(scene_of(shapes));
    }

    // Checks the message for m.obj, after the place of the file's name in the scene.
    void expect_error(const std::string& text, const std::string& message) {
        SCOPED_TRACE(text);
        write(text);
        folder_.expect_error(scene_of(R"({"type": "obj", "file": @"m.obj"})"), message);
    }

    void expect_warnings(const Scene& scene, const std::vector<std::string>& warnings) {
        ASSERT_EQ(scene.warnings.size(), warnings.size());
        for (size_t i = 0; i < warnings.size(); ++i)
            EXPECT_EQ(folder_.without_folder(scene.warnings[i]), warnings[i]);
    }

    static vec3 reflectance(const Scene& scene, size_t shape) {
        return std::get<DiffuseMaterial>(scene.materials.at(scene.shapes.at(shape).material).model)
            .reflectance.factor;
    }

    SceneFolder folder_;
};

TEST_F(ObjMaterials, CutTheMeshIntoAShapePerMaterial) {
    const Scene scene =
        load("mtllib m.mtl\nusemtl red\nf 1 2 3\nusemtl lamp\nf 1 3 4\nusemtl red\nf 4 3 2 1\n");
    expect_warnings(scene, {});
    ASSERT_EQ(scene.shapes.size(), 2u);
    EXPECT_EQ(world_mesh(scene, 0).triangles.size(), 3u);
    EXPECT_EQ(world_mesh(scene, 0).positions.size(), 4u);
    EXPECT_EQ(reflectance(scene, 0), vec3(1, 0, 0));
    EXPECT_FALSE(scene.shapes[0].emission);
    EXPECT_EQ(world_mesh(scene, 1).positions, (std::vector<vec3>{vec3(0), vec3(1, 1, 0), vec3(0, 1, 0)}));
    EXPECT_EQ(reflectance(scene, 1), vec3(0));
    ASSERT_TRUE(scene.shapes[1].emission);
    EXPECT_EQ(scene.shapes[1].emission->radiance, vec3(5, 6, 7));
    EXPECT_FALSE(scene.shapes[1].emission->two_sided);
    EXPECT_EQ(scene.materials[scene.shapes[0].material].name, "m.obj/red");
    EXPECT_EQ(scene.materials[scene.shapes[1].material].name, "m.obj/lamp");
    EXPECT_EQ(scene.materials.size(), 2u + 2u);  // scene_of() defines two.
}

TEST_F(ObjMaterials, GiveWayToTheScene) {
    const char* text = "mtllib no.mtl\nusemtl unknown\nf 1 2 3\nusemtl other\nf 1 3 4\n";
    const Scene white = load(text, R"({"type": "obj", "file": "m.obj", "material": "white"})");
    ASSERT_EQ(white.shapes.size(), 1u);
    EXPECT_EQ(white.materials[white.shapes[0].material].name, "white");
    EXPECT_EQ(world_mesh(white, 0).triangles.size(), 2u);
    const Scene lamp = load(text, R"({"type": "obj", "file": "m.obj", "emission": 3})");
    ASSERT_EQ(lamp.shapes.size(), 1u);
    EXPECT_EQ(reflectance(lamp, 0), vec3(0));
    EXPECT_EQ(lamp.shapes[0].emission->radiance, vec3(3));
}

TEST_F(ObjMaterials, KeepSmoothNormalsAcrossTheBorder) {
    // Two squares that meet at a right angle along x = 1, in different colours.
    const std::string text =
        "v 1 0 -1\nv 1 1 -1\nmtllib m.mtl\nusemtl red\nf 1 2 3 4\nusemtl lamp\nf 2 5 6 3\n";
    const Scene scene = load(text, R"({"type": "obj", "file": "m.obj", "normals": "smooth"})");
    for (size_t shape : {0, 1}) {
        const TriangleMesh part = world_mesh(scene, shape);
        ASSERT_EQ(part.normals.size(), 4u);
        for (size_t i = 0; i < 4; ++i) {
            const vec3 flat = shape == 0 ? vec3(0, 0, 1) : vec3(1, 0, 0);
            const vec3 expected =
                part.positions[i].x == 1.0f && part.positions[i].z == 0.0f ? normalize(vec3(1, 0, 1)) : flat;
            EXPECT_NEAR(length(part.normals[i] - expected), 0.0f, 1e-6f);  // Rounding of unit vectors.
        }
    }
}

TEST_F(ObjMaterials, KeepTheNormalsOfTheFile) {
    const Scene scene = load(
        "vn 0 0 1\nvn 0 1 1\nmtllib m.mtl\nusemtl red\nf 1//1 2//1 3//1\nusemtl lamp\n"
        "f 1//2 3//2 4//2\n");
    EXPECT_EQ(world_mesh(scene, 0).normals, std::vector<vec3>(3, vec3(0, 0, 1)));
    for (const vec3 n : world_mesh(scene, 1).normals)
        EXPECT_NEAR(length(n - normalize(vec3(0, 1, 1))), 0.0f, 1e-6f);  // Rounding of unit vectors.
}

TEST_F(ObjMaterials, MayEmitOnBothSides) {
    const Scene scene =
        load("mtllib m.mtl\nusemtl red\nf 1 2 3\nusemtl lamp\nf 1 3 4\n",
             R"({"type": "obj", "file": "m.obj", "two_sided": true}, {"type": "obj", "file": "m.obj"})");
    ASSERT_EQ(scene.shapes.size(), 4u);
    EXPECT_FALSE(scene.shapes[0].emission);
    EXPECT_TRUE(scene.shapes[1].emission->two_sided);
    EXPECT_FALSE(scene.shapes[3].emission->two_sided);
    write("mtllib m.mtl\nusemtl red\nf 1 2 3\n");
    folder_.expect_error(scene_of(R"({"type": "obj", "file": "m.obj", "two_sided": @true})"),
                         "two_sided says where emission leaves, but no material of the file emits (Ke)");
}

TEST_F(ObjMaterials, AreAddedOnceForAllShapesOfAFile) {
    folder_.write("m.mtl", "newmtl red\nKd 2 0 0\ndisp b.png\n");
    const Scene scene =
        load("mtllib m.mtl\nusemtl red\nf 1 2 3\n",
             std::string(OBJ_SHAPE) + ", " + OBJ_SHAPE + R"(, {"type": "obj", "file": "./m.obj"})");
    ASSERT_EQ(scene.shapes.size(), 3u);
    EXPECT_EQ(scene.shapes[0].material, scene.shapes[1].material);
    EXPECT_EQ(scene.materials.size(), 2u + 2u);
    EXPECT_EQ(scene.materials[3].name, "./m.obj/red");
    ASSERT_EQ(scene.warnings.size(), 2u + 2u + 1u);  // The last: there is no light.
}

TEST_F(ObjMaterials, DoNotTakeNamesOfTheScene) {
    write("mtllib m.mtl\nusemtl red\nf 1 2 3\n");
    const Scene scene = folder_.load(
        R"xx({"cameras": {"main": {"position": [0, 0, 5], "look_at": [0, 0, 0], "vertical_fov": 40}},
"materials": {"m.obj/red": {"type": "diffuse", "reflectance": 1},
              "m.obj/red (2)": {"type": "diffuse", "reflectance": 1}},
"shapes": [{"type": "obj", "file": "m.obj"}]})xx");
    EXPECT_EQ(scene.materials[scene.shapes.at(0).material].name, "m.obj/red (3)");
    EXPECT_EQ(reflectance(scene, 0), vec3(1, 0, 0));
    // A shape of the scene cannot use them.
    folder_.expect_error(
        scene_of(std::string(OBJ_SHAPE) + R"(, {"type": "obj", "file": "m.obj", "material": @"m.obj/red"})"),
        "unknown material \"m.obj/red\" (defined: glass, white)");
}

TEST_F(ObjMaterials, FacesBeforeTheFirstAreGrey) {
    const Scene scene = load("f 1 2 3\nf 2 3 4\nmtllib m.mtl\nusemtl lamp\nf 1 3 4\n");
    ASSERT_EQ(scene.shapes.size(), 2u);
    EXPECT_EQ(reflectance(scene, 0), vec3(0.5f));
    EXPECT_EQ(world_mesh(scene, 0).triangles.size(), 2u);
    EXPECT_EQ(scene.materials[scene.shapes[0].material].name, "m.obj (no material)");
    expect_warnings(scene, {"scene.json:3:36: m.obj: 2 faces have no material (usemtl); shown in grey"});
    expect_warnings(load("f 1 2 3\nmtllib m.mtl\nusemtl lamp\nf 1 3 4\n"),
                    {"scene.json:3:36: m.obj: 1 face has no material (usemtl); shown in grey"});
}

TEST_F(ObjMaterials, FacesBeforeTheFirstMayHaveColours) {
    const Scene scene = load("v 0 0 1 1 0 0\nf 1 2 5\nmtllib m.mtl\nusemtl lamp\nf 1 3 4\n");
    expect_warnings(scene,
                    {"scene.json:3:36: m.obj: 1 face has no material (usemtl); shown in the colours of "
                     "their vertices"});
    EXPECT_TRUE(scene.materials[scene.shapes.at(0).material].vertex_colors);
    EXPECT_EQ(reflectance(scene, 0), vec3(1));
    EXPECT_FALSE(scene.materials[scene.shapes.at(1).material].vertex_colors);
}

TEST_F(ObjMaterials, WarnOfWhatIsUsed) {
    folder_.write("m.mtl", "newmtl a\nKd 2\ndisp a.png\nnewmtl b\nKd 3\nnewmtl lamp\nKe 1\n");
    expect_warnings(load("mtllib m.mtl\nusemtl lamp\nf 1 2 3\nusemtl a\nf 1 3 4\n"),
                    {"scene.json:3:36: m.mtl: ignored disp (textures of these kinds are not supported)",
                     "scene.json:3:36: m.mtl:1: material \"a\": Kd is 2 in a channel; it is scaled to 1"});
}

TEST_F(ObjMaterials, AreMissing) {
    write("f 1 2 3\nusemtl red\n");
    const std::string message =
        "the shape has neither material nor emission, and no face of its file has a material (usemtl); add "
        "one of them";
    folder_.expect_error(scene_of(R"(@{"type": "obj", "file": "m.obj"})"), message);
    write("mtllib m.mtl\nf 1 2 3\n");
    folder_.expect_error(scene_of(R"(@{"type": "obj", "file": "m.obj"})"), message);
}

TEST_F(ObjMaterials, LieInSeveralLibraries) {
    folder_.write("n.mtl", "newmtl red\nKd 0.25 0 0\nnewmtl blue\nKd 0 0 1\n");
    folder_.write("my own.mtl", "newmtl green\nKd 0 1 0\n");
    folder_.write("own.mtl", "newmtl green\nKd 0 0 0\n");  // Its name is a word of the one before.
    for (const char* names : {"mtllib m.mtl\nmtllib n.mtl\nmtllib my own.mtl\nmtllib m.mtl\n",
                              "mtllib my own.mtl\r\nmtllib  m.mtl n.mtl \r\n"}) {
        SCOPED_TRACE(names);
        const Scene scene = load(std::string(names) +
                                 "usemtl red\nf 1 2 3\nusemtl blue \nf 1 2 3\nusemtl green\r\nf 1 3 4\n");
        ASSERT_EQ(scene.shapes.size(), 3u);
        EXPECT_EQ(reflectance(scene, 0), vec3(1, 0, 0));
        EXPECT_EQ(reflectance(scene, 1), vec3(0, 0, 1));
        EXPECT_EQ(reflectance(scene, 2), vec3(0, 1, 0));
        EXPECT_EQ(scene.warnings.size(), 1u);  // There is no light.
    }
}

TEST_F(ObjMaterials, LieBesideTheirFile) {
    std::filesystem::create_directory(folder_.path() / "parts");
    folder_.write("parts/p.mtl", "newmtl red clay\nKd 0 1 0\n");
    folder_.write("parts/m.obj", std::string(FOUR_CORNERS) + "mtllib p.mtl\nusemtl  red clay\t\nf 1 2 3\n");
    const Scene scene = folder_.load(scene_of(R"({"type": "obj", "file": "parts/m.obj"})"));
    EXPECT_EQ(reflectance(scene, 0), vec3(0, 1, 0));
    EXPECT_EQ(scene.materials[scene.shapes[0].material].name, "parts/m.obj/red clay");
}

TEST_F(ObjMaterials, MayLieInMissingLibraries) {
    const auto missing = [](const std::string& name) {
        return "scene.json:3:36: m.obj:5: the material library \"" + name +
               "\" does not exist; its materials are shown in grey";
    };
    const auto text = [](const std::string& names) { return "mtllib " + names + "\nusemtl blue\nf 1 2 3\n"; };
    for (const char* name : {"tex/no.mtl", "my own.mtl", "."}) {
        const Scene scene = load(text(name));
        EXPECT_EQ(reflectance(scene, 0), vec3(0.5f));
        EXPECT_EQ(scene.materials[scene.shapes[0].material].name, "m.obj/blue");
        ASSERT_EQ(scene.warnings.size(), 2u);  // The other: there is no light.
        EXPECT_EQ(folder_.without_folder(scene.warnings[0]), missing(name));
    }
    const Scene some = load("mtllib no.mtl m.mtl n.mtl\nmtllib o.mtl\nusemtl red\nf 1 2 3\n");
    EXPECT_EQ(reflectance(some, 0), vec3(1, 0, 0));
    EXPECT_EQ(folder_.without_folder(some.warnings.at(0)), missing("no.mtl") + " (2 times)");
    EXPECT_EQ(reflectance(load("mtllib\nmtllib m.mtl\nusemtl red\nf 1 2 3\n"), 0), vec3(1, 0, 0));
    folder_.write("m.mtl", "newmtl red\nKd x\n");
    expect_error("mtllib m.mtl\nusemtl red\nf 1 2 3\n", "m.mtl:2: Kd needs a number, found \"x\"");
}

// Whether they exist is not told.
TEST_F(ObjMaterials, MayLieInLibrariesOutOfReach) {
    std::filesystem::create_directory(folder_.path() / "in");
    folder_.write("m.mtl", "newmtl red\nKd 1 0 0\n");
    const std::filesystem::path file = folder_.path() / "in/m.obj";
    for (const std::string name : {"../m.mtl", "../none.mtl"}) {
        folder_.write("in/m.obj", std::string(FOUR_CORNERS) + "mtllib " + name + "\nusemtl red\nf 1 2 3\n");
        const Scene scene = load_scene(file);
        EXPECT_EQ(reflectance(scene, 0), vec3(0.5f));
        EXPECT_EQ(folder_.without_folder(scene.warnings.at(0)),
                  "in/m.obj:5: " + folder_.without_folder(FileReach(file).refusal(name)) +
                      "; its materials are shown in grey");
        EXPECT_EQ(reflectance(load_scene(file, {.reach = {.folders = {folder_.path()}}}), 0),
                  name == "../m.mtl" ? vec3(1, 0, 0) : vec3(0.5f));
    }
}

TEST_F(ObjMaterials, LieInLibrariesThatOtherComputersName) {
    folder_.write("the clay.mtl", "newmtl red\nKd 1 0 0\n");
    folder_.write("n.mtl", "newmtl blue\nKd 0 0 1\n");
    for (const char* names :
         {"\"the clay.mtl\"", "the clay.mtl # by hand", "C:\\models\\the clay.mtl", "..\\gone/the clay.mtl",
          "\"the clay.mtl\" n.mtl", "n.mtl \"C:\\models\\the clay.mtl\""}) {
        SCOPED_TRACE(names);
        const Scene scene = load(std::string("mtllib ") + names + "\nusemtl red\nf 1 2 3\n");
        EXPECT_EQ(reflectance(scene, 0), vec3(1, 0, 0));
        EXPECT_EQ(scene.warnings.size(), 1u);  // There is no light.
    }
}

TEST_F(ObjMaterials, AreGreyIfTheyAreUnknown) {
    const Scene scene = load("mtllib m.mtl\nusemtl red\nusemtl Red\nf 1 2 3\nusemtl green\nf 1 3 4\n");
    EXPECT_EQ(reflectance(scene, 0), vec3(0.5f));
    EXPECT_EQ(reflectance(scene, 1), vec3(0.5f));
    ASSERT_EQ(scene.warnings.size(), 2u);  // The other: there is no light.
    EXPECT_EQ(
        folder_.without_folder(scene.warnings[0]),
        "scene.json:3:36: m.obj:7: unknown material \"Red\" (defined: lamp, red); shown in grey (2 times)");
    EXPECT_EQ(folder_.without_folder(load("usemtl red\nf 1 2 3\n").warnings.at(0)),
              "scene.json:3:36: m.obj:5: unknown material \"red\": the file names no library (\"mtllib "
              "pot.mtl\"); shown in grey");
    const Scene colored = load("v 0 0 1 1 0 0\nmtllib m.mtl\nusemtl Red\nf 1 2 5\n");
    EXPECT_TRUE(colored.materials[colored.shapes.at(0).material].vertex_colors);
    EXPECT_EQ(load("mtllib m.mtl\nusemtl Red\nusemtl red\nf 1 2 3\n").warnings.size(),
              1u);  // No face uses it.
    folder_.write("m.mtl", "# none\n");
    EXPECT_EQ(folder_.without_folder(load("mtllib m.mtl\nusemtl red\nf 1 2 3\n").warnings.at(0)),
              "scene.json:3:36: m.mtl: the file has no materials");
}

// Blender writes this for an empty slot.
TEST_F(ObjMaterials, MayHaveNoName) {
    const Scene scene = load("mtllib m.mtl\nusemtl lamp\nf 1 2 3\nusemtl \nf 1 3 4\n");
    EXPECT_EQ(reflectance(scene, 1), vec3(0.5f));
    expect_warnings(scene, {"scene.json:3:36: m.obj: 1 face has no material (usemtl); shown in grey"});
}

TEST_F(ObjMaterials, WarnOnceOfAllThatAreOdd) {
    folder_.write("m.mtl", "newmtl a\nKd 2\nKe 1\nnewmtl b\nKd 3\nnewmtl c\nKd 4\nNs nan\n");
    expect_warnings(load("mtllib m.mtl\nusemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\nusemtl c\nf 1 3 4\n"),
                    {"scene.json:3:36: m.mtl:8: Ns has no finite number, and is ignored",
                     "scene.json:3:36: m.mtl:1: material \"a\": Kd is 2 in a channel; it is scaled to 1 (3 "
                     "times)"});
}

TEST_F(ObjMaterials, LeaveOutPartsWithoutArea) {
    const Scene scene = load("mtllib m.mtl\nusemtl red\nf 1 2 2\nusemtl lamp\nf 1 3 4\nf 1 1 2\n");
    ASSERT_EQ(scene.shapes.size(), 1u);
    EXPECT_TRUE(scene.shapes[0].emission);
    expect_warnings(scene, {"scene.json:3:12: left out 2 triangles without area"});
    write("mtllib m.mtl\nusemtl red\nf 1 2 2\nusemtl lamp\nf 1 1 2\n");
    folder_.expect_error(scene_of(R"(@{"type": "obj", "file": "m.obj"})"),
                         "the mesh has no triangle with an area; check its positions");
}

// The objects of pictures of ids. Of flat triangles nothing is left.
TEST_F(ObjMaterials, GroupsAreObjectsOfASceneByItself) {
    const auto scene_of_file = [this](const std::string& text) {
        write(text);
        return load_scene(folder_.path() / "m.obj");
    };
    const Scene scene = scene_of_file(
        "mtllib m.mtl\nf 1 2 2\nf 1 2 3\no none\no lid\nusemtl red\nf 1 3 4\ng handle\no pot\nf 1 2 2\nf 1 2 "
        "3\n"
        "o lid\nf 1 2 3 4\n");
    EXPECT_EQ(scene.objects, (std::vector<std::string>{"m", "lid", "pot"}));
    ASSERT_EQ(scene.shapes.size(), 2u);
    for (const Shape& shape : scene.shapes)
        EXPECT_EQ(shape.object, 0u);
    EXPECT_EQ(scene.meshes[0].groups, (std::vector<uint32_t>{0}));
    EXPECT_EQ(scene.meshes[1].groups, (std::vector<uint32_t>{1, 2, 1, 1}));

    EXPECT_EQ(scene_of_file("g side left\nf 1 2 3\ng back\nf 1 3 4\n").objects,
              (std::vector<std::string>{"side left", "back"}));
    EXPECT_EQ(scene_of_file("f 1 2 3\n").objects, (std::vector<std::string>{"m"}));

    const Scene native = load("mtllib m.mtl\nusemtl red\no lid\nf 1 2 3\no pot\nf 1 3 4\n");
    EXPECT_EQ(native.objects, (std::vector<std::string>{"m"}));
    EXPECT_TRUE(native.meshes[0].groups.empty());
}

}  // namespace
}  // namespace candela
