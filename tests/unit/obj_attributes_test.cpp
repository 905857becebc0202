// What vertices of OBJ files have besides positions and normals: texture coordinates and colours.
#include <algorithm>

#include <gtest/gtest.h>

#include "damage.h"
#include "load/obj/obj.h"
#include "scene_fixture.h"

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
        return load_obj(write(text), normals, reach_);
    }

    std::vector<ObjPart> parts(const std::string& text) {
        return load_obj_parts(write(text), MeshNormals::file, reach_).parts;
    }

    void expect_error(const std::string& text, const std::string& message) {
        SCOPED_TRACE(text);
        EXPECT_EQ(folder_.without_folder(error_of([&] { load(text); })), message);
    }

    // Of the corners of a triangle, by `array`.
    template <class Value>
    static std::vector<Value> corners(const TriangleMesh& mesh, std::vector<Value> TriangleMesh::*array,
                                      size_t triangle = 0) {
        const uvec3 t = mesh.triangles.at(triangle);
        return {(mesh.*array).at(t.x), (mesh.*array).at(t.y), (mesh.*array).at(t.z)};
    }

    SceneFolder folder_;
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
    // Equal numbers under other indices are no reason to look further.
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
    for (const std::string word : {"nan", "inf", "-inf", "1.1e30", "-1.1e30", "1e39", "0,5", "x"}) {
        const std::string cause =
            "m.obj:5: a texture coordinate needs finite numbers from -1e30 to 1e30, found \"" + word + '"';
        expect_error(CORNERS + "vt " + word + " 0" + faces, cause);
        expect_error(CORNERS + "vt 0 " + word + faces, cause);
    }
    EXPECT_NO_THROW(load(CORNERS + "vt 0 0 nan" + faces));
}

TEST_F(ObjAttributes, ColoursFollowPositions) {
    const TriangleMesh mesh =
        load("v 0 0 0 0.25 0.5 0.75\nv 1 0 0 0 1 1 0.5\nv 1 1 0 0.5\nv 0 1 0 # 1 0 0\nf 1 2 3\nf 1 3 4\n");
    EXPECT_EQ(corners(mesh, &TriangleMesh::colors),
              (std::vector<vec4>{vec4(0.25f, 0.5f, 0.75f, 1), vec4(0, 1, 1, 1), vec4(1)}));
    EXPECT_EQ(corners(mesh, &TriangleMesh::colors, 1)[2], vec4(1));
    EXPECT_TRUE(load(CORNERS + "f 1 2 3\n").colors.empty());
    EXPECT_TRUE(load("v 0 0 0 1\nv 1 0 0 1 1\nv 1 1 0 1 #1 1\nf 1 2 3\n").colors.empty());
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

TEST_F(ObjAttributes, RefusesColoursOutOfRange) {
    for (const std::string word : {"255", "-0.1", "1.01", "nan", "inf", "red"}) {
        expect_error("v 0 0 0\nv 1 0 0 0 " + word + " 0\nv 0 1 0\nf 1 2 3\n",
                     "m.obj:2: the colour of a vertex needs three numbers from 0 to 1, found \"" + word +
                         "\"; scale the colours, or leave them out");
    }
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
