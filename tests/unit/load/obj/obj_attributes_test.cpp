// What vertices of OBJ files have besides positions and normals: texture coordinates and colours.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "load/obj/obj.h"
#include "unit/base/damage.h"
#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

const std::string CORNERS = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string UVS = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

class ObjAttributes : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& text) {
        folder_.write("m.obj", text);
        return folder_.path() / "m.obj";
    }

    TriangleMesh load(const std::string& text, MeshNormals normals = MeshNormals::file) {
        warnings_.clear();
        return load_obj(write(text), normals, reach_, warnings_);
    }

    std::vector<ObjPart> parts(const std::string& text) {
        return load_obj_parts(write(text), MeshNormals::file, reach_).parts;
    }

    void expect_error(const std::string& text, const std::string& message) {
        SCOPED_TRACE(text);
        EXPECT_EQ(folder_.without_folder(error_of([&] { load(text); })), message);
    }

    // The values at the corners of a triangle, by `array`.
    template <class Value>
    static std::vector<Value> corners(const TriangleMesh& mesh, std::vector<Value> TriangleMesh::*array,
                                      size_t triangle = 0) {
        const uvec3 t = mesh.triangles.at(triangle);
        return {(mesh.*array).at(t.x), (mesh.*array).at(t.y), (mesh.*array).at(t.z)};
    }

    // Checks the warnings of a file.
    void expect_warnings(const std::string& text, const std::vector<std::string>& expected) {
        SCOPED_TRACE(text);
        load(text);
        ASSERT_EQ(warnings_.size(), expected.size());
        for (size_t i = 0; i < expected.size(); ++i)
            EXPECT_EQ(folder_.without_folder(warnings_[i]), expected[i]);
    }

    SceneFolder folder_;
    std::vector<std::string> warnings_;
    FileReach reach_{folder_.path() / "m.obj"};
};

TEST_F(ObjAttributes, TextureCoordinatesKeepTheDirectionOfTheFile) {
    const TriangleMesh mesh = load(CORNERS + UVS + "f 1/1 2/2 3/3\nf -4/-4 -2/-2 -1/-1\n");
    EXPECT_EQ(corners(mesh, &TriangleMesh::uv0), (std::vector<vec2>{vec2(0, 0), vec2(1, 0), vec2(1, 1)}));
    EXPECT_EQ(corners(mesh, &TriangleMesh::uv0, 1), (std::vector<vec2>{vec2(0, 0), vec2(1, 1), vec2(0, 1)}));
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_TRUE(mesh.uv1.empty());
}

TEST_F(ObjAttributes, TextureCoordinatesHaveOneToThreeNumbers) {
    const TriangleMesh mesh = load(CORNERS + "vt .25\nvt -1e30 +1e30 5 6\nvt 0.5 # 7\nf 1/1 2/2 3/3\n");
    EXPECT_EQ(corners(mesh, &TriangleMesh::uv0),
              (std::vector<vec2>{vec2(0.25f, 0), vec2(-1e30f, 1e30f), vec2(0.5f, 0)}));
}

TEST_F(ObjAttributes, VerticesAreSplitAtSeams) {
    const std::string square = CORNERS + UVS + "vn 0 0 1\nvn 1 0 1\n";
    // The corners of both triangles differ in their second texture coordinates at one position of two.
    const std::string seam = "f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/4/1 4/4/1\n";
    EXPECT_EQ(load(square + seam).positions.size(), 5u);
    EXPECT_EQ(load(square + seam + "f 1/1/2 2/2/1 3/3/1\n").positions.size(), 6u);
    EXPECT_EQ(load(square + seam + "f 1/1/2 2/2/1 3/3/1\n", MeshNormals::flat).positions.size(), 5u);
    // Equal numbers under other indices are not searched for.
    EXPECT_EQ(load(square + "vt 1 1\nf 1/1 2/2 3/3\nf 1/1 3/5 4/4\n").positions.size(), 5u);
    const TriangleMesh smooth = load(square + seam, MeshNormals::smooth);
    EXPECT_EQ(smooth.normals, std::vector<vec3>(5, vec3(0, 0, 1)));
    EXPECT_EQ(smooth.uv0.size(), 5u);
}

TEST_F(ObjAttributes, CornersWithoutTextureCoordinatesHaveZeros) {
    const TriangleMesh mesh = load(CORNERS + UVS + "f 1/2 2/2 3/3\nf 1 3//1 4/4\nvn 0 0 1\n");
    EXPECT_EQ(corners(mesh, &TriangleMesh::uv0, 1), (std::vector<vec2>{vec2(0), vec2(0), vec2(0, 1)}));
    EXPECT_EQ(mesh.positions.size(), 6u);
}

TEST_F(ObjAttributes, AMeshWithoutTextureCoordinatesHasNone) {
    EXPECT_TRUE(load(CORNERS + UVS + "f 1 2 3\n").uv0.empty());
    EXPECT_TRUE(load(CORNERS + "f 1 2 3\n").uv0.empty());
    const std::vector<ObjPart> some = parts(CORNERS + UVS +
                                            "usemtl a\nf 1 2 3 4\nusemtl b\nf 1/1 2/2 3/3\nf 1 3 4\n"
                                            "usemtl c\nf 1 2 3\nf 1 3 4/1\nusemtl a\nf 1 2 3\n");
    ASSERT_EQ(some.size(), 3u);
    EXPECT_TRUE(some[0].mesh.uv0.empty());
    EXPECT_EQ(some[1].mesh.uv0.size(), some[1].mesh.positions.size());
    EXPECT_EQ(some[2].mesh.uv0.size(), some[2].mesh.positions.size());
    EXPECT_EQ(corners(some[1].mesh, &TriangleMesh::uv0),
              (std::vector<vec2>{vec2(0, 0), vec2(1, 0), vec2(1, 1)}));
    EXPECT_EQ(corners(some[1].mesh, &TriangleMesh::uv0, 1), std::vector<vec2>(3, vec2(0)));
}

TEST_F(ObjAttributes, RefusesTextureCoordinatesThatAreNoNumbers) {
    const std::string faces = "\nf 1/1 2/1 3/1\n";
    expect_error(CORNERS + "vt" + faces,
                 "m.obj:5: a texture coordinate needs one to three numbers; is the file cut off?");
    for (const std::string word : {"0,5", "x"}) {
        const std::string cause = "m.obj:5: a texture coordinate needs numbers, found \"" + word + '"';
        expect_error(CORNERS + "vt " + word + " 0" + faces, cause);
        expect_error(CORNERS + "vt 0 " + word + faces, cause);
    }
}

TEST_F(ObjAttributes, TextureCoordinatesThatAreNotFiniteAreZero) {
    const std::string faces = "\nf 1/1 2/1 3/1\n";
    for (const std::string word : {"nan", "-nan(ind)", "inf", "1.1e30", "-1.1e30", "1e39", "-1.#IND"}) {
        expect_warnings(CORNERS + "vt " + word + " 0.5" + faces,
                        {"m.obj:5: a texture coordinate is not from -1e30 to 1e30; 0 is used"});
        EXPECT_EQ(load(CORNERS + "vt " + word + " 0.5" + faces).uv0[0], vec2(0, 0.5f));
    }
    EXPECT_TRUE((load(CORNERS + "vt 0 0 nan" + faces), warnings_.empty()));
}

// What a file lacks is not looked up.
TEST_F(ObjAttributes, CornersMayNameWhatTheFileLacks) {
    for (const char* index : {"0", "3", "-3", "9999999999"}) {
        const std::string i = index;
        expect_warnings(
            CORNERS + "vt 1 1\nvt 0.5 1\nf 1/" + i + " 2/1 3/2\nf 1/" + i + " 3/1 4/2\n",
            {"m.obj:7: a corner has texture coordinates that the file lacks; (0, 0) is used (2 times)"});
        EXPECT_EQ(load(CORNERS + "vt 1 1\nvt 0.5 1\nf 1/" + i + " 2/1 3/2\n").uv0,
                  (std::vector<vec2>{vec2(0), vec2(1), vec2(0.5f, 1)}));
        const std::string normals = CORNERS + "vn 1 0 1\nvn 0 1 1\nf 1//" + i + " 2//1 3//2\n";
        expect_warnings(normals,
                        {"m.obj:7: a corner has a normal that the file lacks; the triangle's is used"});
        EXPECT_EQ(load(normals).normals, (std::vector<vec3>{vec3(0), vec3(1, 0, 1), vec3(0, 1, 1)}));
    }
    EXPECT_TRUE(load(CORNERS + "f 1/1 2/2 3/3\n").uv0.empty());
}

// The code 0.5 of sRGB is a light of ((0.5 + 0.055) / 1.055)^2.4.
const float HALF = std::pow(0.555f / 1.055f, 2.4f);

TEST_F(ObjAttributes, ColoursFollowPositions) {
    const TriangleMesh mesh =
        load("v 0 0 0 1 0.5 0\nv 1 0 0 0 1 1 0.5\nv 1 1 0 0.5\nv 0 1 0 # 1 0 0\nf 1 2 3\nf 1 3 4\n");
    EXPECT_EQ(corners(mesh, &TriangleMesh::colors),
              (std::vector<vec4>{vec4(1, HALF, 0, 1), vec4(0, 1, 1, 1), vec4(1)}));
    EXPECT_EQ(corners(mesh, &TriangleMesh::colors, 1)[2], vec4(1));
    EXPECT_TRUE(load(CORNERS + "f 1 2 3\n").colors.empty());
    EXPECT_TRUE(load("v 0 0 0 1\nv 1 0 0 1 1\nv 1 1 0 1 #1 1\nf 1 2 3\n").colors.empty());
}

TEST_F(ObjAttributes, ColoursMayBeBytes) {
    const std::string text = "v 0 0 0 255 0 0\nv 1 0 0\nv 1 1 0 0 51 1\nf 1 2 3\n";
    const float fifth = std::pow(0.255f / 1.055f, 2.4f);  // The code 0.2.
    const std::vector<vec4> colors = corners(load(text), &TriangleMesh::colors);
    EXPECT_EQ(colors[0], vec4(1, 0, 0, 1));
    EXPECT_EQ(colors[1], vec4(1));
    EXPECT_FLOAT_EQ(colors[2].y, fifth);
    EXPECT_FLOAT_EQ(colors[2].z, 1.0f / 255.0f / 12.92f);
    expect_warnings(text, {"m.obj: the colours of vertices are read as numbers from 0 to 255"});
}

TEST_F(ObjAttributes, NumbersThatCannotBeColoursAreLeftOut) {
    for (const char* word : {"-0.5", "1.5", "256", "-1"}) {
        const std::string text =
            "v 0 0 0 0 " + std::string(word) + " 0\nv 1 0 0 0.25 0 0\nv 1 1 0\nf 1 2 3\n";
        EXPECT_TRUE(load(text).colors.empty());
        ASSERT_EQ(warnings_.size(), 1u);
        EXPECT_EQ(folder_.without_folder(warnings_[0]),
                  "m.obj: left out the numbers after positions, from " +
                      std::string(word[0] == '-' ? word : "0") + " to " + (word[0] == '-' ? "0.25" : word) +
                      ": colours would be from 0 to 1, or whole numbers from 0 to 255");
    }
    const std::string rounded = "v 0 0 0 1.0000001 -1e-7 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
    EXPECT_EQ(load(rounded).colors[0], vec4(1, 0, 0, 1));
    EXPECT_TRUE(warnings_.empty());
    expect_warnings("v 0 0 0 nan 1 1\nv 1 0 0 0 0 0\nv 1 1 0\nf 1 2 3\n",
                    {"m.obj:1: the colour of a vertex is not finite; white is used"});
    EXPECT_EQ(load("v 0 0 0 nan 1 1\nv 1 0 0 0 0 0\nv 1 1 0\nf 1 2 3\n").colors[0], vec4(1));
    expect_error("v 0 0 0 0 red 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                 "m.obj:1: the colour of a vertex needs three numbers, found \"red\"");
}

// ZBrush writes colours after the positions: mask, red, green and blue.
TEST_F(ObjAttributes, ColoursMayBeInComments) {
    const std::string text = "#MRGB ffff0000ff00ff00\n#MRGB 00ffffff\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
    EXPECT_EQ(corners(load(text), &TriangleMesh::colors),
              (std::vector<vec4>{vec4(1, 0, 0, 1), vec4(0, 1, 0, 1), vec4(1)}));
    EXPECT_TRUE(warnings_.empty());
    expect_warnings("v 0 0 0\nv 1 0 0\nv 1 1 0\n#MRGB ffffffffffffffff\nf 1 2 3\n",
                    {"m.obj: left out the colours (#MRGB): 2 for 3 vertices"});
    EXPECT_TRUE(load(CORNERS + "#MRGB xyz\nf 1 2 3\n").colors.empty());
}

TEST_F(ObjAttributes, PositionsBeforeTheFirstColourAreWhite) {
    const TriangleMesh mesh = load("v 0 0 0\nv 1 0 0\nv 1 1 0 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
    EXPECT_EQ(corners(mesh, &TriangleMesh::colors), (std::vector<vec4>{vec4(1), vec4(1), vec4(1, 0, 0, 1)}));
    EXPECT_EQ(corners(mesh, &TriangleMesh::colors, 1)[2], vec4(1));
}

TEST_F(ObjAttributes, PartsAndSeamsKeepColours) {
    const std::string text = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 0 0 0\n" + UVS +
                             "usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 3/4 4/4\n";
    EXPECT_EQ(corners(parts(text).at(1).mesh, &TriangleMesh::colors),
              (std::vector<vec4>{vec4(1, 0, 0, 1), vec4(0, 0, 1, 1), vec4(0, 0, 0, 1)}));
    EXPECT_EQ(load(text).colors.size(), 5u);
}

TEST_F(ObjAttributes, LoadOrAreRefusedAfterAnyChangeOfAByte) {
    const std::string good =
        "v 0 0 0 1 0 0\nv 1 0 0 0 1 .5\nv 0 1 0\nvt 0 1\nvt .5\nusemtl a\nf 1/1 2/2 3/1\nusemtl b\nf 1 2/1 "
        "3\n";
    const std::string likely = "vnftu#\\/-.e0123 \n\r";
    const size_t refused = count_refused(good, likely, 1000, [&](const std::string& text) {
        for (const ObjPart& part : parts(text)) {
            const size_t vertices = part.mesh.positions.size();
            EXPECT_TRUE(part.mesh.uv0.empty() || part.mesh.uv0.size() == vertices);
            EXPECT_TRUE(part.mesh.colors.empty() || part.mesh.colors.size() == vertices);
        }
    });
    EXPECT_GT(refused, 300u);
    EXPECT_LT(refused, 1000u);
}

}  // namespace
}  // namespace candela
