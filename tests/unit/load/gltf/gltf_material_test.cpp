// Materials of glTF files: what the format and each of its extensions say arrives in PrincipledMaterial.
// Ref: Khronos, "glTF 2.0 Specification", section 3.9, and the texts of the extensions.
#include <cmath>

#include "unit/load/gltf/gltf_fixture.h"

namespace candela {
namespace {

class GltfMaterial : public Gltf {
  protected:
    // A triangle of this material, with two textures: 0 is of image 0, 1 of image 1.
    static GltfFile file_of(const Json& material) {
        GltfFile file;
        file.root["images"] = {{{"uri", "a.png"}}, {{"uri", "b.png"}}};
        file.root["textures"] = {{{"source", 0}}, {{"source", 1}}};
        file.push("materials", material);
        const Json attributes = {{"POSITION", file.add_corner()},
                                 {"TEXCOORD_0", file.add<float>("VEC2", {0, 0, 1, 0, 0, 1})},
                                 {"TEXCOORD_1", file.add<float>("VEC2", {0, 0, 1, 0, 0, 1})}};
        file.show({{"attributes", attributes}, {"material", 0}});
        return file;
    }
    static Json extension(const char* name, const Json& values) { return {{"extensions", {{name, values}}}}; }

    Material read(const Json& material) {
        SCOPED_TRACE(material.dump());
        const Scene scene = load(file_of(material));
        EXPECT_EQ(scene.warnings, std::vector<std::string>{});
        return scene.materials.at(scene.shapes.at(0).material);
    }
    PrincipledMaterial principled(const Json& material) {
        return std::get<PrincipledMaterial>(read(material).model);
    }
    PrincipledMaterial extended(const char* name, const Json& values) {
        return principled(extension(name, values));
    }
    // What is left of a value outside of its range, with the only warning.
    PrincipledMaterial clamped(const Json& material, const std::string& warning) {
        return std::get<PrincipledMaterial>(
            expect_warning(file_of(material), "#/materials/0/" + warning).materials.at(0).model);
    }

    // The number or colour is this times the channel of the image.
    template <class Value>
    static void expect_textured(const Textured<Value>& value, Value factor, uint32_t image, uint32_t channel,
                                TextureEncoding encoding) {
        EXPECT_EQ(value.factor, factor);
        ASSERT_TRUE(value.texture);
        EXPECT_EQ(value.texture->image, image);
        EXPECT_EQ(value.texture->encoding, encoding);
        EXPECT_EQ(value.texture->channel, channel);
    }
    static void expect_number(const Textured<float>& value, float factor, uint32_t image, uint32_t channel) {
        expect_textured(value, factor, image, channel, TextureEncoding::linear);
    }
    static void expect_color(const Textured<vec3>& value, vec3 factor, uint32_t image) {
        expect_textured(value, factor, image, RED, TextureEncoding::srgb);
    }
};

const Json A = {{"index", 0}};  // References to textures.
const Json B = {{"index", 1}};

TEST_F(GltfMaterial, AnEmptyOneHasTheDefaultsOfTheFormat) {
    const Material material = read(Json::object());
    const auto m = std::get<PrincipledMaterial>(material.model);
    EXPECT_EQ(material.name, "material 0");
    EXPECT_EQ(m.base_color, Textured<vec3>(vec3(1)));
    EXPECT_EQ(m.metalness, Textured<float>(1.0f));
    EXPECT_EQ(m.roughness, Textured<float>(1.0f));
    EXPECT_EQ(m.emission, Textured<vec3>(vec3(0)));
    EXPECT_EQ(m.ior, 1.5f);
    EXPECT_FALSE(m.double_sided);
    EXPECT_FALSE(m.unlit);
    EXPECT_FALSE(material.normal_map);
    EXPECT_EQ(material.opacity.value, Textured<float>(1.0f));
    EXPECT_FALSE(material.opacity.cutoff);
    // The same without any material.
    const Scene bare = load(corner_file());
    const auto d = std::get<PrincipledMaterial>(bare.materials.at(0).model);
    EXPECT_EQ(bare.materials[0].name, "(default)");
    EXPECT_EQ(d.base_color, m.base_color);
    EXPECT_EQ(d.metalness, m.metalness);
    EXPECT_EQ(d.roughness, m.roughness);
    EXPECT_FALSE(d.double_sided);
}

TEST_F(GltfMaterial, ReadsMetallicRoughness) {
    const Json pbr = {{"baseColorFactor", {0.1, 0.2, 0.3, 0.5}},
                      {"baseColorTexture", A},
                      {"metallicFactor", 0.25},
                      {"roughnessFactor", 0.75},
                      {"metallicRoughnessTexture", B}};
    const Material material = read({{"name", "clay"},
                                    {"pbrMetallicRoughness", pbr},
                                    {"normalTexture", {{"index", 1}, {"scale", 0.5}, {"texCoord", 1}}},
                                    {"occlusionTexture", A},
                                    {"doubleSided", true},
                                    {"emissiveFactor", {0.5, 0.25, 1}},
                                    {"emissiveTexture", B}});
    const auto m = std::get<PrincipledMaterial>(material.model);
    EXPECT_EQ(material.name, "clay");
    expect_color(m.base_color, vec3(0.1f, 0.2f, 0.3f), 0);
    expect_number(m.metalness, 0.25f, 1, 2);  // Blue,
    expect_number(m.roughness, 0.75f, 1, 1);  // green.
    expect_color(m.emission, vec3(0.5f, 0.25f, 1), 1);
    EXPECT_TRUE(m.double_sided);
    ASSERT_TRUE(material.normal_map);
    EXPECT_EQ(material.normal_map->scale, 0.5f);
    EXPECT_EQ(material.normal_map->texture.image, 1u);
    EXPECT_EQ(material.normal_map->texture.uv_set, 1u);
    EXPECT_EQ(material.normal_map->texture.encoding, TextureEncoding::linear);
    // Opaque, regardless of its alpha.
    EXPECT_EQ(material.opacity.value, Textured<float>(1.0f));
}

TEST_F(GltfMaterial, AlphaCountsByItsMode) {
    const auto opacity = [&](const Json& mode) {
        Json material = {
            {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}, {"baseColorTexture", A}}}};
        material.update(mode);
        return read(material).opacity;
    };
    EXPECT_EQ(opacity({{"alphaMode", "OPAQUE"}}).value, Textured<float>(1.0f));
    const Opacity blend = opacity({{"alphaMode", "BLEND"}});
    EXPECT_EQ(blend.value.factor, 0.5f);
    ASSERT_TRUE(blend.value.texture);
    EXPECT_EQ(blend.value.texture->channel, ALPHA);
    EXPECT_EQ(blend.value.texture->image, 0u);
    EXPECT_FALSE(blend.cutoff);
    EXPECT_EQ(opacity({{"alphaMode", "MASK"}}).cutoff, 0.5f);
    EXPECT_EQ(opacity({{"alphaMode", "MASK"}}).value, blend.value);
    EXPECT_EQ(opacity({{"alphaMode", "MASK"}, {"alphaCutoff", 0.125}}).cutoff, 0.125f);
    EXPECT_EQ(opacity({{"alphaMode", "MASK"}, {"alphaCutoff", 2}}).cutoff, 2.0f);
    expect_error(file_of({{"alphaMode", "GLASS"}}),
                 "#/materials/0/alphaMode: \"alphaMode\": expected \"OPAQUE\", "
                 "\"MASK\" or \"BLEND\", found \"GLASS\"");
}

TEST_F(GltfMaterial, ReadsExtensionsOfTheSurface) {
    EXPECT_EQ(extended("KHR_materials_ior", {{"ior", 1.25}}).ior, 1.25f);
    EXPECT_EQ(extended("KHR_materials_ior", Json::object()).ior, 1.5f);
    EXPECT_EQ(extended("KHR_materials_ior", {{"ior", 0}}).ior, 0.0f);
    const auto specular = extended("KHR_materials_specular", {{"specularFactor", 0.5},
                                                              {"specularTexture", A},
                                                              {"specularColorFactor", {0.1, 0.2, 0.3}},
                                                              {"specularColorTexture", B}});
    expect_number(specular.specular, 0.5f, 0, ALPHA);
    expect_color(specular.specular_color, vec3(0.1f, 0.2f, 0.3f), 1);
    const auto brushed =
        extended("KHR_materials_anisotropy",
                 {{"anisotropyStrength", 0.6}, {"anisotropyRotation", 7.0}, {"anisotropyTexture", A}});
    EXPECT_EQ(brushed.anisotropy, Textured<float>(0.6f));
    EXPECT_NEAR(brushed.anisotropy_rotation, 7.0 - 2.0 * std::acos(-1.0), 1e-6);
    ASSERT_TRUE(brushed.anisotropy_map);
    EXPECT_EQ(brushed.anisotropy_map->image, 0u);
    EXPECT_EQ(brushed.anisotropy_map->encoding, TextureEncoding::linear);
    const auto coated =
        extended("KHR_materials_clearcoat", {{"clearcoatFactor", 0.5},
                                             {"clearcoatTexture", A},
                                             {"clearcoatRoughnessFactor", 0.25},
                                             {"clearcoatRoughnessTexture", B},
                                             {"clearcoatNormalTexture", {{"index", 1}, {"scale", 2}}}});
    expect_number(coated.coat, 0.5f, 0, RED);
    expect_number(coated.coat_roughness, 0.25f, 1, 1);
    ASSERT_TRUE(coated.coat_normal_map);
    EXPECT_EQ(coated.coat_normal_map->scale, 2.0f);
    EXPECT_EQ(coated.coat_normal_map->texture.image, 1u);
    EXPECT_FALSE(extended("KHR_materials_clearcoat", {{"clearcoatNormalTexture", A}}).coat_normal_map);
    const auto velvet = extended("KHR_materials_sheen", {{"sheenColorFactor", {0.1, 0.2, 0.3}},
                                                         {"sheenColorTexture", A},
                                                         {"sheenRoughnessFactor", 0.75},
                                                         {"sheenRoughnessTexture", B}});
    expect_color(velvet.sheen_color, vec3(0.1f, 0.2f, 0.3f), 0);
    expect_number(velvet.sheen_roughness, 0.75f, 1, ALPHA);
    const auto soap = extended("KHR_materials_iridescence", {{"iridescenceFactor", 0.5},
                                                             {"iridescenceTexture", A},
                                                             {"iridescenceIor", 1.75},
                                                             {"iridescenceThicknessMinimum", 50},
                                                             {"iridescenceThicknessMaximum", 500},
                                                             {"iridescenceThicknessTexture", B}});
    expect_number(soap.iridescence, 0.5f, 0, RED);
    EXPECT_EQ(soap.iridescence_ior, 1.75f);
    EXPECT_EQ(soap.iridescence_thickness_min, 50.0f);
    expect_number(soap.iridescence_thickness, 500.0f, 1, 1);
    const auto plain = extended("KHR_materials_iridescence", Json::object());
    EXPECT_EQ(plain.iridescence, Textured<float>(0.0f));
    EXPECT_EQ(plain.iridescence_ior, 1.3f);
    EXPECT_EQ(plain.iridescence_thickness_min, 100.0f);
    EXPECT_EQ(plain.iridescence_thickness, Textured<float>(400.0f));
    Json bright = extension("KHR_materials_emissive_strength", {{"emissiveStrength", 20}});
    EXPECT_EQ(principled(bright).emission, Textured<vec3>(vec3(0)));
    bright["emissiveFactor"] = {0.5, 0.25, 0};
    EXPECT_EQ(principled(bright).emission, Textured<vec3>(vec3(10, 5, 0)));
}

TEST_F(GltfMaterial, ReadsExtensionsOfBodies) {
    const auto window =
        extended("KHR_materials_transmission", {{"transmissionFactor", 0.5}, {"transmissionTexture", A}});
    expect_number(window.transmission, 0.5f, 0, RED);
    EXPECT_FALSE(window.inside);
    const auto leaf =
        extended("KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 0.5},
                                                        {"diffuseTransmissionTexture", A},
                                                        {"diffuseTransmissionColorFactor", {0.1, 0.2, 0.3}},
                                                        {"diffuseTransmissionColorTexture", B}});
    expect_number(leaf.diffuse_transmission, 0.5f, 0, ALPHA);
    expect_color(leaf.diffuse_transmission_color, vec3(0.1f, 0.2f, 0.3f), 1);
    const auto body = [&](const Json& volume, double transmission = 1.0) {
        return principled({{"extensions",
                            {{"KHR_materials_transmission", {{"transmissionFactor", transmission}}},
                             {"KHR_materials_volume", volume},
                             {"KHR_materials_dispersion", {{"dispersion", 0.3}}}}}});
    };
    // What is left at the attenuation distance is the attenuation colour: exp(-absorption * distance).
    const Json wine = {
        {"thicknessFactor", 0.5}, {"attenuationDistance", 2}, {"attenuationColor", {0.5, 1, 0}}};
    const auto full = body(wine);
    ASSERT_TRUE(full.inside);
    EXPECT_NEAR(std::exp(-2.0 * double(full.inside->absorption.x)), 0.5, 1e-6);
    EXPECT_EQ(full.inside->absorption.y, 0.0f);
    EXPECT_LE(std::exp(-2.0 * double(full.inside->absorption.z)), 1.01e-6);
    EXPECT_TRUE(is_finite(full.inside->absorption));
    EXPECT_EQ(full.dispersion, 0.3f);
    const auto clear = body({{"thicknessFactor", 0.5}, {"attenuationColor", {0.5, 0.5, 0.5}}});
    ASSERT_TRUE(clear.inside);
    EXPECT_EQ(clear.inside->absorption, vec3(0));  // The distance is infinite.
    // Without thickness, a thin wall; without transmission, nothing is seen of the inside.
    EXPECT_FALSE(body({{"attenuationDistance", 2}}).inside);
    EXPECT_EQ(body({{"attenuationDistance", 2}}).dispersion, 0.0f);
    EXPECT_FALSE(body(wine, 0.0).inside);
    // What programs write for an infinite distance: nothing is lost.
    Json endless = wine;
    for (const Json& distance : {Json(nullptr), Json(3.4028235e38)}) {
        endless["attenuationDistance"] = distance;
        EXPECT_LE(body(endless).inside->absorption.z, 1e-37f);
    }
    endless["attenuationDistance"] = 0;
    expect_warning(file_of({{"extensions",
                             {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                              {"KHR_materials_volume", endless}}}}),
                   "#/materials/0/extensions/KHR_materials_volume/attenuationDistance: the distance is not "
                   "above 0, and is treated as infinite");
}

// The example of the extension's text, with a thickness.
TEST_F(GltfMaterial, SomeOfWhatTheMediumTakesIsScattered) {
    const auto body = [](const Json& volume) {
        return Json{{"extensions",
                     {{"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 1}}},
                      {"KHR_materials_volume", volume},
                      {"KHR_materials_volume_scatter",
                       {{"multiscatterColor", {0.572, 0, 1}}, {"scatterAnisotropy", 0.3}}}}}};
    };
    const Json dense{
        {"thicknessFactor", 1}, {"attenuationColor", {0.9, 0.9, 0.9}}, {"attenuationDistance", 0.01}};
    const auto skin = principled(body(dense));
    ASSERT_TRUE(skin.inside);
    const double extinction = -std::log(0.9) / 0.01;
    for (const int c : {0, 1, 2})
        EXPECT_NEAR(double(skin.inside->absorption[c] + skin.inside->scattering[c]), extinction,
                    1e-5 * extinction);
    // 1 - (4.09712 + 4.20863 c - sqrt(9.59217 + 41.6808 c + 17.7126 c^2))^2 of it.
    EXPECT_NEAR(double(skin.inside->scattering.x) / extinction, 0.94184, 1e-4);
    EXPECT_NEAR(double(skin.inside->scattering.y), 0.0, 1e-3);
    EXPECT_NEAR(double(skin.inside->absorption.z), 0.0, 1e-3);
    EXPECT_EQ(skin.inside->g, 0.3f);
    expect_warning(file_of(body({{"attenuationDistance", 1}})),
                   "#/materials/0/extensions/KHR_materials_volume_scatter: the volume has no thickness: the "
                   "surface is a "
                   "thin wall, within which nothing scatters");
}

TEST_F(GltfMaterial, AnUnlitOneShowsItsColourAlone) {
    Json unlit = extension("KHR_materials_unlit", Json::object());
    unlit["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 1}};
    unlit["pbrMetallicRoughness"] = {{"baseColorFactor", {0.1, 0.2, 0.3, 0.5}}, {"baseColorTexture", A}};
    unlit["emissiveFactor"] = {1, 1, 1};
    unlit["normalTexture"] = B;
    unlit["alphaMode"] = "BLEND";
    const Material material = read(unlit);
    const auto m = std::get<PrincipledMaterial>(material.model);
    EXPECT_TRUE(m.unlit);
    expect_color(m.base_color, vec3(0.1f, 0.2f, 0.3f), 0);
    EXPECT_EQ(material.opacity.value.factor, 0.5f);
    EXPECT_EQ(m.coat, Textured<float>(0.0f));
    EXPECT_EQ(m.emission, Textured<vec3>(vec3(0)));
    EXPECT_FALSE(material.normal_map);
}

// As KHR_materials_ior has it: an index of 0 reflects all light, times the specular colour.
TEST_F(GltfMaterial, GlossinessIsTheOppositeOfRoughness) {
    Json old = {{"diffuseFactor", {0.1, 0.2, 0.3, 0.5}},
                {"diffuseTexture", A},
                {"specularFactor", {0.4, 0.5, 0.6}},
                {"glossinessFactor", 0.75}};
    const char* name = "KHR_materials_pbrSpecularGlossiness";
    const auto plain = extended(name, old);
    expect_color(plain.base_color, vec3(0.1f, 0.2f, 0.3f), 0);
    EXPECT_EQ(plain.specular_color, Textured<vec3>(vec3(0.4f, 0.5f, 0.6f)));
    EXPECT_EQ(plain.roughness, Textured<float>(0.25f));
    EXPECT_EQ(plain.metalness, Textured<float>(0.0f));
    EXPECT_EQ(plain.ior, 0.0f);
    old["specularGlossinessTexture"] = B;
    const Scene scene = load(file_of(extension(name, old)));
    const auto m = std::get<PrincipledMaterial>(scene.materials.at(0).model);
    expect_color(m.specular_color, vec3(0.4f, 0.5f, 0.6f), 1);
    // Its image is a copy that becomes 1 - glossiness * alpha.
    ASSERT_EQ(scene.images.size(), 3u);
    expect_number(m.roughness, 1.0f, 2, RED);
    const TexelImage glossy{
        .size = {1, 1}, .channels = 2, .texels = {std::byte(9), std::byte(204)}, .gamma = {}};  // Alpha 0.8.
    ASSERT_TRUE(scene.images[2].convert);
    EXPECT_EQ(scene.images[2].convert(glossy).texels, std::vector{std::byte(102)});  // 1 - 0.6
    EXPECT_EQ(scene.images[2].path, scene.images[1].path);
    EXPECT_FALSE(scene.images[1].convert);
}

TEST_F(GltfMaterial, ValuesOutsideOfTheirRangesAreClampedWithAWarning) {
    EXPECT_EQ(clamped({{"pbrMetallicRoughness", {{"roughnessFactor", 1.5}}}},
                      "pbrMetallicRoughness/roughnessFactor: 1.5 is not between 0 and 1; it is read as 1")
                  .roughness.factor,
              1.0f);
    EXPECT_EQ(clamped({{"pbrMetallicRoughness", {{"metallicFactor", -0.5}}}},
                      "pbrMetallicRoughness/metallicFactor: -0.5 is not between 0 and 1; it is read as 0")
                  .metalness.factor,
              0.0f);
    EXPECT_EQ(
        clamped({{"pbrMetallicRoughness", {{"baseColorFactor", {2, 0.5, -1, 1}}}}},
                "pbrMetallicRoughness/baseColorFactor: a component is not between 0 and 1; it is clamped")
            .base_color.factor,
        vec3(1, 0.5f, 0));
    EXPECT_EQ(clamped({{"emissiveFactor", {0, -1, 2}}},
                      "emissiveFactor: -1 is not between 0 and 1e+30; it is read as 0")
                  .emission.factor,
              vec3(0, 0, 2));
    EXPECT_EQ(clamped(extension("KHR_materials_ior", {{"ior", 0.5}}),
                      "extensions/KHR_materials_ior/ior: 0.5 is not between 1 and 1e+06; it is read as 1")
                  .ior,
              1.0f);
    expect_error(
        file_of({{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1}}}}}),
        "#/materials/0/pbrMetallicRoughness/baseColorFactor: \"baseColorFactor\": expected four numbers, "
        "found [1, 1, 1]");
    expect_error(file_of({{"doubleSided", "yes"}}),
                 "#/materials/0/doubleSided: \"doubleSided\": expected true or false, found \"yes\"");
}

// KHR_materials_specular: f0 = min(((ior - 1) / (ior + 1))^2 * colour, 1).
TEST_F(GltfMaterial, SpecularColoursAboveOneRaiseTheReflection) {
    const auto reflection = [](const PrincipledMaterial& m) {
        const double r = m.ior == 0.0f ? 1.0 : (double(m.ior) - 1.0) / (double(m.ior) + 1.0);
        return r * r * dvec3(m.specular_color.factor);
    };
    const auto expect = [&](double ior, const std::vector<double>& color) {
        const auto m = principled({{"extensions",
                                    {{"KHR_materials_ior", {{"ior", ior}}},
                                     {"KHR_materials_specular", {{"specularColorFactor", color}}}}}});
        const double r = ior == 0.0 ? 1.0 : (ior - 1.0) / (ior + 1.0);
        for (int i = 0; i < 3; ++i) {
            // The index stays finite by stopping at 0.999.
            const double f0 = std::min(r * r * color[size_t(i)], 1.0);
            EXPECT_NEAR(reflection(m)[i], f0, f0 > 0.999 ? 1.1e-3 : 1e-6) << ior;
            EXPECT_LE(m.specular_color.factor[i], 1.0f);
        }
    };
    expect(1.5, {2, 1, 0.5});
    expect(1.5, {25, 24, 1});
    expect(1.5, {1000, 0, 0});
    expect(1.0, {3, 2, 1});
    expect(0.0, {3, 0.5, 1});
    Json glass = {{"extensions",
                   {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                    {"KHR_materials_volume", {{"thicknessFactor", 1}}},
                    {"KHR_materials_specular", {{"specularColorFactor", {2, 0.5, 1}}}}}}};
    const Scene scene = expect_warning(file_of(glass),
                                       "#/materials/0: a specular colour above 1 on a refracting "
                                       "body is read as 1");
    const auto m = std::get<PrincipledMaterial>(scene.materials.at(0).model);
    EXPECT_EQ(m.ior, 1.5f);
    EXPECT_EQ(m.specular_color.factor, vec3(1, 0.5f, 1));
}

}  // namespace
}  // namespace candela
