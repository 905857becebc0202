// Shapes of a scene file: their surface, and spheres and disks under transforms.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

TEST(SceneShapes, GiveEmittersWithoutMaterialOneBlackOne) {
    SceneFolder folder;
    const std::string box = R"({"type": "box", "min": [0, 0, 0], "max": [1, 1, 1], )";
    const Scene scene = folder.load(scene_of(box + "\"emission\": [1, 0, 2]}, " + box + "\"emission\": 0}, " +
                                             box + "\"material\": \"white\", \"emission\": 3}"));
    ASSERT_EQ(scene.materials.size(), 3u);
    EXPECT_EQ(std::get<DiffuseMaterial>(scene.materials[2].model).reflectance, vec3(0));
    EXPECT_EQ(scene.shapes[0].material, 2u);
    EXPECT_EQ(scene.shapes[6].material, 2u);
    EXPECT_EQ(scene.shapes[12].material, 1u);
    EXPECT_EQ(scene.shapes[0].emission->radiance, vec3(1, 0, 2));
    EXPECT_FALSE(scene.shapes[6].emission.has_value());  // Switched off.
}

TEST(SceneShapes, HaveASurface) {
    SceneFolder folder;
    const std::string box = R"({"type": "box", "min": [0, 0, 0], "max": [1, 1, 1])";
    folder.expect_error(scene_of("@" + box + "}"),
                        "the shape has neither material nor emission; add one of them");
    folder.expect_error(scene_of(box + ", \"material\": \"white\", \"two_sided\": @true}"),
                        "two_sided says where emission leaves; it needs \"emission\"");
    folder.expect_error(scene_of(box + ", \"emission\": @[1, 2, -3]}"),
                        "\"emission\": expected numbers of at least 0, found [1, 2, -3]");
    folder.expect_error(scene_of(box + ", \"emission\": [1, 2, @1e39]}"),
                        "\"emission\": expected a number of at most 3.4e38 in size, found 1e+39");
    folder.expect_error(scene_of(box + ", \"emission\": 1, \"two_sided\": @1}"),
                        "\"two_sided\": expected true or false, found 1");
    folder.expect_error(scene_of(R"({"type": @"cone", "emission": 1})"),
                        "unknown type \"cone\" (known: quad, box, mesh, sphere, disk, obj, ply, instance)");
    folder.expect_error(scene_of("@3"), "\"shapes\": expected an object { ... }, found 3");
}

// The sphere or disk that is read from its members.
template <class Geometry>
Geometry shape(const std::string& members) {
    SceneFolder folder;
    const Scene scene = folder.load(scene_of("{\"material\": \"white\", " + members + "}"));
    EXPECT_EQ(scene.shapes.size(), 1u);
    EXPECT_EQ(scene.shapes.at(0).material, 1u);
    return std::get<Geometry>(scene.shapes.at(0).geometry);
}

TEST(SceneShapes, ReadSpheres) {
    const auto unit = shape<Sphere>(R"("type": "sphere")");
    EXPECT_EQ(unit.center, dvec3(0));
    EXPECT_EQ(unit.radius, 1.0);
    const auto moved = shape<Sphere>(R"("type": "sphere", "center": [1, 2, 3], "radius": 0.1)");
    EXPECT_EQ(moved.center, dvec3(1, 2, 3));
    EXPECT_EQ(moved.radius, 0.1);
    // A quarter turn about y takes x to -z and z to x; mirrored and doubled, x to 2 z and z to -2 x.
    const auto turned = shape<Sphere>(R"("type": "sphere", "center": [1, 2, 3], "radius": 0.25, "transform":
        [{"rotate": 90, "axis": [0, 1, 0]}, {"scale": -2}, {"translate": [0, 10, 0]}])");
    // The turn's cosine is 6e-17 in doubles; times 3 and 2 that stays far below the tolerance.
    EXPECT_LT(length(turned.center - dvec3(-6, 6, 2)), 1e-6f);
    EXPECT_EQ(turned.radius, 0.5);
    // An emitter, as any other shape may be.
    SceneFolder folder;
    const Scene scene = folder.load(scene_of(R"({"type": "sphere", "emission": 2, "two_sided": true})"));
    EXPECT_EQ(scene.shapes[0].emission->radiance, vec3(2));
    EXPECT_TRUE(scene.shapes[0].emission->two_sided);
}

TEST(SceneShapes, ReadCones) {
    SceneFolder folder;
    const Scene scene =
        folder.load(scene_of(R"({"type": "sphere", "emission": 2, "cone": {"direction": [2, 0, 0],
        "inner_angle": 18, "outer_angle": 36, "falloff": "smoothstep"}, "transform": [{"rotate": 90, "axis": [0, 1, 0]}]},
        {"type": "sphere", "emission": 2, "cone": {"direction": [0, 1, 0]}}, {"type": "sphere", "emission": 2})"));
    // A quarter turn about y takes x to -z.
    EXPECT_LT(length(std::get<Sphere>(scene.shapes[0].geometry).axis - dvec3(0, 0, -2)), 1e-15);
    ASSERT_TRUE(scene.shapes[0].beam.cone.has_value());
    EXPECT_FLOAT_EQ(scene.shapes[0].beam.cone->inner_angle, PI / 10);
    EXPECT_FLOAT_EQ(scene.shapes[0].beam.cone->outer_angle, PI / 5);
    EXPECT_EQ(scene.shapes[0].beam.cone->falloff, SpotFalloff::smoothstep);
    EXPECT_EQ(scene.shapes[1].beam.cone, Cone{});
    EXPECT_EQ(scene.shapes[2].beam, Beam{});

    const auto sphere = [](const std::string& cone) {
        return scene_of(R"({"type": "sphere", "emission": 2, "cone": )" + cone + "}");
    };
    folder.expect_error(
        scene_of(R"({"type": "sphere", "material": "white", "cone": @{"direction": [0, 1, 0]}})"),
        "cone says where emission leaves; it needs \"emission\"");
    folder.expect_error(sphere("@{}"), "the key \"direction\" is missing here; add it");
    folder.expect_error(sphere(R"({"direction": @[0, 0, 0]})"),
                        "\"direction\": expected a direction, not zero, found [0, 0, 0]");
    folder.expect_error(sphere(R"({"direction": [0, 0, 1], "outer_angle": @91})"),
                        "\"outer_angle\": expected an angle above 0 and of at most 90 degrees, found 91");
    folder.expect_error(sphere(R"({"direction": [0, 0, 1], @"angle": 91})"),
                        "unknown key \"angle\" (known: direction, inner_angle, outer_angle, falloff)");
}

TEST(SceneShapes, ReadSpreads) {
    SceneFolder folder;
    const Scene scene =
        folder.load(scene_of(R"({"type": "disk", "normal": [0, 1, 0], "emission": 1, "spread": 60},
        {"type": "disk", "normal": [0, 1, 0], "emission": 1})"));
    EXPECT_FLOAT_EQ(scene.shapes[0].beam.spread, PI / 3);
    EXPECT_EQ(scene.shapes[1].beam.spread, PI);
    const auto disk = [](const std::string& members) {
        return scene_of(R"({"type": "disk", "normal": [0, 1, 0], "material": "white", )" + members + "}");
    };
    folder.expect_error(disk("\"spread\": @60"), "spread says where emission leaves; it needs \"emission\"");
    for (const char* outside : {"0", "-60", "181"}) {
        folder.expect_error(disk("\"emission\": 1, \"spread\": @" + std::string(outside)),
                            "\"spread\": expected a number from 0.01 to 180, found " + std::string(outside));
    }
}

TEST(SceneShapes, CheckSpheres) {
    SceneFolder folder;
    const auto sphere = [](const std::string& members) {
        return scene_of("{\"type\": \"sphere\", \"material\": \"white\", " + members + "}");
    };
    folder.expect_error(sphere("\"radius\": @0"), "\"radius\": expected a number above 0, found 0");
    folder.expect_error(sphere("\"radius\": @-1"), "\"radius\": expected a number above 0, found -1");
    folder.expect_error(sphere("\"radius\": @1e-40"),
                        "\"radius\": expected a number of at least 1.2e-38, found 1e-40");
    folder.expect_error(sphere("\"center\": @[0, 0]"), "\"center\": expected three numbers, found [0, 0]");
    folder.expect_error(
        sphere("@\"centre\": [0, 0, 0]"),
        "unknown key \"centre\" (did you mean \"center\"? known: type, center, radius, "
        "cone, name, material, emission, two_sided, spread, shadow_catcher, visible_to_camera, transform)");
    const std::string uneven =
        "a sphere may only be moved, turned, mirrored and scaled evenly; use a mesh instead";
    folder.expect_error(sphere(R"("transform": @[{"scale": [1, 1, 2]}])"), uneven);
    folder.expect_error(
        sphere(R"("transform": @[{"matrix": [1, 0.5, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}])"), uneven);
    EXPECT_NO_THROW(folder.load(sphere(R"("transform": [{"scale": [1, 1, 2]}, {"scale": [4, 4, 2]}])")));

    const auto marked = [](const std::string& members) {
        return scene_of("@{\"type\": \"sphere\", \"material\": \"white\", " + members + "}");
    };
    const std::string small =
        "the transform makes the sphere too small for 32-bit floats; use greater factors";
    const std::string reach =
        "the shape reaches beyond 1e37 along an axis; check its numbers and its transform";
    folder.expect_error(marked(R"("radius": 1e-20, "transform": [{"scale": 1e-19}])"), small);
    folder.expect_error(marked(R"("transform": [{"scale": 1e30}, {"scale": 1e10}])"), reach);
    folder.expect_error(marked(R"("center": [0, -2e38, 0], "radius": 2e38)"), reach);
    folder.expect_error(marked(R"("transform": [{"translate": [3e38, 0, 0]}, {"translate": [3e38, 0, 0]}])"),
                        reach);
}

TEST(SceneShapes, ReadDisks) {
    const auto disk = shape<Disk>(R"("type": "disk", "center": [1, 2, 3], "normal": [0, 0, 5], "radius": 2)");
    EXPECT_EQ(disk.center, dvec3(1, 2, 3));
    EXPECT_EQ(disk.e1, dvec3(2, 0, 0));
    EXPECT_EQ(disk.e2, dvec3(0, 2, 0));
    const auto unit = shape<Disk>(R"("type": "disk", "normal": [0, -1, 0])");
    EXPECT_EQ(unit.center, dvec3(0));
    EXPECT_EQ(cross(unit.e1, unit.e2), dvec3(0, -1, 0));
    for (const char* normal : {"[1, 2, -2]", "[-3, 0, 4]", "[1, 1, 1]", "[1e-200, 2e-200, 3e-200]",
                               "[-3e38, 1e38, 0]", "[0, 1, 1e-9]"}) {
        const auto tilted = shape<Disk>(R"("type": "disk", "radius": 3, "normal": )" + std::string(normal));
        double x = 0, y = 0, z = 0;
        ASSERT_EQ(std::sscanf(normal, "[%lf, %lf, %lf]", &x, &y, &z), 3);
        const glm::dvec3 n = normalize(glm::dvec3(x, y, z) / std::abs(x + y + z));
        // Some ten roundings of numbers below 10, each by at most 9e-16.
        EXPECT_NEAR(length(tilted.e1), 3.0, 1e-14);
        EXPECT_NEAR(length(tilted.e2), 3.0, 1e-14);
        EXPECT_NEAR(dot(tilted.e1, tilted.e2), 0.0, 1e-14);
        EXPECT_LT(length(cross(tilted.e1, tilted.e2) / 9.0 - n), 1e-14);
    }
}

// An ellipse is the image of the disk's points, and its front the side where other shapes have theirs.
TEST(SceneShapes, TransformDisks) {
    const glm::dvec3 n = glm::dvec3(1, 2, 2) / 3.0;
    for (const glm::dvec3 scale : {glm::dvec3(1, 2, 3), glm::dvec3(-1, 2, 3), glm::dvec3(-1, -2, -3)}) {
        const std::string factors =
            std::to_string(scale.x) + ", " + std::to_string(scale.y) + ", " + std::to_string(scale.z);
        const auto disk =
            shape<Disk>(R"("type": "disk", "center": [1, 1, 1], "normal": [1, 2, 2], "radius": 2,
            "transform": [{"scale": [)" +
                        factors + "]}, {\"translate\": [5, 6, 7]}]");
        // Some ten roundings of numbers below 16, each by at most 9e-16; undoing the scale does not enlarge
        // that.
        constexpr double TOLERANCE = 1e-14;
        for (int i = 0; i < 12; ++i) {
            const double angle = glm::radians(30.0 * i);
            const dvec3 p = disk.center + std::cos(angle) * disk.e1 + std::sin(angle) * disk.e2;
            const glm::dvec3 original = (p - glm::dvec3(5, 6, 7)) / scale - glm::dvec3(1);
            EXPECT_NEAR(length(original), 2.0, TOLERANCE);
            EXPECT_NEAR(dot(original, n), 0.0, TOLERANCE);
        }
        // In front of the disk lies what was in front of it before.
        EXPECT_GT(dot(cross(disk.e1, disk.e2), scale * n), 0.0);
    }
}

TEST(SceneShapes, CheckDisks) {
    SceneFolder folder;
    const auto disk = [](const std::string& members) {
        return scene_of("{\"type\": \"disk\", \"material\": \"white\", " + members + "}");
    };
    folder.expect_error(disk("\"normal\": @[0, 0, 0]"),
                        "\"normal\": expected a direction, not zero, found [0, 0, 0]");
    folder.expect_error(disk("\"normal\": [0, 0, 1], \"radius\": @0"),
                        "\"radius\": expected a number above 0, found 0");
    folder.expect_error(scene_of(R"(@{"type": "disk", "material": "white"})"),
                        "the key \"normal\" is missing here; add it");
    const auto marked = [](const std::string& members) {
        return scene_of("@{\"type\": \"disk\", \"material\": \"white\", \"normal\": [0, 0, 1], " + members +
                        "}");
    };
    const std::string narrow =
        "the transform makes the disk too small or too narrow for 32-bit floats; use greater factors";
    folder.expect_error(marked(R"("transform": [{"scale": [1, 1e-8, 1]}])"), narrow);
    folder.expect_error(marked(R"("radius": 1e-20, "transform": [{"scale": 1e-20}])"), narrow);
    // Sheared until both radii nearly coincide.
    folder.expect_error(
        marked(R"("transform": [{"matrix": [1, 1e8, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}])"), narrow);
    const std::string reach =
        "the shape reaches beyond 1e37 along an axis; check its numbers and its transform";
    folder.expect_error(marked(R"("center": [3e38, 0, 0], "radius": 1e38)"), reach);
    folder.expect_error(marked(R"("transform": [{"scale": 1e30}, {"scale": 1e10}])"), reach);
    EXPECT_NO_THROW(folder.load(scene_of(R"({"type": "disk", "normal": [0, 0, 1], "center": [9e36, 0, 0],
        "radius": 9e35, "emission": 1})")));
}

TEST(SceneShapes, ReachNoFurtherThanBoxesCan) {
    SceneFolder folder;
    folder.expect_error(scene_of(R"({"type": "quad", "material": "white",
                                     "vertices": [[0, 0, 0], [1, 0, 0], @[1, 2e37, 0], [0, 2e37, 0]]})"),
                        "the shape reaches beyond 1e37 along an axis; check its numbers and its transform");
}

TEST(SceneShapes, FilesHaveNamesThatASystemTakes) {
    SceneFolder folder;
    const std::string cause = "a file name cannot hold the character U+0000; remove it";
    for (const char* type : {"obj", "ply"}) {
        folder.expect_error(
            scene_of(std::string(R"({"type": ")") + type + R"(", "file": @"a\u0000b", "material": "white"})"),
            cause);
    }
}

}  // namespace
}  // namespace candela
