// Numbers and names of a scene's objects, instances and materials.
#include "scene/label_scene.h"

#include <gtest/gtest.h>

#include "scene/scene_builder.h"
#include "unit/base/base_fixture.h"

namespace candela {
namespace {

TEST(LabelScene, NumbersObjectsAndInstancesByTheirFirstShapes) {
    Scene scene;
    scene.materials = {{.name = "clay", .model = {}}, {.name = "", .model = {}}};
    SceneBuilder builder(scene);
    builder.add({.material = 1, .emission = {}}, Sphere{});  // No object's.
    builder.begin_object("unused");
    builder.begin_object("tree");
    for (int copy = 0; copy < 2; ++copy) {
        builder.add({.material = 0, .emission = {}}, Sphere{});
        builder.add({.material = 1, .emission = {}}, Sphere{});
        builder.begin_copy();
    }
    builder.begin_object("tree");
    builder.add({.material = 0, .emission = {}}, Sphere{});
    builder.begin_object("shape 0");
    builder.add({.material = 0, .emission = {}}, Sphere{});

    const Labels labels = label_scene(scene);
    EXPECT_EQ(labels.objects, (std::vector<std::string>{"shape 0 (2)", "tree", "tree (2)", "shape 0"}));
    EXPECT_EQ(labels.materials, (std::vector<std::string>{"clay", "material 1"}));
    ASSERT_EQ(labels.instances.size(), 5u);
    EXPECT_EQ(labels.instances[2].object, 2u);
    EXPECT_EQ(labels.instances[2].copy, 1u);
    const std::vector<ShapeLabels> expected = {{1, 1, 2}, {2, 2, 1}, {2, 2, 2}, {2, 3, 1},
                                               {2, 3, 2}, {3, 4, 1}, {4, 5, 1}};
    ASSERT_EQ(labels.shapes.size(), expected.size());
    for (size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(labels.shapes[i].object, expected[i].object) << i;
        EXPECT_EQ(labels.shapes[i].instance, expected[i].instance) << i;
        EXPECT_EQ(labels.shapes[i].material, expected[i].material) << i;
    }
}

TEST(LabelScene, NamesAreUtf8) {
    Scene scene;
    scene.materials = {{.name = "a\xFFz", .model = {}}};
    SceneBuilder builder(scene);
    builder.begin_object("W\xC3\xBCrfel \xC3");
    builder.add({.material = 0, .emission = {}}, Sphere{});
    const Labels labels = label_scene(scene);
    EXPECT_EQ(labels.objects[0], "W\xC3\xBCrfel \xEF\xBF\xBD");
    EXPECT_EQ(labels.materials[0], "a\xEF\xBF\xBDz");
}

TEST(LabelScene, RefusesMoreThanFloatsCanNumber) {
    EXPECT_NO_THROW(check_label_count(16'777'216, "objects"));
    EXPECT_EQ(
        error_of([] { check_label_count(16'777'217, "objects"); }),
        "the scene has 16777217 objects, and pictures of ids can number 16777216 at most; leave out the "
        "layers of ids (--aov, --labels, --manifest)");
}

// These two have the same hash.
TEST(LabelScene, WarnsOfNamesThatCryptomatteCannotTellApart) {
    EXPECT_TRUE(warnings_of_collisions({"part0", "part1", "part71663"}, "objects").empty());
    EXPECT_EQ(warnings_of_collisions({"part0", "part71663", "part108007"}, "objects"),
              (std::vector<std::string>{"the objects part71663, part108007 have the same Cryptomatte id, and "
                                        "are one matte; rename all but one"}));
}

// Shapes whose meshes belong to the same three objects.
TEST(LabelScene, ObjectsOfOneMeshHaveNumbersInARow) {
    Scene scene;
    scene.materials.resize(1);
    SceneBuilder builder(scene);
    builder.begin_object("floor");
    builder.add({}, Sphere{});
    builder.begin_objects({"pot", "lid", "floor"});
    for (const std::vector<uint32_t>& groups : {std::vector<uint32_t>{0, 0}, {2, 1}}) {
        scene.meshes.push_back({.triangles = {uvec3(0), uvec3(0)}, .groups = groups});
        builder.add({}, MeshInstance{uint32_t(scene.meshes.size() - 1)});
    }
    builder.begin_object("cup");
    builder.add({}, Sphere{});
    const Labels labels = label_scene(scene);
    EXPECT_EQ(labels.objects, (std::vector<std::string>{"floor", "pot", "lid", "floor (2)", "cup"}));
    EXPECT_EQ(labels.instances.size(), 5u);
    EXPECT_EQ(labels.shapes[1].object, 2u);
    EXPECT_EQ(labels.shapes[2].object, 2u);
    EXPECT_EQ(labels.shapes[2].instance, 2u);
    EXPECT_EQ(labels.shapes[3].object, 5u);
    EXPECT_EQ(labels.shapes[3].instance, 5u);
}

}  // namespace
}  // namespace candela
