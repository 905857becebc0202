// What vertices of PLY files have besides positions and normals: texture coordinates and colours.
#include <bit>
#include <cmath>

#include <gtest/gtest.h>

#include "load/ply/ply.h"
#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

class PlyAttributes : public testing::Test {
  protected:
    // A triangle whose vertices have `properties` after x, y and z, with these rows.
    static std::string ascii(const std::string& properties, const std::array<std::string, 3>& rows) {
        return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
               "z\n" +
               properties + "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 " +
               rows[0] + "\n1 0 0 " + rows[1] + "\n0 1 0 " + rows[2] + "\n3 0 1 2\n";
    }

    TriangleMesh load(const std::string& text, MeshNormals normals = MeshNormals::file) {
        folder_.write("m.ply", text);
        warnings_.clear();
        return load_ply(folder_.path() / "m.ply", normals, FileReach(folder_.path() / "m.ply"), warnings_);
    }

    void expect_error(const std::string& text, const std::string& message) {
        SCOPED_TRACE(text);
        EXPECT_EQ(folder_.without_folder(error_of([&] { load(text); })), message);
    }

    SceneFolder folder_;
    std::vector<std::string> warnings_;
};

const std::string RGB = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
const std::string FLOATS = "property float red\nproperty double green\nproperty float blue\n";

TEST_F(PlyAttributes, TextureCoordinatesHaveFourNames) {
    using Pair = std::pair<std::string, std::string>;
    for (const auto& [u, v] :
         {Pair("u", "v"), Pair("s", "t"), Pair("texture_u", "texture_v"), Pair("texture_s", "texture_t")}) {
        SCOPED_TRACE(u);
        const std::string properties = "property float " + v + "\nproperty double " + u + "\n";
        const TriangleMesh mesh = load(ascii(properties, {"0.25 0.5", "-1e30 1e30", "1 0"}));
        EXPECT_EQ(mesh.uv0, (std::vector<vec2>{vec2(0.5f, 0.25f), vec2(1e30f, -1e30f), vec2(0, 1)}));
        EXPECT_TRUE(mesh.uv1.empty());
        EXPECT_TRUE(mesh.colors.empty());
    }
}

TEST_F(PlyAttributes, TextureCoordinatesThatAreNotFiniteAreZero) {
    const std::string properties = "property float u\nproperty double v\n";
    EXPECT_EQ(load(ascii(properties, {"0.5 0.25", "0.5 nan", "1 1"})).uv0,
              (std::vector<vec2>{vec2(0.5f, 0.25f), vec2(0), vec2(1)}));
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_EQ(folder_.without_folder(warnings_[0]),
              "m.ply: the texture coordinates of 1 vertex are not finite, or beyond 1e30; 0 is used there");
    EXPECT_EQ(load(ascii(properties, {"inf 0.25", "0.5 -1.5e30", "1 1"})).uv0,
              (std::vector<vec2>{vec2(0), vec2(0), vec2(1)}));
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_EQ(folder_.without_folder(warnings_[0]),
              "m.ply: the texture coordinates of 2 vertices are not finite, or beyond 1e30; 0 is used there");
}

TEST_F(PlyAttributes, TextureCoordinatesAreTheFirstCompletePair) {
    EXPECT_EQ(
        load(ascii("property float s\nproperty float t\nproperty float u\n", {"1 2 9", "3 4 9", "5 6 9"}))
            .uv0,
        (std::vector<vec2>{vec2(1, 2), vec2(3, 4), vec2(5, 6)}));
    EXPECT_EQ(load(ascii("property float s\nproperty float t\nproperty float u\nproperty float v\n",
                         {"nan inf 1 2", "9 9 3 4", "9 9 5 6"}))
                  .uv0,
              (std::vector<vec2>{vec2(1, 2), vec2(3, 4), vec2(5, 6)}));
    EXPECT_TRUE(load(ascii("property float u\n", {"1", "1", "1"})).uv0.empty());
    EXPECT_TRUE(load(ascii("property list uchar float s\nproperty float t\n", {"1 2 3", "0 4", "2 5 6 7"}))
                    .uv0.empty());
}

TEST_F(PlyAttributes, BytesAreColoursInSrgb) {
    const TriangleMesh mesh = load(ascii(RGB, {"0 10 255", "188 11 1", "255 255 254"}));
    ASSERT_EQ(mesh.colors.size(), 3u);
    // IEC 61966-2-1, in double precision; floats and their powers are off by a few ulp.
    const auto linear = [](int code) {
        const double x = code / 255.0;
        return x > 0.04045 ? std::pow((x + 0.055) / 1.055, 2.4) : x / 12.92;
    };
    const int codes[3][3]{{0, 10, 255}, {188, 11, 1}, {255, 255, 254}};
    for (size_t i = 0; i < 3; ++i) {
        for (glm::length_t c = 0; c < 3; ++c)
            EXPECT_NEAR(mesh.colors[i][c], linear(codes[i][c]), 1e-6 * linear(codes[i][c]));
        EXPECT_EQ(mesh.colors[i].w, 1.0f);
    }
    const TriangleMesh wide = load(ascii("property ushort red\nproperty uint16 green\nproperty ushort blue\n",
                                         {"0 2570 65535", "48316 2827 257", "65535 65535 65278"}));
    for (size_t i = 0; i < 3; ++i)  // 257 times the codes above.
        EXPECT_NEAR(length(wide.colors[i] - mesh.colors[i]), 0.0f, 1e-6f);
}

TEST_F(PlyAttributes, FloatsAreLinearColours) {
    EXPECT_EQ(load(ascii(FLOATS, {"0 0.5 1", "0.25 0.125 0.75", "1 1 1"})).colors,
              (std::vector<vec4>{vec4(0, 0.5f, 1, 1), vec4(0.25f, 0.125f, 0.75f, 1), vec4(1)}));
    for (const std::string word : {"255", "-0.5", "1.01", "nan", "inf"}) {
        expect_error(ascii(FLOATS, {"0 0 0", "0 " + word + " 0", "0 0 0"}),
                     "m.ply: vertex 1, which a face uses, needs a colour from 0 to 1, found " + word +
                         "; write numbers from 0 to 255 as uchar");
    }
    EXPECT_EQ(load(ascii(FLOATS, {"-1e-6 0.5 1.000001", "0 0 0", "1 1 1"})).colors[0], vec4(0, 0.5f, 1, 1));
}

TEST_F(PlyAttributes, ColoursMayBeCalledDiffuse) {
    const std::string properties =
        "property uchar diffuse_red\nproperty uchar diffuse_green\n"
        "property uchar diffuse_blue\nproperty uchar diffuse_alpha\n";
    const TriangleMesh mesh = load(ascii(properties, {"255 0 0 51", "0 255 0 255", "0 0 255 0"}));
    EXPECT_EQ(mesh.colors, (std::vector<vec4>{vec4(1, 0, 0, 0.2f), vec4(0, 1, 0, 1), vec4(0, 0, 1, 0)}));
}

TEST_F(PlyAttributes, AlphaIsLinear) {
    const TriangleMesh bytes =
        load(ascii("property uchar alpha\n" + RGB, {"0 0 0 0", "51 0 0 0", "255 0 0 0"}));
    EXPECT_EQ(bytes.colors, (std::vector<vec4>{vec4(0), vec4(0, 0, 0, 0.2f), vec4(0, 0, 0, 1)}));
    const TriangleMesh words =
        load(ascii(FLOATS + "property ushort alpha\n", {"0 0 0 0", "0 0 0 13107", "0 0 0 65535"}));
    EXPECT_EQ(words.colors, bytes.colors);
    const TriangleMesh floats =
        load(ascii(FLOATS + "property float alpha\n", {"0 0 0 0", "0 0 0 0.2", "0 0 0 1"}));
    EXPECT_EQ(floats.colors, bytes.colors);
}

TEST_F(PlyAttributes, ColoursNeedThreeChannelsOfCertainTypes) {
    EXPECT_TRUE(load(ascii("property uchar red\nproperty uchar green\nproperty uchar alpha\n",
                           {"1 1 1", "1 1 1", "1 1 1"}))
                    .colors.empty());
    EXPECT_TRUE(warnings_.empty());
    for (const std::string type : {"char", "short", "int", "uint"}) {
        EXPECT_TRUE(load(ascii(FLOATS + "property " + type + " alpha\n", {"0 0 0 1", "0 0 0 1", "0 0 0 1"}))
                        .colors.empty());
        ASSERT_EQ(warnings_.size(), 1u);
        EXPECT_EQ(
            folder_.without_folder(warnings_[0]),
            "m.ply: ignored the colours of vertices, because the property \"alpha\" is neither uchar nor "
            "ushort, float or double");
    }
}

TEST_F(PlyAttributes, AreInBinaryFilesToo) {
    std::string text =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar blue\nproperty float x\n"
        "property float nx\nproperty float y\nproperty uchar red\nproperty float z\nproperty float ny\n"
        "property float nz\nproperty float t\nproperty uchar green\nproperty uchar alpha\nproperty double s\n"
        "element face 1\nproperty list uchar uchar vertex_index\nend_header\n";
    const auto put = [&](auto number) {
        static_assert(std::endian::native == std::endian::little);
        const auto bytes = std::bit_cast<std::array<char, sizeof number>>(number);
        text.append(bytes.begin(), bytes.end());
    };
    for (const float i : {0.f, 1.f, 2.f}) {
        put(uint8_t(0)), put(i), put(0.f), put(i == 1.f ? 1.f : 0.f), put(uint8_t(255)), put(0.f), put(0.f);
        put(1.f), put(i + 0.5f), put(uint8_t(i == 0.f ? 255 : 0)), put(uint8_t(51)), put(double(i));
    }
    text += std::string("\3\0\2\1", 4);
    for (const MeshNormals normals : {MeshNormals::file, MeshNormals::flat}) {
        const TriangleMesh mesh = load(text, normals);
        EXPECT_EQ(mesh.positions, (std::vector<vec3>{vec3(0), vec3(1, 1, 0), vec3(2, 0, 0)}));
        EXPECT_EQ(mesh.normals.size(), normals == MeshNormals::file ? 3u : 0u);
        EXPECT_EQ(mesh.uv0, (std::vector<vec2>{vec2(0, 0.5f), vec2(1, 1.5f), vec2(2, 2.5f)}));
        EXPECT_EQ(mesh.colors,
                  (std::vector<vec4>{vec4(1, 1, 0, 0.2f), vec4(1, 0, 0, 0.2f), vec4(1, 0, 0, 0.2f)}));
    }
}

TEST_F(PlyAttributes, ColourASceneOfItsOwn) {
    folder_.write("m.ply", ascii(FLOATS, {"0 0 0", "0 0 0", "0 0 0"}));
    const Scene colored = load_scene(folder_.path() / "m.ply");
    EXPECT_TRUE(colored.materials.at(0).vertex_colors);
    EXPECT_EQ(std::get<DiffuseMaterial>(colored.materials[0].model).reflectance, vec3(1));
    EXPECT_EQ(colored.materials[0].name, "m.ply");
    folder_.write("m.ply", ascii("property float u\n", {"0", "0", "0"}));
    const Scene grey = load_scene(folder_.path() / "m.ply");
    EXPECT_FALSE(grey.materials.at(0).vertex_colors);
    EXPECT_EQ(std::get<DiffuseMaterial>(grey.materials[0].model).reflectance, vec3(0.5f));
}

}  // namespace
}  // namespace candela
