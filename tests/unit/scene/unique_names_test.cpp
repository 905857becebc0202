// Unique names, and lists of a file in which many have one name.
#include "scene/unique_names.h"

#include <gtest/gtest.h>

#include "scene/scene_builder.h"

namespace candela {
namespace {

// As a search from the front, for each name, would take days.
constexpr int MANY = 100'000;

TEST(UniqueNames, AreThoseThatAreAskedForOrSimilar) {
    UniqueNames names;
    names.note("b");
    names.note("a (3)");
    EXPECT_EQ(names.choose("a"), "a");
    EXPECT_EQ(names.choose("a"), "a (2)");
    EXPECT_EQ(names.choose("a"), "a (4)");
    EXPECT_EQ(names.choose("a (2)"), "a (2) (2)");
    EXPECT_EQ(names.choose("b"), "b (2)");
    EXPECT_EQ(names.choose("c"), "c");
}

TEST(UniqueNames, OfManyThingsOfOneNameTakeNoTime) {
    UniqueNames names;
    for (int i = 2; i <= MANY; ++i)
        names.note("a (" + std::to_string(i) + ")");
    EXPECT_EQ(names.choose("a"), "a");
    for (int i = 1; i <= MANY; ++i)
        EXPECT_EQ(names.choose("a"), "a (" + std::to_string(MANY + i) + ")");
}

TEST(UniqueNames, OfMaterialsAreThose) {
    Scene scene;
    scene.materials.push_back({.name = "clay", .model = DiffuseMaterial{}});
    SceneBuilder builder(scene);
    for (int i = 0; i < MANY; ++i)
        EXPECT_EQ(builder.add_material({.name = "clay", .model = DiffuseMaterial{}}), uint32_t(i + 1));
    EXPECT_EQ(scene.materials[1].name, "clay (2)");
    EXPECT_EQ(scene.materials.back().name, "clay (" + std::to_string(MANY + 1) + ")");
    builder.black();
    EXPECT_EQ(builder.add_material({.name = "(black)", .model = DiffuseMaterial{}}), uint32_t(MANY + 2));
    EXPECT_EQ(scene.materials.back().name, "(black) (2)");
}

}  // namespace
}  // namespace candela
