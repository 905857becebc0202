// OBJ files: what is read, and what is refused, with which message.
#include "load/obj/obj.h"

#include <array>
#include <clocale>
#include <cmath>

#include <gtest/gtest.h>

#include "base/text.h"
#include "scene/geometry.h"
#include "scene/polygon.h"
#include "unit/base/damage.h"
#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

constexpr const char* TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

class Obj : public testing::Test {
  protected:
    TriangleMesh load(const std::string& text, MeshNormals normals = MeshNormals::file) {
        return world_mesh(load_scene(text, normals));
    }

    // Loads a scene that uses the file, and checks the message after the place in the scene.
    void expect_error(const std::string& text, const std::string& message) {
        SCOPED_TRACE(text);
        folder_.write("m.obj", text);
        folder_.expect_error(scene_of(R"({"type": "obj", "file": @"m.obj", "material": "white"})"), message);
    }

    Scene load_scene(const std::string& text, MeshNormals normals = MeshNormals::file) {
        folder_.write("m.obj", text);
        const char* name = normals == MeshNormals::file   ? "file"
                           : normals == MeshNormals::flat ? "flat"
                                                          : "smooth";
        return folder_.load(scene_of(R"({"type": "obj", "file": "m.obj", "material": "white", "normals": ")" +
                                     std::string(name) + "\"}"));
    }

    // Checks the warnings of a file after the place in the scene; the last says that there is no light.
    void expect_warnings(const std::string& text, const std::vector<std::string>& expected) {
        SCOPED_TRACE(text);
        const std::vector<std::string> warnings = load_scene(text).warnings;
        ASSERT_EQ(warnings.size(), expected.size() + 1);
        for (size_t i = 0; i < expected.size(); ++i)
            EXPECT_EQ(folder_.without_folder(warnings[i]), "scene.json:3:36: " + expected[i]);
    }

    SceneFolder folder_;
};

TEST_F(Obj, ReadsAllWaysToWriteACorner) {
    const TriangleMesh mesh =
        load(std::string("# comment\r\nmtllib no.mtl\nusemtl red\ng a b\no c\ns 1\n") + TRIANGLE +
             "vt 0 0\nvn 0 0 2\n\n  f 1 2 3\nf\t-3 -2 -1\nf 1/1 2/1 3/1\nf 1//1 2//1 3//-1 \n"
             "f 1/1/1 2/1/1 3/-1/1\nv 5 5 5\nf 1 2 4\rf 5 2 3\nv 0 0 -1");
    EXPECT_EQ(mesh.triangles.size(), 7u);
    EXPECT_EQ(mesh.positions[mesh.triangles[5].z], vec3(5));
    EXPECT_EQ(mesh.positions[mesh.triangles[6].x], vec3(0, 0, -1));  // Vertices may be defined later.
}

TEST_F(Obj, SharesVerticesOfEqualPositionAndNormal) {
    const std::string square = std::string(TRIANGLE) + "v 1 1 0\nv 9 9 9\nvn 0 0 3\nvn 0.1 0 1\n";
    const TriangleMesh smooth = load(square + "f 1//1 2//1 3//1\nf 2//1 4//1 3//1");
    EXPECT_EQ(smooth.positions.size(), 4u);  // The unused one is dropped.
    EXPECT_EQ(smooth.normals, std::vector<vec3>(4, vec3(0, 0, 1)));
    const TriangleMesh creased = load(square + "f 1//1 2//1 3//1\nf 2//2 4//2 3//2");
    EXPECT_EQ(creased.positions.size(), 6u);
    const TriangleMesh flat = load(square + "f 1//1 2//1 3//1\nf 2//2 4//2 3//2", MeshNormals::flat);
    EXPECT_EQ(flat.positions.size(), 4u);
    EXPECT_TRUE(flat.normals.empty());
}

TEST_F(Obj, GivesCornersWithoutNormalThatOfTheirTriangle) {
    const TriangleMesh mesh = load(std::string(TRIANGLE) + "vn 1 0 1\nvn 0 0 0\nf 1//1 2//2 3");
    const uvec3 t = mesh.triangles[0];
    EXPECT_NEAR(mesh.normals[t.x].x, std::sqrt(0.5f), 1e-6f);
    EXPECT_EQ(mesh.normals[t.y], vec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[t.z], vec3(0, 0, 1));
    EXPECT_TRUE(load(std::string(TRIANGLE) + "vn 0 0 0\nf 1//1 2//1 3//1").normals.empty());
    EXPECT_TRUE(load(std::string(TRIANGLE) + "f 1 2 3").normals.empty());
}

// A cube's corner touches three or five triangles; weights by angle still make all normals diagonals.
TEST_F(Obj, SmoothsNormalsByAngleOverEqualPositions) {
    std::string cube;
    for (int copy = 0; copy < 2; ++copy) {  // Each corner is in the file twice, as at a texture seam.
        for (int i = 0; i < 8; ++i) {
            cube += std::string("v ") + (i & 1 ? "1 " : "-1 ") + (i & 2 ? "1 " : "-1 ") +
                    (i & 4 ? "1\n" : "-1\n");
        }
    }
    cube += "f 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 11 15 16 12\nf 9 11 12 10\nf 13 14 16 15\n";
    const TriangleMesh mesh = load(cube, MeshNormals::smooth);
    ASSERT_EQ(mesh.triangles.size(), 12u);
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_NEAR(length(mesh.normals[i] - normalize(mesh.positions[i])), 0.0f, 1e-6f);
    }
}

TEST_F(Obj, SmoothNormalsThatCancelAreFlat) {
    const TriangleMesh mesh = load(std::string(TRIANGLE) + "f 1 2 3\nf 1 3 2", MeshNormals::smooth);
    EXPECT_TRUE(mesh.normals.empty());
}

// An arrow head (twice) and the letter U, in each coordinate plane, near and far, large and tiny, both
// windings.
TEST_F(Obj, CutsConcavePolygons) {
    const std::vector<vec2> points{vec2(0, 0), vec2(2, 1), vec2(4, 0), vec2(2, 2), vec2(0, 0),
                                   vec2(1, 0), vec2(3, 0), vec2(3, 2), vec2(2, 2), vec2(2, 1),
                                   vec2(1, 1), vec2(1, 2), vec2(0, 2)};
    const auto expect_area = [&](float offset, float scale, glm::length_t axis, bool backwards) {
        std::string text;
        for (const vec2 point : points) {
            vec3 v(0);
            v[axis] = (point.x + offset) * scale;
            v[(axis + 1) % 3] = (point.y + offset) * scale;
            text += "v " + std::to_string(v.x) + ' ' + std::to_string(v.y) + ' ' + std::to_string(v.z) + '\n';
        }
        text += backwards ? "f 4 3 2 1\nf 2 1 4 3\nf 13 12 11 10 9 8 7 6 5"
                          : "f 1 2 3 4\nf 2 3 4 1\nf 5 6 7 8 9 10 11 12 13";
        const TriangleMesh mesh = load_scene(text).meshes.at(0);  // As it was cut, before it is placed.
        EXPECT_EQ(mesh.triangles.size(), 11u);
        double area = 0.0;
        for (const uvec3 t : mesh.triangles) {
            const glm::dvec3 p(mesh.positions[t.x]);
            const glm::dvec3 n =
                cross(glm::dvec3(mesh.positions[t.y]) - p, glm::dvec3(mesh.positions[t.z]) - p);
            const double twice = (backwards ? -1.0 : 1.0) * n[(axis + 2) % 3] / (scale * scale);
            EXPECT_GT(twice, 0.0);
            area += 0.5 * twice;
        }
        EXPECT_NEAR(area, 2.0 + 2.0 + 5.0, 0.1);
    };
    for (const float offset : {0.0f, 100.0f, -100.0f}) {
        for (const float scale : {1.0f, 1e-3f}) {
            for (glm::length_t axis = 0; axis < 3; ++axis) {
                expect_area(offset, scale, axis, false);
                expect_area(offset, scale, axis, true);
            }
        }
    }
}

TEST_F(Obj, IgnoresTheLocale) {
    const std::string before = std::setlocale(LC_ALL, nullptr);
    for (const char* name : {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8"}) {
        if (std::setlocale(LC_ALL, name) != nullptr) break;
    }
    const TriangleMesh mesh = load("v 0.5 0 0\nv 1.5 0 0\nv 0.5 1e-1 0\nf 1 2 3");
    std::setlocale(LC_ALL, before.c_str());
    EXPECT_EQ(mesh.positions[0], vec3(0.5f, 0, 0));
    EXPECT_EQ(mesh.positions[2], vec3(0.5f, 0.1f, 0));
}

TEST_F(Obj, RefusesIndicesOutOfRange) {
    const std::string text = TRIANGLE;
    expect_error(text + "f 1 2 3\nf 1 2 99", "m.obj:5: face 2 uses vertex 99, but the file has 3 vertices");
    expect_error(text + "f 1 2 -4", "m.obj:4: face 1 uses vertex -4, but only 3 vertices come before it");
    expect_error(text + "f 1 2 0",
                 "m.obj:4: face 1 uses vertex 0; indices count from 1, or backwards from -1");
    expect_error(text + "f 1 2 3000000000",
                 "m.obj:4: face 1 uses vertex 3000000000, but the file has 3 vertices");
}

TEST_F(Obj, RefusesMalformedFaces) {
    const std::string text = TRIANGLE;
    const auto malformed = [](const std::string& corner) {
        return "m.obj:4: face 1 has the malformed corner \"" + corner + "\"; write 1, 1/2, 1//3 or 1/2/3";
    };
    for (const char* corner : {"x", "/1", "//1", "1/1/1/1", "1/x", "1.5", "99999999999999999999"}) {
        expect_error(text + "vt 0 0\nvn 0 0 1\nf " + corner + " 2 3",
                     "m.obj:6" + malformed(corner).substr(std::string("m.obj:4").size()));
    }
    std::string many = "f";
    for (int i = 0; i < 1025; ++i)
        many += " 1";
    expect_error(text + many,
                 "m.obj:4: face 1 has 1025 corners, but at most 1024 are read; cut it into triangles");
}

TEST_F(Obj, RefusesWhatIsNoNumber) {
    for (const std::string word : {"1,5", "0x10", "1.5m", "--1", "\"\xFF\""}) {
        const std::string shown = word == "\"\xFF\"" ? "\\\"\\xff\\\"" : word;
        expect_error("v 0 0 0\nv 1 " + word + " 0\nv 0 1 0\nf 1 2 3",
                     "m.obj:2: a vertex needs three numbers, found \"" + shown + "\"");
    }
    const std::string digits(400, '1');
    expect_error("v 0 0 " + digits + "\nv 1 0 0\nv 0 1 0\nf 1 2 3",
                 "m.obj:1: a vertex needs three numbers, found \"" + digits.substr(0, 78) + "…" +
                     digits.substr(0, 39) + "\"");
    EXPECT_EQ(load("v 0 0 " + digits + "e-400\nv 1 0 0\nv 0 1 0\nf 1 2 3").positions[0].z, 1.0f / 9.0f);
    expect_error(std::string(TRIANGLE) + "vn 0 x 1\nf 1//1 2//1 3//1",
                 "m.obj:4: a normal needs three numbers, found \"x\"");
    EXPECT_NO_THROW(load("v +0.5 .5 1.\nv 1E+2 -1e-3 0 1 0.5 0.5 0.5\nv 0 1 0 1\nf 1 2 3"));
}

// The forms that Windows' and other libraries write, and a number that floats cannot hold.
constexpr std::array<const char*, 7> NOT_FINITE{"nan",     "-nan(ind)", "inf", "-Infinity",
                                                "1.#QNAN", "-1.#IND00", "1e39"};

TEST_F(Obj, LeavesOutFacesThatAreNotFinite) {
    for (const std::string word : NOT_FINITE) {
        const std::string text = std::string(TRIANGLE) + "v 0 " + word + " 0\n";
        expect_warnings(text + "f 1 2 3", {});
        const std::string used = text + "vt 0 1\nvt 1 1\nf 1 2 4\nf 1/1 2/1 3/2\nf 3/2 1 5/2\nv inf 0 0";
        expect_warnings(used, {"m.obj: a face with a vertex that is not finite is left out (2 times)"});
        const TriangleMesh mesh = load(used);
        EXPECT_EQ(mesh.positions, (std::vector<vec3>{vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)}));
        EXPECT_EQ(mesh.uv0, (std::vector<vec2>{vec2(0, 1), vec2(0, 1), vec2(1)}));
    }
    expect_error(
        "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3",
        "m.obj: each face has fewer than three corners, or a vertex that is not finite; export the file "
        "again");
}

TEST_F(Obj, TakesTheNormalsOfTrianglesWhereTheirsAreNotFinite) {
    for (const std::string word : NOT_FINITE) {
        const std::string text = concat(TRIANGLE, "vn 0 ", word, " 1\nvn 1 0 1\nf 1//1 2//1 3//2");
        expect_warnings(text, {"m.obj:4: a normal is not finite; the triangle's is used"});
        const TriangleMesh mesh = load(text);
        EXPECT_EQ(mesh.normals[mesh.triangles[0].x], vec3(0, 0, 1));
        EXPECT_NEAR(mesh.normals[mesh.triangles[0].z].x, std::sqrt(0.5f),
                    1e-6f);  // Rounding of unit vectors.
    }
}

TEST_F(Obj, LeavesOutWhatHasNoSurface) {
    const std::string text = TRIANGLE;
    expect_warnings(text + "f 1 2\nf 1 2 3\nf\nf 3 # 2 1\n",
                    {"m.obj:4: a face with fewer than three corners is left out (3 times)"});
    EXPECT_EQ(load(text + "vt 0 0\nf 1/1 2/1\nf 1/1 2 3\n").triangles.size(), 1u);
    expect_warnings(text + "f 1 2 3\nl 1 2\np 1\nl 2 3 1\n",
                    {"m.obj:5: lines and points have no surface, and are left out (3 times)"});
    expect_warnings(text + "vp 0 1\ncstype bezier\ndeg 2\ncurv 0 1 1 2 3\nparm u 0 1\nend\nf 1 2 3\n",
                    {"m.obj:7: curves and surfaces are left out; export the model as a mesh"});
    expect_error(
        text + "f 1 2",
        "m.obj: each face has fewer than three corners, or a vertex that is not finite; export the file "
        "again");
}

// Rhino continues lines; Wings 3D and others write empty indices; other programs write comments anywhere.
TEST_F(Obj, ReadsTheFormsOfManyPrograms) {
    const std::string text = TRIANGLE;
    for (const char* face : {"f 1 \\\n2 \\\r\n3", "f 1 2 3 \\", "f 1/ 2/ 3/", "f 1// 2// 3//",
                             "f 1 2 3 # front", "f 1 2 3 #front", "fo 1 2 3", "f 1 2 \\  \n 3"}) {
        SCOPED_TRACE(face);
        EXPECT_EQ(load(text + face).triangles.size(), 1u);
        expect_warnings(text + face, {});
    }
    EXPECT_EQ(load(text + "vn 0 \\\n0 \\\n1\nf 1//1 2//1 3//1").normals[0], vec3(0, 0, 1));
    EXPECT_EQ(load("\xEF\xBB\xBFv 0 0 0 \\\n# a\nv 1 0 0\nv 0 1 0\nf 1 2 3").positions.size(), 3u);
    EXPECT_EQ(load("# C:\\models\\\nv 0 0 0\nv 1 0 0\nv 0 1 0\ng C:\\a\\\nf 1 2 3").triangles.size(), 1u);
    expect_error("v 0 0 0\nv 1 0 \\\n0\nv 0 1 0\n\nf 1 2 \\\n3 x",
                 "m.obj:6: face 1 has the malformed corner \"x\"; write 1, 1/2, 1//3 or 1/2/3");
}

TEST_F(Obj, RefusesTruncatedFiles) {
    expect_error("v 0 0 0\r\nv 1 0", "m.obj:2: a vertex needs three numbers; is the file cut off?");
    expect_error(std::string(TRIANGLE) + "vn 0",
                 "m.obj:4: a normal needs three numbers; is the file cut off?");
}

TEST_F(Obj, RefusesFilesWithoutFaces) {
    const std::string no_faces =
        "m.obj: the file has no faces (lines \"f 1 2 3\"); is it a Wavefront OBJ file?";
    expect_error("", no_faces);
    expect_error(TRIANGLE, no_faces);
    expect_error(std::string("\177ELF\0\1\2\n\n\xFF\xFE", 11), no_faces);
    folder_.write("m.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3");
    folder_.expect_error(scene_of(R"(@{"type": "obj", "file": "m.obj", "material": "white"})"),
                         "the mesh has no triangle with an area; check its positions");
}

TEST_F(Obj, RefusesFilesThatCannotBeRead) {
    folder_.expect_error(scene_of(R"({"type": "obj", "file": @"no.obj", "material": "white"})"),
                         "cannot read \"no.obj\": the file does not exist; check the name");
    folder_.expect_error(scene_of(R"({"type": "obj", "file": @".", "material": "white"})"),
                         "cannot read \".\": it is a directory; give the name of a file in it");
    folder_.write("m.obj", std::string(TRIANGLE) + "f 1 2 3");
    folder_.expect_error(
        scene_of(R"({"type": "obj", "file": "m.obj", "material": "white", "normals": @"smoth"})"),
        "unknown normals \"smoth\" (did you mean \"smooth\"? known: file, smooth, flat)");
    folder_.expect_error(
        scene_of(
            R"(@{"type": "obj", "file": "m.obj", "material": "white", "transform": [{"scale": 3e38}, {"scale": 2}]})"),
        "the shape reaches beyond 1e37 along an axis; check its numbers and its transform");
}

TEST_F(Obj, LoadsOrIsRefusedAfterAnyChangeOfAByte) {
    const std::string good =
        std::string(TRIANGLE) + "v 1 1 0\nvt 0 1\nvn 0 0 1\ng a\nf 1/1/1 2/1/1 4/1/1 3/1/1\nf -4 -3 -2\n";
    const std::string likely = "vnftlpo#\\/-.e0123 \n\r";
    const size_t refused = count_refused(good, likely, 1000, [&](const std::string& text) { load(text); });
    EXPECT_GT(refused, 300u);
    EXPECT_LT(refused, 1000u);
}

// A frame: a square whose hole is reached through a slit, so that two corners occur twice.
TEST(Polygon, MayHaveASlit) {
    const std::vector<vec3> frame{vec3(0, 0, 0), vec3(4, 0, 0), vec3(4, 4, 0), vec3(0, 4, 0), vec3(0, 0, 0),
                                  vec3(1, 1, 0), vec3(1, 3, 0), vec3(3, 3, 0), vec3(3, 1, 0), vec3(1, 1, 0)};
    float area = 0.0f;
    for (const uvec3 t : triangulate(frame)) {
        const float twice = cross(frame[t.y] - frame[t.x], frame[t.z] - frame[t.x]).z;
        EXPECT_GE(twice, 0.0f);
        area += 0.5f * twice;
    }
    EXPECT_FLOAT_EQ(area, 12.0f);
}

TEST(Polygon, IsCutSomehowIfItCrossesItself) {
    const std::vector<vec3> bow{vec3(0), vec3(1, 1, 0), vec3(1, 0, 0), vec3(0, 1, 0)};
    EXPECT_EQ(triangulate(bow).size(), 2u);
    EXPECT_EQ(triangulate(std::vector<vec3>(6, vec3(1))).size(), 4u);
}

}  // namespace
}  // namespace candela
