// Objects of a scene file, and the instances that place them.
#include <gtest/gtest.h>

#include "scene/scene_builder.h"
#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

// A scene with these objects and shapes.
std::string scene_of_objects(const std::string& objects, const std::string& shapes) {
    return R"({"cameras": {"a": {"position": [0, 0, 9], "look_at": [0, 0, 0], "vertical_fov": 40}},
              "materials": {"white": {"type": "diffuse", "reflectance": 1}, "red": {"type": "diffuse", "reflectance": [1, 0, 0]}},
              "environment": {"radiance": 1}, "objects": {)" +
           objects + "},\n\"shapes\": [" + shapes + "]}";
}

// A triangle, a square, a sphere and a disk, each in the corner of its own.
const std::string THINGS = R"("things": [
    {"type": "mesh", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]], "material": "white",
     "transform": [{"translate": [1, 0, 0]}]},
    {"type": "quad", "vertices": [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], "material": "white"},
    {"type": "sphere", "center": [3, 0, 0], "radius": 0.5, "emission": 2},
    {"type": "disk", "center": [0, 3, 0], "normal": [0, 0, 1], "radius": 0.5, "material": "white"}])";

TEST(SceneObjects, AreSeenOnlyWhereInstancesPlaceThem) {
    SceneFolder folder;
    const Scene none = folder.load(scene_of_objects(THINGS, R"({"type": "sphere", "material": "red"})"));
    EXPECT_EQ(none.shapes.size(), 1u);
    const Scene scene = folder.load(scene_of_objects(
        THINGS,
        R"({"type": "instance", "object": "things", "transforms": [[{"scale": 2}, {"translate": [0, 0, 5]}], []]},
                   {"type": "instance", "object": "things", "material": "red", "emission": 0})"));
    ASSERT_EQ(scene.shapes.size(), 12u);
    EXPECT_EQ(scene.meshes.size(), 1u);
    const auto& first = std::get<MeshInstance>(scene.shapes[0].geometry);
    EXPECT_EQ(first.transform.point(dvec3(0)), dvec3(2, 0, 5));
    EXPECT_EQ(first.transform.point(dvec3(1, 1, 0)), dvec3(4, 2, 5));
    EXPECT_EQ(std::get<Quad>(scene.shapes[1].geometry).corners[2], dvec3(2, 2, 7));
    EXPECT_EQ(std::get<Sphere>(scene.shapes[2].geometry).center, dvec3(6, 0, 5));
    EXPECT_EQ(std::get<Sphere>(scene.shapes[2].geometry).radius, 1.0);
    EXPECT_EQ(std::get<Disk>(scene.shapes[3].geometry).center, dvec3(0, 6, 5));
    EXPECT_EQ(length(std::get<Disk>(scene.shapes[3].geometry).e1), 1.0);
    EXPECT_EQ(std::get<MeshInstance>(scene.shapes[4].geometry).transform.point(dvec3(0)), dvec3(1, 0, 0));
    EXPECT_EQ(scene.shapes[6].emission->radiance, vec3(2));
    for (size_t i = 8; i < 12; ++i) {
        EXPECT_EQ(scene.materials[scene.shapes[i].material].name, "red");
        EXPECT_FALSE(scene.shapes[i].emission.has_value());
    }
}

// A material replaces only the material, and an emission only the emission.
TEST(SceneObjects, AnInstanceReplacesOnlyWhatItNames) {
    SceneFolder folder;
    const Scene scene =
        folder.load(scene_of_objects(THINGS, R"({"type": "instance", "object": "things", "material": "red"},
                   {"type": "instance", "object": "things", "emission": 0},
                   {"type": "instance", "object": "things", "emission": 5})"));
    ASSERT_EQ(scene.shapes.size(), 12u);
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(scene.materials[scene.shapes[i].material].name, "red");
        EXPECT_EQ(scene.shapes[i].emission.has_value(), i == 2);
        for (const size_t instance : {1u, 2u}) {
            const Shape& shape = scene.shapes[4 * instance + i];
            EXPECT_EQ(scene.materials[shape.material].name == "white", i != 2) << i;
            EXPECT_EQ(shape.emission.has_value(), instance == 2) << i;
        }
    }
    EXPECT_EQ(scene.shapes[2].emission->radiance, vec3(2));
    EXPECT_EQ(scene.shapes[8].emission->radiance, vec3(5));
}

// What a material emits itself goes with it.
TEST(SceneObjects, TheEmissionOfAMaterialGoesWithIt) {
    std::string text = scene_of_objects(
        R"("lamp": [{"type": "sphere", "material": "glow"}, {"type": "sphere", "material": "white"}])",
        R"({"type": "instance", "object": "lamp", "material": "white"},
           {"type": "instance", "object": "lamp", "material": "glow"})");
    text.replace(text.find("\"red\""), 0, R"("glow": {"type": "principled", "emission": 3}, )");
    SceneFolder folder;
    const Scene scene = folder.load(text);
    ASSERT_EQ(scene.shapes.size(), 4u);
    for (size_t i = 0; i < 4; ++i)
        EXPECT_EQ(scene.shapes[i].emission.has_value(), i >= 2) << i;
}

// What is mirrored has the place, front and texture coordinates that the same shape has with that transform.
TEST(SceneObjects, AreMirroredAsTheirShapesAre) {
    const std::string square =
        R"({"type": "quad", "vertices": [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], "material": "white")";
    const std::string disk =
        R"({"type": "disk", "center": [0, 3, 0], "normal": [1, 0, 1], "material": "white")";
    const std::string mirror = R"("transform": [{"scale": [-1, 2, 1]}])";
    SceneFolder folder;
    const Scene scene =
        folder.load(scene_of_objects("\"o\": [" + square + "}, " + disk + "}]",
                                     R"({"type": "instance", "object": "o", )" + mirror + "}, " + square +
                                         ", " + mirror + "}, " + disk + ", " + mirror + "}"));
    ASSERT_EQ(scene.shapes.size(), 4u);
    const auto &a = std::get<Quad>(scene.shapes[0].geometry), &b = std::get<Quad>(scene.shapes[2].geometry);
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(a.corners[i], b.corners[i]);
        EXPECT_EQ(a.uvs[i], b.uvs[i]);
    }
    const auto &c = std::get<Disk>(scene.shapes[1].geometry), &d = std::get<Disk>(scene.shapes[3].geometry);
    EXPECT_EQ(c.center, d.center);
    EXPECT_EQ(c.e1, d.e1);
    EXPECT_EQ(c.e2, d.e2);
    for (size_t i = 0; i < 3; ++i)
        EXPECT_EQ(c.uvs[i], d.uvs[i]);
}

TEST(SceneObjects, MayHoldInstancesOfThoseBefore) {
    SceneFolder folder;
    const Scene scene = folder.load(scene_of_objects(
        R"("ball": [{"type": "sphere", "material": "white"}],
           "pair": [{"type": "instance", "object": "ball", "transforms": [[], [{"translate": [3, 0, 0]}]]}])",
        R"({"type": "instance", "object": "pair", "transform": [{"scale": 2}]})"));
    ASSERT_EQ(scene.shapes.size(), 2u);
    EXPECT_EQ(std::get<Sphere>(scene.shapes[1].geometry).center, dvec3(6, 0, 0));
    folder.expect_error(scene_of_objects(R"("a": [{"type": "instance", "object": @"b"}], "b": [])", ""),
                        "unknown object \"b\" (defined: none)");
}

TEST(SceneObjects, SayWhatIsWrongWithAnInstance) {
    SceneFolder folder;
    const auto with = [](const std::string& instance) { return scene_of_objects(THINGS, instance); };
    folder.expect_error(with(R"({"type": "instance", "object": @"thing"})"),
                        "unknown object \"thing\" (did you mean \"things\"? defined: things)");
    folder.expect_error(
        with(R"({"type": "instance", "object": "things", "transform": @[], "transforms": [[]]})"),
        "an instance has either transform or transforms; put this one into the list");
    folder.expect_error(
        with(R"({"type": "instance", "object": "things", "transforms": [[], @[{"scale": [1, 2, 1]}]]})"),
        "the transform flattens the object, or scales a sphere in it unevenly; use other factors, or a mesh "
        "instead of the sphere");
    folder.expect_error(
        with(R"({"type": "instance", "object": "things", "transforms": [@[{"translate": [1e37, 0, 0]}]]})"),
        TOO_FAR);
    // A texture, and normals from an image, need coordinates that the mesh lacks.
    std::string textured = with(R"(@{"type": "instance", "object": "things", "material": "red"})");
    textured.replace(textured.find("[1, 0, 0]}"), 9, R"({"image": "red.png"})");
    folder.expect_error(
        textured,
        "the material \"red\" has textures, but the mesh has no texture coordinates; export it "
        "with them, or use a material without textures");
    folder.expect_error(with(R"({"type": "instance", "object": "things", "emission": @-1})"),
                        "\"emission\": expected numbers of at least 0, found -1");
}

// The objects of pictures of ids: each shape of the scene is one, with a copy for each transform.
TEST(SceneObjects, ShapesHaveNames) {
    SceneFolder folder;
    folder.write("pot.ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                 "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                 "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    const Scene scene = folder.load(scene_of_objects(THINGS, R"({"type": "sphere", "material": "red"},
                   {"type": "instance", "object": "things", "transforms": [[], [{"scale": 2}]]},
                   {"type": "ply", "file": "pot.ply", "material": "red"},
                   {"type": "ply", "file": "pot.ply", "material": "red"},
                   {"type": "box", "name": "crate", "min": [0, 0, 0], "max": [1, 1, 1], "material": "red"})"));
    EXPECT_EQ(scene.objects, (std::vector<std::string>{"sphere 0", "things", "pot", "pot (2)", "crate"}));
    ASSERT_EQ(scene.shapes.size(), 1u + 8u + 2u + 6u);
    EXPECT_EQ(scene.shapes[0].object, 0u);
    for (size_t i = 1; i < 9; ++i) {
        EXPECT_EQ(scene.shapes[i].object, 1u);
        EXPECT_EQ(scene.shapes[i].copy, i < 5 ? 0u : 1u);
    }
    EXPECT_EQ(scene.shapes[10].object, 3u);
    for (size_t i = 11; i < 17; ++i)
        EXPECT_EQ(scene.shapes[i].object, 4u);

    folder.expect_error(scene_of_objects(R"("o": [{"type": "sphere", "material": "red", "name": @"a"}])", ""),
                        "a shape of an object has no name; name the object, or the instances that place it");
    folder.expect_error(scene_of_objects("", R"({"type": "sphere", "material": "red", "name": @""})"),
                        "\"name\": expected a name that is not empty, found \"\"");
}

}  // namespace
}  // namespace candela
