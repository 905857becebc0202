// Texels in tiles, textures each once, and the light of textured emitters.
#include "gpu_scene/texture_table.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "base/error.h"
#include "gpu_scene/area_lights.h"
#include "gpu_scene/flatten.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/texture_mean.h"
#include "support/scene_builders.h"

namespace candela {
namespace {

// An image whose bytes count up.
TexelImage counting(uvec2 size, uint32_t channels, TexelType type) {
    TexelImage image{.size = size, .channels = channels, .type = type, .texels = {}, .gamma = {}};
    image.texels.resize(size_t(size.x) * size.y * channels * byte_size(type));
    for (size_t i = 0; i < image.texels.size(); ++i)
        image.texels[i] = std::byte(i);
    return image;
}

TEST(TextureTable, TexelsLieInTiles) {
    const TexelImage grey = counting({6, 5}, 1, TexelType::unorm8);
    ASSERT_EQ(texel_words(grey), 4u);
    std::vector<uvec4> words(4);
    pack_texels(grey, words);
    EXPECT_EQ(words[0], uvec4(0x03020100, 0x09080706, 0x0f0e0d0c, 0x15141312));
    // Beyond the edges, the edge is repeated.
    EXPECT_EQ(words[1], uvec4(0x05050504, 0x0b0b0b0a, 0x11111110, 0x17171716));
    EXPECT_EQ(words[3], uvec4(0x1d1d1d1c));

    const TexelImage rgb = counting({5, 1}, 3, TexelType::unorm8);
    ASSERT_EQ(texel_words(rgb), 8u);
    words.resize(8);
    pack_texels(rgb, words);
    EXPECT_EQ(words[0], uvec4(0xff020100, 0xff050403, 0xff080706, 0xff0b0a09));
    EXPECT_EQ(words[4], uvec4(0xff0e0d0c));

    const TexelImage deep = counting({1, 2}, 2, TexelType::unorm16);
    ASSERT_EQ(texel_words(deep), 8u);
    pack_texels(deep, words);
    EXPECT_EQ(words[0], uvec4(0x01000100, 0x03020100, 0x01000100, 0x03020100));
    EXPECT_EQ(words[2], uvec4(0x05040504, 0x07060504, 0x05040504, 0x07060504));

    const TexelImage half = counting({1, 1}, 3, TexelType::half);
    pack_texels(half, words);
    EXPECT_EQ(words[0].y, 0x3c000504u);  // Alpha is 1.
}

TEST(TextureTable, HoldsEveryTextureAndImageOnce) {
    std::vector<ImageFile> images(3);
    for (ImageFile& file : images)
        file.image = std::make_shared<TexelImage>(counting({4, 4}, 4, TexelType::unorm8));
    TextureTable table(images);
    EXPECT_EQ(table.add(std::nullopt), TEXTURE_NONE);
    EXPECT_EQ(table.add(Texture{.image = 2}), 0u);
    EXPECT_EQ(table.add(Texture{.image = 2, .wrap_u = Wrap::clamp}), 1u);
    EXPECT_EQ(table.add(Texture{.image = 2}), 0u);
    EXPECT_EQ(table.add(Texture{.image = 0, .encoding = TextureEncoding::srgb}), 2u);
    EXPECT_EQ(table.records().size(), 3 * TEXTURE_WORDS);
    EXPECT_EQ(build_texels(images, table.places()).size(), 2 * 4u);  // Image 1 is not looked up.
    EXPECT_EQ(table.traits(), TEXEL_RGBA8 | TEXTURE_LINEAR | TEXTURE_SRGB | TEXTURE_BILINEAR |
                                  TEXTURE_REPEAT | TEXTURE_CLAMP | TEXTURE_REPEAT << TEXTURE_WRAP_V |
                                  TEXTURE_UV0);
}

TEST(TextureTable, RefusesAnImageThatIsTooWide) {
    const std::vector<ImageFile> images{
        {.path = "wide.png",
         .place = "a.json:1:2",
         .image = std::make_shared<TexelImage>(counting({65536, 1}, 1, TexelType::unorm8))}};
    TextureTable table(images);
    try {
        table.add(Texture{.image = 0});
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(
            error.what(),
            "a.json:1:2: the image wide.png has 65536x1 pixels, but a texture at most 65535 along a side; "
            "make it smaller (--texture-limit)");
    }
}

TEST(TextureTable, TheLastUseOfImagesFreesThem) {
    Scene scene = scene_of_mesh(sphere_mesh(4, 4));
    for (const float grey : {0.25f, 0.75f})
        add_texture(scene, {5, 6}, [&](uint32_t, uint32_t) { return vec4(vec3(grey), 1); });
    // The second image comes first.
    scene.materials[0].model =
        PhongMaterial{{vec3(1), Texture{.image = 1}}, {vec3(1), Texture{.image = 0}}, 1.0f};
    const auto texels = build_gpu_scene(scene).arrays[ARRAY_TEXELS];
    EXPECT_EQ(texels.size(), texel_words(*scene.images[0].image) + texel_words(*scene.images[1].image));
    EXPECT_EQ(build_gpu_scene_freeing_images(scene).arrays[ARRAY_TEXELS], texels);
    for (const ImageFile& file : scene.images)
        EXPECT_EQ(file.image->texels.capacity(), 0u);
}

TEST(TextureTable, AttributesAreThoseThatAreLookedUp) {
    Scene scene = scene_of_mesh(sphere_mesh(4, 4));
    EXPECT_EQ(build_gpu_scene(scene).attributes, 0u);
    EXPECT_TRUE(build_gpu_scene(scene).arrays[ARRAY_MATERIAL_TEXTURES].empty());
    const Texture texture = add_texture(scene, {1, 1}, [](uint32_t, uint32_t) { return vec4(1); });
    scene.materials[0].model = DiffuseMaterial{Textured<vec3>(vec3(1), texture)};
    EXPECT_EQ(build_gpu_scene(scene).attributes, ATTRIBUTE_UV0);
    scene.materials[0].vertex_colors = true;
    scene.materials[0].opacity.value = {1.0f, Texture{.image = 0, .uv_set = 1}};
    scene.materials[0].normal_map = NormalMap{texture, 1.0f};
    const GpuScene gpu = build_gpu_scene(scene);
    EXPECT_EQ(gpu.attributes, ATTRIBUTES_ALL);
    EXPECT_EQ(gpu.arrays[ARRAY_ATTRIBUTES].size(), 7 * gpu.primitive_count);
}

// The power of a light that looks up an image of 64 x 64 texels, all black but for one block.
double power_of(const decltype(Shape::geometry)& geometry, uvec2 lo, uvec2 hi,
                const std::vector<vec2>& uvs = {}) {
    Scene scene = scene_with_camera(dvec3(0), dvec3(0, 0, -1), 1.0f);
    const Texture texture = add_texture(scene, {64, 64}, [&](uint32_t x, uint32_t y) {
        return vec4(vec3(x >= lo.x && x < hi.x && y >= lo.y && y < hi.y ? 1.0f : 0.0f), 1.0f);
    });
    const Emission emission{{vec3(1), texture}, false};
    if (uvs.empty()) {
        add_shape(scene, geometry, add_diffuse(scene, vec3(0)), emission);
    } else {
        TriangleMesh mesh{.uv0 = uvs};
        add_triangle(mesh, vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0));
        add_shape(scene, mesh, add_diffuse(scene, vec3(0)), emission);
    }
    const AreaLights area = build_area_lights(scene, flatten(scene, SceneFrame{}, ATTRIBUTE_UV0));
    return std::accumulate(area.lights.powers.begin(), area.lights.powers.end(), 0.0);
}

TEST(TextureMean, TheWholeImageHasItsMean) {
    const Quad quad = parallelogram(vec3(0), vec3(2, 0, 0), vec3(0, 3, 0));
    EXPECT_NEAR(power_of(quad, {0, 0}, {64, 64}), 6.0, 1e-5);
    EXPECT_NEAR(power_of(quad, {0, 0}, {32, 64}), 3.0, 1e-5);
    EXPECT_NEAR(power_of(quad, {5, 7}, {6, 8}), 6.0 / 4096, 1e-5);
}

// The bright block is in the corner at the triangle's right angle. Along two of its sides, the texture mixes
// in the other edge of the image, up to half a texel of the copy, which is a quarter as large: at most 1/16
// each.
TEST(TextureMean, ATriangleHasThatOfItsOwnHalfOfTheImage) {
    const std::vector<vec2> uvs{vec2(0, 0), vec2(1, 0), vec2(0, 1)};
    EXPECT_NEAR(power_of({}, {0, 48}, {16, 64}, uvs), 0.5 / 8, 0.5 / 8 / 8);
}

// However small the piece that emits, and wherever it lies.
TEST(TextureMean, NoLightWithABrightTexelHasNoPower) {
    for (uint32_t i = 0; i < 64; i += 3) {
        for (uint32_t j = 0; j < 64; j += 7) {
            const uvec2 texel(i, j);
            EXPECT_GT(power_of(Sphere{dvec3(0), 1.0}, texel, texel + 1u), 0.0);
            // A triangle over the texel's middle, and one over the whole image.
            const vec2 middle((float(i) + 0.5f) / 64, 1.0f - (float(j) + 0.5f) / 64);
            for (const float size : {1e-4f, 0.02f, 0.3f}) {
                const std::vector<vec2> uvs{middle - vec2(size), middle + vec2(2 * size, 0),
                                            middle + vec2(0, 2 * size)};
                EXPECT_GT(power_of({}, texel, texel + 1u, uvs), 0.0) << i << ' ' << j << ' ' << size;
            }
        }
    }
}

// A triangle far from all bright texels is not a light.
TEST(TextureMean, WhatIsBlackHasNoPower) {
    const std::vector<vec2> uvs{vec2(0.8f, 0.8f), vec2(0.82f, 0.8f), vec2(0.8f, 0.82f)};
    EXPECT_EQ(power_of({}, {10, 50}, {12, 52}, uvs), 0.0);
}

// Levels of an image whose sides are not powers of two are larger than half of the one before. The piece lies
// within the last bright column.
TEST(TextureMean, ALevelThatWasRoundedUpIsLookedUpWhereItIs) {
    Scene scene = scene_with_camera(dvec3(0), dvec3(0, 0, -1), 1.0f);
    const Texture texture = add_texture(
        scene, {9, 1}, [](uint32_t x, uint32_t) { return vec4(vec3(x >= 4 && x < 8 ? 1.0f : 0.0f), 1.0f); });
    TriangleMesh mesh{.uv0 = {vec2(7.55f / 9, 0.4f), vec2(7.95f / 9, 0.4f), vec2(7.75f / 9, 0.6f)}};
    add_triangle(mesh, vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0));
    add_shape(scene, mesh, add_diffuse(scene, vec3(0)), Emission{{vec3(1), texture}, false});
    EXPECT_EQ(build_area_lights(scene, flatten(scene, SceneFrame{}, ATTRIBUTE_UV0)).pieces.size(), 1u);
}

}  // namespace
}  // namespace candela
