// Textures of a scene file: what their keys say, and what is refused.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/color.h"
#include "support/png_writer.h"
#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

class SceneTextures : public testing::Test {
  protected:
    SceneTextures() { write_image("a.png"); }

    void write_image(const std::string& name) { folder_.write(name, PNG); }
    // A scene with the material "m".
    static std::string material(const std::string& value) {
        return settings(GOOD_CAMERA + ",\n\"materials\": {\"m\": " + value + "}");
    }
    Material load(const std::string& value) { return folder_.load(material(value)).materials.at(0); }
    // The texture of a diffuse material's reflectance.
    Texture load_texture(const std::string& keys) {
        const Material m = load(R"({"type": "diffuse", "reflectance": {"image": "a.png")" + keys + "}}");
        return std::get<DiffuseMaterial>(m.model).reflectance.texture.value();
    }

    // 2 x 2 texels.
    inline static const std::string PNG = encode_png(
        {.size = uvec2(2), .bits = 8, .color = png_rgb, .samples = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}});
    SceneFolder folder_;
};

TEST_F(SceneTextures, HaveDefaultsForColours) {
    EXPECT_EQ(load_texture(""), (Texture{.image = 0, .encoding = TextureEncoding::srgb}));
}

TEST_F(SceneTextures, ReadAllKeys) {
    const Texture texture = load_texture(
        R"(, "encoding": "linear", "wrap": ["mirror", "clamp"], "filter": "nearest", "channel": "blue", "uv_set": 1,
            "uv_scale": [2, 3], "uv_rotation": 90, "uv_offset": [0.5, -1])");
    EXPECT_EQ(texture.encoding, TextureEncoding::linear);
    EXPECT_EQ(texture.wrap_u, Wrap::mirror);
    EXPECT_EQ(texture.wrap_v, Wrap::clamp);
    EXPECT_EQ(texture.filter, TextureFilter::nearest);
    EXPECT_EQ(texture.channel, 2u);
    EXPECT_EQ(texture.uv_set, 1u);
    // (u, v) -> (2 u, 3 v) -> (-3 v, 2 u) -> + (0.5, -1).
    const vec3 expected[2] = {vec3(0, -3, 0.5f), vec3(2, 0, -1)};
    for (int i = 0; i < 2; ++i)
        EXPECT_LT(length(texture.rows[i] - expected[i]), 1e-6f) << i;
    EXPECT_EQ(load_texture(R"(, "wrap": "clamp", "uv_scale": 4)").wrap_v, Wrap::clamp);
}

TEST_F(SceneTextures, StandWhereverAColourOrNumberDoes) {
    const Material phong = load(R"({"type": "phong", "diffuse": {"image": "a.png", "factor": 0.5},
        "specular": {"image": "a.png", "factor": [0.1, 0.2, 0.3]}, "exponent": {"image": "a.png", "factor": 50}})");
    const auto& p = std::get<PhongMaterial>(phong.model);
    EXPECT_EQ(p.diffuse.factor, vec3(0.5f));
    EXPECT_EQ(p.specular.factor, vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(p.exponent.factor, 50.0f);
    EXPECT_EQ(p.diffuse.texture->encoding, TextureEncoding::srgb);
    EXPECT_EQ(p.exponent.texture->encoding, TextureEncoding::linear);
    const auto metal = std::get<ConductorMaterial>(
        load(
            R"({"type": "conductor", "reflectance": {"image": "a.png"}, "alpha": {"image": "a.png", "channel": "green"}})")
            .model);
    EXPECT_EQ(metal.alpha.factor, 1.0f);
    EXPECT_EQ(metal.alpha.texture->channel, 1u);
    const Material leaf = load(
        R"({"type": "diffuse_transmission", "reflectance": 0.1, "transmittance": {"image": "a.png", "factor": 0.9},
        "opacity": {"image": "a.png", "factor": 0.75, "cutoff": 0.5}, "normal_map": {"image": "a.png", "scale": 2}})");
    EXPECT_EQ(leaf.opacity.value.factor, 0.75f);
    EXPECT_EQ(leaf.opacity.value.texture->channel, 3u);
    EXPECT_EQ(leaf.opacity.cutoff, 0.5f);
    EXPECT_EQ(leaf.normal_map->scale, 2.0f);
    EXPECT_EQ(leaf.normal_map->texture.encoding, TextureEncoding::linear);
    EXPECT_EQ(load(R"({"type": "dielectric", "ior": 1.5, "opacity": 0.25})").opacity.value.factor, 0.25f);
    EXPECT_TRUE(load(R"({"type": "mirror", "vertex_colors": true})").vertex_colors);

    const Scene scene =
        folder_.load("{" + GOOD_CAMERA + R"(, "shapes": [{"type": "sphere", "center": [0, 0, 0], "radius": 1,
        "emission": {"image": "a.png", "factor": 3}}]})");
    EXPECT_EQ(scene.shapes.at(0).emission->radiance.factor, vec3(3));
    EXPECT_TRUE(scene.shapes.at(0).emission->radiance.texture);
}

TEST_F(SceneTextures, HeightsAreInMetres) {
    const auto map = [&](const std::string& keys) {
        return load(R"({"type": "mirror", "bump_map": {"image": "a.png")" + keys + "}}").bump_map.value();
    };
    EXPECT_EQ(map(R"(, "scale": 0.125)").scale, 0.125f);
    EXPECT_EQ(map(R"(, "scale": -3)").scale, -3.0f);
    EXPECT_EQ(map(R"(, "scale": 1)").texture, (Texture{.encoding = TextureEncoding::linear}));
    EXPECT_EQ(map(R"(, "scale": 1, "channel": "green", "encoding": "srgb")").texture,
              (Texture{.encoding = TextureEncoding::srgb, .channel = 1}));
    EXPECT_FALSE(map(R"(, "scale": 1)").multiplier);
    folder_.expect_error(material(R"({"type": "mirror", "bump_map": @{"image": "a.png"}})"),
                         "the key \"scale\" is missing here; add it");
    folder_.expect_error(material(R"({"type": "mirror", "bump_map": {"image": "a.png", "scale": @"1"}})"),
                         "\"scale\": expected a number, found \"1\"");
    folder_.expect_error(
        material(
            R"({"type": "mirror", "normal_map": {"image": "a.png"}, "bump_map": @{"image": "a.png", "scale": 1}})"),
        "a material has a normal_map or a bump_map, not both; bake the heights into the normals");
}

TEST_F(SceneTextures, WarnOfABumpMapThatLooksLikeNormals) {
    const std::vector<uint32_t> blue{110, 140, 240}, grey{200, 200, 200}, pale{150, 150, 180};
    for (const auto& [texel, warnings] : {std::pair(blue, 2u), std::pair(grey, 1u), std::pair(pale, 1u)}) {
        folder_.write("n.png", encode_png({.size = uvec2(1), .bits = 8, .color = png_rgb, .samples = texel}));
        const Scene scene =
            folder_.load(material(R"({"type": "mirror", "bump_map": {"image": "n.png", "scale": 1}})"));
        EXPECT_TRUE(scene.materials.at(0).bump_map);
        ASSERT_EQ(scene.warnings.size(), warnings);  // One says that the scene is empty.
        if (warnings == 1u) continue;
        EXPECT_NE(scene.warnings[1].find(": the bump map of the material \"m\", "), std::string::npos);
        EXPECT_NE(scene.warnings[1].find(
                      "n.png, has the colours of a normal map; if it is one, name it as normal_map"),
                  std::string::npos)
            << scene.warnings[1];
    }
}

TEST_F(SceneTextures, OfOneFileShareItsImage) {
    write_image("b.png");
    const Scene scene = folder_.load(settings(GOOD_CAMERA + R"(, "materials": {
        "m": {"type": "phong", "diffuse": {"image": "a.png", "factor": 0.5}, "specular": {"image": "./a.png", "factor": 0.5},
              "exponent": {"image": "b.png"}}})"));
    ASSERT_EQ(scene.images.size(), 2u);
    EXPECT_EQ(scene.images[0].image->size, uvec2(2));
    EXPECT_EQ(scene.files.size(), 2u);
}

TEST_F(SceneTextures, RefuseWhatIsWrong) {
    const auto diffuse = [](const std::string& value) {
        return material(R"({"type": "diffuse", "reflectance": )" + value + "}");
    };
    folder_.expect_error(diffuse(R"(@{"factor": 1})"), "the key \"image\" is missing here; add it");
    folder_.expect_error(diffuse(R"({"image": "a.png", "factor": @2})"),
                         "\"factor\": expected numbers from 0 to 1, found 2");
    folder_.expect_error(diffuse(R"({"image": "a.png", "wrap": @["clamp"]})"),
                         "\"wrap\": expected a name, or one for each of u and v, found an array of 1");
    folder_.expect_error(diffuse(R"({"image": "a.png", "uv_scale": @1e7})"),
                         "\"uv_scale\": expected numbers from -1e6 to 1e6, found 1e+07");
    folder_.expect_error(diffuse(R"({"image": "a.png", "uv_set": @2})"),
                         "\"uv_set\": expected a whole number from 0 to 1, found 2");
    folder_.expect_error(
        material(R"({"type": "phong", "specular": @{"image": "a.png"}, "diffuse": 0.5, "exponent": 1})"),
        "diffuse + specular is 1.5 in red where an image is white; lower a \"factor\" until the sum is at "
        "most 1");
}

TEST_F(SceneTextures, AnImageThatCannotBeReadIsNamedWithItsPlace) {
    folder_.expect_error(material(R"({"type": "diffuse", "reflectance": {"image": @"b.png"}})"),
                         "cannot read \"b.png\": the file does not exist; check the name");
    folder_.write("b.png", PNG.substr(0, 40));
    const std::string error =
        error_of([&] { load(R"({"type": "diffuse", "reflectance": {"image": "b.png"}})"); });
    EXPECT_NE(error.find("scene.json:2:"), std::string::npos) << error;
    EXPECT_NE(error.find("b.png"), std::string::npos) << error;
}

TEST_F(SceneTextures, MeshesHaveCoordinatesAndColours) {
    const auto mesh = [](const std::string& keys) {
        return "{" + GOOD_CAMERA + R"(, "shapes": [{"type": "mesh", "emission": 1,
            "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]], )" +
               keys + "}]}";
    };
    const TriangleMesh read =
        folder_
            .load(mesh(R"("uvs": [[0, 0], [1, 0], [0, 1e30]], "uvs1": [[1, 2], [3, 4], [5, 6]],
        "colors": [[0, 0.5, 1], [1, 1, 1, 0.25], [0, 0, 0]])"))
            .meshes.at(0);
    EXPECT_EQ(read.uv0, (std::vector{vec2(0, 0), vec2(1, 0), vec2(0, 1e30f)}));
    EXPECT_EQ(read.uv1, (std::vector{vec2(1, 2), vec2(3, 4), vec2(5, 6)}));
    EXPECT_EQ(read.colors, (std::vector{vec4(0, 0.5f, 1, 1), vec4(1, 1, 1, 0.25f), vec4(0, 0, 0, 1)}));
    folder_.expect_error(mesh(R"("uvs": @[[0, 0], [1, 0]])"),
                         "\"uvs\": expected as many elements as positions, 3, found an array of 2");
    folder_.expect_error(mesh(R"("uvs": [@[0, 0, 0], [1, 0], [0, 1]])"),
                         "\"uvs\": expected two numbers [u, v], found [0, 0, 0]");
    folder_.expect_error(mesh(R"("uvs": [@[0, 2e30], [1, 0], [0, 1]])"),
                         "\"uvs\": expected numbers from -1e30 to 1e30, found [0, 2e+30]");
    folder_.expect_error(mesh(R"("colors": [[0, 0, @2], [1, 0, 0], [0, 1, 0]])"),
                         "\"colors\": expected a number from 0 to 1, found 2");
}

// Seen from outside: up is +Y on four sides, -Z on the top, +Z at the bottom.
TEST_F(SceneTextures, StandUprightOnBoxes) {
    const Scene scene =
        folder_.load(scene_of(R"({"type": "box", "min": [0, 0, 0], "max": [1, 2, 3], "material": "white"})"));
    ASSERT_EQ(scene.shapes.size(), 6u);
    dvec3 sum(0.0);
    for (const Shape& shape : scene.shapes) {
        const Quad& quad = std::get<Quad>(shape.geometry);
        const auto corner = [&](const vec2& uv) {
            const auto* found = std::find(std::begin(quad.uvs), std::end(quad.uvs), uv);
            EXPECT_NE(found, std::end(quad.uvs));
            return quad.corners[size_t(found - quad.uvs) % 4];
        };
        const dvec3 origin = corner(vec2(0));
        const dvec3 right = glm::normalize(corner(vec2(1, 0)) - origin);
        const dvec3 up = glm::normalize(corner(vec2(0, 1)) - origin);
        EXPECT_EQ(corner(vec2(1)), corner(vec2(1, 0)) + corner(vec2(0, 1)) - origin);
        const dvec3 outward =
            glm::cross(quad.corners[1] - quad.corners[0], quad.corners[2] - quad.corners[1]);
        const dvec3 n = glm::normalize(outward);
        EXPECT_EQ(up, n.y == 0.0 ? dvec3(0, 1, 0) : dvec3(0, 0, -n.y));
        EXPECT_EQ(glm::cross(right, up), n);
        sum += glm::abs(n);
    }
    EXPECT_EQ(sum, dvec3(2.0));
}

// A mirrored quad keeps its picture: each vertex its coordinates.
TEST_F(SceneTextures, AMirroredQuadKeepsItsCoordinates) {
    const Scene scene = folder_.load("{" + GOOD_CAMERA + R"(, "shapes": [{"type": "quad", "emission": 1,
        "vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "transform": [{"scale": [-1, 1, 1]}]}]})");
    const Quad& quad = std::get<Quad>(scene.shapes.at(0).geometry);
    for (size_t i = 0; i < 4; ++i)
        EXPECT_EQ(quad.uvs[i], vec2(float(-quad.corners[i].x), float(quad.corners[i].y)));
}

// gAMA 0.5: samples are roots of light. Colours are converted to sRGB; data are what the file holds.
TEST_F(SceneTextures, OfAnotherGammaAreConvertedForColours) {
    folder_.write("g.png", encode_png({.size = uvec2(2, 1),
                                       .bits = 8,
                                       .color = png_rgb_alpha,
                                       .samples = {0, 51, 255, 51, 128, 1, 2, 3}},
                                      png_chunk("gAMA", big_endian_bytes(50000))));
    const Scene scene = folder_.load(
        material(R"({"type": "phong", "specular": {"image": "g.png"}, "exponent": {"image": "g.png"}})"));
    ASSERT_EQ(scene.images.size(), 2u);
    const auto& phong = std::get<PhongMaterial>(scene.materials[0].model);
    EXPECT_EQ(phong.exponent.texture->image, 0u);
    EXPECT_EQ(phong.specular.texture->image, 1u);
    const vec4 code = texel_codes(*scene.images[1].image, 0);
    EXPECT_EQ(scene.images[1].image->type, TexelType::unorm16);
    EXPECT_EQ(code.x, 0.0f);
    EXPECT_NEAR(code.y, 0.2209164f, 1e-5f);  // sRGB of 0.04.
    EXPECT_EQ(code.z, 1.0f);
    EXPECT_NEAR(code.w, 0.2f, 1e-5f);
}

// An sRGB texture and one of data share no light: the first says how the image is made smaller.
TEST_F(SceneTextures, AreMadeSmallerOnDemand) {
    folder_.write("b.png",
                  encode_png({.size = uvec2(2, 1), .bits = 8, .color = png_grey, .samples = {0, 255}}));
    const ImageOptions options{.texture_limit = 1};
    std::vector<std::pair<size_t, size_t>> progress;
    const auto note = [&](const std::string& what, size_t done, size_t of) {
        if (what == "images") progress.emplace_back(done, of);
    };
    const auto code_of = [&](const std::string& reflectance, const std::string& exponent) {
        const Scene scene = folder_.load(material(R"({"type": "phong", "specular": )" + reflectance +
                                                  R"(, "exponent": )" + exponent + "}"),
                                         options, note);
        EXPECT_EQ(scene.images[0].image->size, uvec2(1));
        return std::lround(255.0f * texel_codes(*scene.images[0].image, 0).x);
    };
    const std::string image = R"({"image": "b.png"})";
    EXPECT_EQ(code_of(image, image), std::lround(255.0f * srgb_encode(0.5f)));
    EXPECT_EQ(code_of("0.5", image), 128);
    EXPECT_EQ(code_of(image, R"({"image": "a.png"})"), std::lround(255.0f * srgb_encode(0.5f)));
    const std::vector<std::pair<size_t, size_t>> expected{{1, 1}, {1, 1}, {1, 2}, {2, 2}};
    EXPECT_EQ(progress, expected);
}

// Each 16th column and row is black, so that 12 % of the texels are: the mean is 0.44 0.44 0.88.
TEST_F(SceneTextures, AreJudgedByTheirMeanWhateverTheirPattern) {
    constexpr uint32_t SIDE = 256;
    PngPicture picture{.size = uvec2(SIDE), .bits = 8, .color = png_rgb};
    for (uint32_t i = 0; i < SIDE * SIDE; ++i) {
        const bool is_black = i % 16 == 0 || i / SIDE % 16 == 0;
        for (const uint16_t code : std::array<uint16_t, 3>{128, 128, 255})
            picture.samples.push_back(is_black ? uint16_t(0) : code);
    }
    folder_.write("ribs.png", encode_png(picture));
    const Scene scene = folder_.load(material(R"({"type": "mirror", "normal_map": {"image": "ribs.png"}})"));
    EXPECT_EQ(scene.warnings.size(), 1u);  // The scene is empty.
}

TEST_F(SceneTextures, WarnOfANormalMapThatIsNoneAndOfOpacityWithoutAlpha) {
    const Scene scene = folder_.load(
        material(R"({"type": "mirror", "normal_map": {"image": "a.png"}, "opacity": {"image": "a.png"}})"));
    ASSERT_EQ(scene.warnings.size(), 3u);  // And that the scene is empty.
    EXPECT_NE(
        scene.warnings[1].find("a.png, has a mean of 0.018 0.022 0.025, not about 0.5 0.5 1; is it one in "
                               "tangent space?"),
        std::string::npos)
        << scene.warnings[1];
    EXPECT_NE(scene.warnings[2].find("a.png, which has none: it is opaque; name another channel"),
              std::string::npos)
        << scene.warnings[2];
    folder_.write(
        "n.png",
        encode_png({.size = uvec2(1), .bits = 8, .color = png_rgb_alpha, .samples = {128, 128, 255, 9}}));
    EXPECT_EQ(
        folder_
            .load(material(
                R"({"type": "mirror", "normal_map": {"image": "n.png"}, "opacity": {"image": "n.png"}})"))
            .warnings.size(),
        1u);
}

TEST_F(SceneTextures, AMeshUnderATextureNeedsCoordinates) {
    folder_.expect_error(
        "{" + GOOD_CAMERA + R"(, "materials": {"m": {"type": "diffuse", "reflectance": {"image": "a.png"}}},
        "shapes": [@{"type": "mesh", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]],
                    "material": "m"}]})",
        "the material \"m\" has textures, but the mesh has no texture coordinates; export it with them, "
        "or use a material without textures");
}

}  // namespace
}  // namespace candela
