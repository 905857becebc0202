// Principled materials of a scene file, and their kin "rough_conductor" and "rough_dielectric".
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "base/text.h"
#include "scene/materials.h"
#include "support/png_writer.h"
#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

class ScenePrincipled : public testing::Test {
  protected:
    ScenePrincipled() {
        folder_.write(
            "a.png", encode_png({.size = uvec2(1), .bits = 8, .color = png_rgb, .samples = {128, 128, 255}}));
    }

    // A scene with the material "m" of these members, and these shapes.
    static std::string scene(const std::string& members, const std::string& shapes = "") {
        return "{" + GOOD_CAMERA + ",\n\"materials\": {\"m\": {" + members + "}},\n\"shapes\": [" + shapes +
               "]}";
    }
    static std::string principled(const std::string& members) {
        return scene(R"("type": "principled")" + (members.empty() ? "" : ", " + members));
    }
    // The material that is read from a scene.
    PrincipledMaterial load(const std::string& text) {
        return std::get<PrincipledMaterial>(folder_.load(text).materials.at(0).model);
    }
    void expect_error(const std::string& members, const std::string& message) {
        folder_.expect_error(principled(members), message);
    }

    SceneFolder folder_;
};

const std::string TRANSPARENT = R"("transmission": 1, "thin_walled": false, )";

// A mesh of the material "m" with these members more.
std::string mesh_of_m(const std::string& members) {
    return R"({"type": "mesh", "material": "m", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
               "triangles": [[0, 1, 2]])" +
           members + "}";
}

TEST_F(ScenePrincipled, IsPlasticByDefault) {
    const PrincipledMaterial m = load(principled(""));
    EXPECT_EQ(m.base_color, vec3(0.8f));
    EXPECT_EQ(m.specular_color, vec3(1));
    EXPECT_EQ(m.diffuse_transmission_color, vec3(1));
    EXPECT_EQ(m.sheen_color, vec3(0));
    EXPECT_EQ(m.fuzz_color, vec3(1));
    EXPECT_EQ(m.emission, vec3(0));
    EXPECT_EQ(m.roughness, 0.5f);
    EXPECT_EQ(m.fuzz_roughness, 0.5f);
    EXPECT_EQ(m.specular, 1.0f);
    EXPECT_EQ(m.ior, 1.5f);
    EXPECT_EQ(m.coat_ior, 1.5f);
    EXPECT_EQ(m.iridescence_ior, 1.3f);
    EXPECT_EQ(m.iridescence_thickness, 400.0f);
    EXPECT_EQ(m.iridescence_thickness_min, 100.0f);
    for (const Textured<float>& value :
         {m.metalness, m.diffuse_roughness, m.anisotropy, m.transmission, m.diffuse_transmission, m.coat,
          m.coat_roughness, m.sheen_roughness, m.fuzz, m.iridescence})
        EXPECT_EQ(value, 0.0f);
    for (const float value : {m.anisotropy_rotation, m.dispersion, m.coat_darkening})
        EXPECT_EQ(value, 0.0f);
    EXPECT_FALSE(m.anisotropy_map);
    EXPECT_FALSE(m.coat_normal_map);
    EXPECT_FALSE(m.inside);
    EXPECT_EQ(m.priority, 0u);
    EXPECT_FALSE(m.unlit);
    EXPECT_TRUE(m.double_sided);
}

TEST_F(ScenePrincipled, ReadsAllKeys) {
    const PrincipledMaterial m = load(principled(
        R"("base_color": [0.1, 0.2, 0.3], "metalness": 0.25, "roughness": 0.375, "diffuse_roughness": 0.125,
           "ior": 1.75, "specular": 0.5, "specular_color": [1, 0.5, 0.25], "anisotropy": 0.625,
           "anisotropy_rotation": 90, "anisotropy_map": {"image": "a.png"}, "transmission": 0.75,
           "absorption": {"transmittance": [0.5, 1, 0.25], "distance": 0.1}, "priority": 3, "dispersion": 0.5,
           "diffuse_transmission": 0.0625, "diffuse_transmission_color": [0.5, 0.25, 0], "coat": 0.875,
           "coat_roughness": 0.03125, "coat_ior": 1.625, "coat_darkening": 0.6875,
           "coat_normal_map": {"image": "a.png", "scale": 2}, "sheen_color": [0, 1, 0.5],
           "sheen_roughness": 0.1875, "fuzz": 0.5625, "fuzz_color": [0.5, 0, 1], "fuzz_roughness": 0.4375,
           "iridescence": 0.3125, "iridescence_ior": 1.25,
           "iridescence_thickness": {"image": "a.png", "factor": 500}, "iridescence_thickness_min": 200,
           "emission": [1, 2, 3], "unlit": false, "double_sided": false)"));
    EXPECT_EQ(m.base_color, vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.metalness, 0.25f);
    EXPECT_EQ(m.roughness, 0.375f);
    EXPECT_EQ(m.diffuse_roughness, 0.125f);
    EXPECT_EQ(m.ior, 1.75f);
    EXPECT_EQ(m.specular, 0.5f);
    EXPECT_EQ(m.specular_color, vec3(1, 0.5f, 0.25f));
    EXPECT_EQ(m.anisotropy, 0.625f);
    EXPECT_EQ(m.anisotropy_rotation, 0.5f * PI);
    EXPECT_EQ(m.anisotropy_map, Texture{});
    EXPECT_EQ(m.transmission, 0.75f);
    // ln 2 / 0.1 m, 0, and twice the first.
    EXPECT_EQ(m.inside, Medium{vec3(6.9314718056f, 0.0f, 13.8629436112f)});
    EXPECT_EQ(m.priority, 3u);
    EXPECT_EQ(m.dispersion, 0.5f);
    EXPECT_EQ(m.diffuse_transmission, 0.0625f);
    EXPECT_EQ(m.diffuse_transmission_color, vec3(0.5f, 0.25f, 0));
    EXPECT_EQ(m.coat, 0.875f);
    EXPECT_EQ(m.coat_roughness, 0.03125f);
    EXPECT_EQ(m.coat_ior, 1.625f);
    EXPECT_EQ(m.coat_darkening, 0.6875f);
    ASSERT_TRUE(m.coat_normal_map);
    EXPECT_EQ(m.coat_normal_map->scale, 2.0f);
    EXPECT_EQ(m.coat_normal_map->texture, Texture{});
    EXPECT_EQ(m.sheen_color, vec3(0, 1, 0.5f));
    EXPECT_EQ(m.sheen_roughness, 0.1875f);
    EXPECT_EQ(m.fuzz, 0.5625f);
    EXPECT_EQ(m.fuzz_color, vec3(0.5f, 0, 1));
    EXPECT_EQ(m.fuzz_roughness, 0.4375f);
    EXPECT_EQ(m.iridescence, 0.3125f);
    EXPECT_EQ(m.iridescence_ior, 1.25f);
    EXPECT_EQ(m.iridescence_thickness.factor, 500.0f);
    EXPECT_EQ(m.iridescence_thickness_min, 200.0f);
    EXPECT_EQ(m.emission, vec3(1, 2, 3));
    EXPECT_FALSE(m.unlit);
    EXPECT_FALSE(m.double_sided);
}

TEST_F(ScenePrincipled, TakesTexturesInEverySlot) {
    using Color = Textured<vec3> PrincipledMaterial::*;
    using Number = Textured<float> PrincipledMaterial::*;
    using M = PrincipledMaterial;
    const std::pair<const char*, Color> colors[] = {
        {"base_color", &M::base_color},
        {"specular_color", &M::specular_color},
        {"sheen_color", &M::sheen_color},
        {"fuzz\": 1, \"fuzz_color", &M::fuzz_color},
        {"emission", &M::emission},
        {"diffuse_transmission\": 1, \"diffuse_transmission_color", &M::diffuse_transmission_color}};
    const std::pair<const char*, Number> numbers[] = {
        {"metalness", &M::metalness},
        {"roughness", &M::roughness},
        {"diffuse_roughness", &M::diffuse_roughness},
        {"specular", &M::specular},
        {"anisotropy", &M::anisotropy},
        {"transmission", &M::transmission},
        {"diffuse_transmission", &M::diffuse_transmission},
        {"coat", &M::coat},
        {"coat\": 1, \"coat_roughness", &M::coat_roughness},
        {"sheen_color\": 1, \"sheen_roughness", &M::sheen_roughness},
        {"fuzz", &M::fuzz},
        {"fuzz\": 1, \"fuzz_roughness", &M::fuzz_roughness},
        {"iridescence", &M::iridescence},
        {"iridescence\": 1, \"iridescence_thickness", &M::iridescence_thickness}};
    const auto with_image = [](const std::string& key) {
        return principled('"' + key + R"(": {"image": "a.png", "factor": 0.5, "channel": "blue"})");
    };
    for (const auto& [key, value] : colors) {
        SCOPED_TRACE(key);
        const Textured<vec3> read = load(with_image(key)).*value;
        EXPECT_EQ(read, Textured<vec3>(vec3(0.5f), {.encoding = TextureEncoding::srgb, .channel = 2}));
    }
    for (const auto& [key, value] : numbers) {
        SCOPED_TRACE(key);
        const Textured<float> read = load(with_image(key)).*value;
        EXPECT_EQ(read, Textured<float>(0.5f, {.encoding = TextureEncoding::linear, .channel = 2}));
    }
}

TEST_F(ScenePrincipled, ChecksWeightsAndColours) {
    for (const std::string key :
         {"metalness", "roughness", "diffuse_roughness", "specular", "anisotropy", "transmission",
          "diffuse_transmission", "coat", "coat_roughness", "coat_darkening", "sheen_roughness", "fuzz",
          "fuzz_roughness", "iridescence"}) {
        const std::string with = R"("coat": 0, "sheen_color": 0, "fuzz": 0, )";
        const std::string before = with.find('"' + key + '"') == std::string::npos ? with : "";
        const std::string expected = '"' + key + "\": expected a number from 0 to 1, found ";
        expect_error(before + '"' + key + "\": @1.5", expected + "1.5");
        expect_error(before + '"' + key + "\": @-0.5", expected + "-0.5");
    }
    for (const std::string key :
         {"base_color", "specular_color", "sheen_color", "fuzz_color", "diffuse_transmission_color"}) {
        expect_error("\"diffuse_transmission\": 1, \"fuzz\": 1, \"" + key + "\": @[1, 2, 0]",
                     '"' + key + "\": expected numbers from 0 to 1, found [1, 2, 0]");
    }
    expect_error("\"emission\": @-1", "\"emission\": expected numbers of at least 0, found -1");
    expect_error("\"unlit\": @1", "\"unlit\": expected true or false, found 1");
    expect_error("\"double_sided\": @1", "\"double_sided\": expected true or false, found 1");
    expect_error(R"("roughness": {"image": "a.png", "factor": @2})",
                 "\"factor\": expected a number from 0 to 1, found 2");
}

TEST_F(ScenePrincipled, ChecksIndicesAndThicknesses) {
    EXPECT_EQ(load(principled("\"ior\": 0")).ior, 0.0f);
    EXPECT_EQ(load(principled("\"ior\": 1")).ior, 1.0f);
    EXPECT_EQ(load(principled("\"ior\": 1e6")).ior, 1e6f);
    const std::string ior =
        "\"ior\": expected a number from 1 to 1e6, or 0 for a surface that reflects all light, found ";
    expect_error("\"ior\": @0.5", ior + "0.5");
    expect_error("\"ior\": @-1", ior + "-1");
    expect_error("\"ior\": @1000001", ior + "1000001");
    expect_error("\"coat\": 1, \"coat_ior\": @0.5",
                 "\"coat_ior\": expected a number from 1 to 1e+06, found 0.5");
    expect_error("\"iridescence\": 1, \"iridescence_ior\": @0.5",
                 "\"iridescence_ior\": expected a number from 1 to 1e+06, found 0.5");
    expect_error("\"iridescence\": 1, \"iridescence_thickness\": @-1",
                 "\"iridescence_thickness\": expected a number from 0 to 1e+06, found -1");
    expect_error(R"("iridescence": 1, "iridescence_thickness": @{"image": "a.png"})",
                 "the key \"factor\" is missing here; add it");
    expect_error(R"("iridescence": 1, "iridescence_thickness_min": @-1)",
                 "\"iridescence_thickness_min\": expected a number from 0 to 1e+06, found -1");
    expect_error(
        R"("iridescence": 1, "iridescence_thickness": 300, "iridescence_thickness_min": @100)",
        "iridescence_thickness_min is the thickness where an image is 0; give \"iridescence_thickness\" an "
        "image, or remove this key");
    expect_error(TRANSPARENT + "\"dispersion\": @41",
                 "\"dispersion\": expected a number from 0 to 40, found 41");
    EXPECT_EQ(load(principled(TRANSPARENT + "\"dispersion\": 40")).dispersion, 40.0f);
}

TEST_F(ScenePrincipled, ThePartsOfALayerNeedTheLayer) {
    const std::tuple<const char*, const char*, const char*> parts[] = {
        {"anisotropy_rotation", "45", "anisotropy"},
        {"anisotropy_map", R"({"image": "a.png"})", "anisotropy"},
        {"diffuse_transmission_color", "1", "diffuse_transmission"},
        {"coat_roughness", "0.1", "coat"},
        {"coat_ior", "1.4", "coat"},
        {"coat_darkening", "1", "coat"},
        {"coat_normal_map", R"({"image": "a.png"})", "coat"},
        {"sheen_roughness", "0.5", "sheen_color"},
        {"fuzz_color", "0.5", "fuzz"},
        {"fuzz_roughness", "0.5", "fuzz"},
        {"iridescence_ior", "1.4", "iridescence"},
        {"iridescence_thickness", "300", "iridescence"},
        {"iridescence_thickness_min", "300", "iridescence"}};
    for (const auto& [key, value, layer] : parts) {
        expect_error(concat('"', key, "\": @", value),
                     concat(key, " has no effect without \"", layer, "\"; add that key, or remove this one"));
    }
    // A layer that is switched off may keep its parts.
    EXPECT_EQ(load(principled("\"coat\": 0, \"coat_roughness\": 0.25")).coat_roughness, 0.25f);
}

TEST_F(ScenePrincipled, IsAThinWallUnlessItHasAMediumInside) {
    EXPECT_FALSE(load(principled("\"transmission\": 1")).inside);
    EXPECT_FALSE(load(principled("\"transmission\": 1, \"thin_walled\": true")).inside);
    EXPECT_FALSE(load(principled("\"thin_walled\": true")).inside);
    EXPECT_EQ(load(principled("\"transmission\": 1, \"thin_walled\": false")).inside, Medium{});
    const std::string absorption = R"("absorption": {"transmittance": 0.5, "distance": 1})";
    const Medium smoke{vec3(0.69314718056f)};
    EXPECT_EQ(load(principled("\"diffuse_transmission\": 1, " + absorption)).inside, smoke);
    EXPECT_EQ(load(principled(TRANSPARENT + absorption)).inside, smoke);

    expect_error("\"transmission\": 1, \"thin_walled\": @true, " + absorption,
                 "a thin wall has no inside that could absorb or scatter light; remove thin_walled, or "
                 "\"absorption\" and \"scattering\"");
    expect_error("\"transmission\": 1, \"priority\": @1",
                 "priority ranks the medium inside, and a thin wall has none; add \"absorption\" or "
                 "\"thin_walled\": false, or remove priority");
    expect_error(TRANSPARENT + "\"priority\": @16",
                 "\"priority\": expected a whole number from 0 to 15, found 16");
    expect_error(
        "\"transmission\": 1, \"dispersion\": @0.1",
        "a thin wall does not bend light, so it does not disperse it; add \"absorption\" or \"thin_walled\": "
        "false, or remove dispersion");
    const std::string unreached =
        "no light reaches the medium inside; add \"transmission\" or \"diffuse_transmission\", or make the "
        "surface a thin wall";
    expect_error("\"thin_walled\": @false", unreached);
    expect_error(R"("absorption": @{"transmittance": 0.5, "distance": 1})", unreached);
    expect_error(
        TRANSPARENT + "\"ior\": @0",
        "an ior of 0 reflects all light, so that none reaches the medium inside; give the medium's own "
        "index, or make the surface a thin wall");
    expect_error(TRANSPARENT + R"("absorption": @{"transmittance": 0.5})",
                 "the key \"distance\" is missing here; add it");
}

TEST_F(ScenePrincipled, ShowsItsBaseColourWhereUnlit) {
    const Scene sign = folder_.load(scene(
        R"("type": "principled", "unlit": true, "base_color": 0.5, "double_sided": false, "opacity": 0.5,
                 "vertex_colors": true)",
        R"({"type": "sphere", "material": "m"})"));
    EXPECT_TRUE(std::get<PrincipledMaterial>(sign.materials.at(0).model).unlit);
    EXPECT_TRUE(sign.warnings.empty());  // It needs no light.
    const std::string rest =
        " has no effect on an unlit material, which shows its base_color; remove it, or \"unlit\"";
    expect_error("\"unlit\": true, \"roughness\": @0.5", "roughness" + rest);
    expect_error("\"emission\": @1, \"unlit\": true", "emission" + rest);
    folder_.expect_warning("{" + GOOD_CAMERA + R"(, "materials": {"m": {"type": "principled"}},
        "shapes": @[{"type": "sphere", "material": "m"}]})",
                           "the scene has no light: the image will be black");
}

TEST_F(ScenePrincipled, ShapesEmitWhatTheirMaterialDoes) {
    const auto emission = [&](const std::string& members, const std::string& shape) {
        return folder_
            .load(scene(R"("type": "principled", )" + members,
                        R"({"type": "sphere", "material": "m")" + shape + "}"))
            .shapes.at(0)
            .emission;
    };
    const auto both = emission(R"("emission": [1, 2, 3])", "");
    ASSERT_TRUE(both);
    EXPECT_EQ(both->radiance, vec3(1, 2, 3));
    EXPECT_TRUE(both->two_sided);
    const auto front = emission(R"("emission": {"image": "a.png", "factor": 7}, "double_sided": false)", "");
    ASSERT_TRUE(front);
    EXPECT_EQ(front->radiance.factor, vec3(7));
    EXPECT_TRUE(front->radiance.texture);
    EXPECT_FALSE(front->two_sided);
    // A shape's own emission is used.
    const auto own = emission(R"("emission": 1)", ", \"emission\": 5");
    ASSERT_TRUE(own);
    EXPECT_EQ(own->radiance, vec3(5));
    EXPECT_FALSE(own->two_sided);
    EXPECT_FALSE(emission(R"("emission": 1)", ", \"emission\": 0"));
    EXPECT_FALSE(emission(R"("emission": 0)", ""));
    EXPECT_FALSE(emission(R"("emission": {"image": "a.png", "factor": 0})", ""));
}

TEST_F(ScenePrincipled, MeshesGetTheTangentsThatItNeeds) {
    const std::string uvs = R"(, "uvs": [[0, 0], [1, 0], [0, 1]], "uvs1": [[0, 0], [0, -1], [1, 0]])";
    const auto tangents = [&](const std::string& members) {
        const Scene read = folder_.load(scene(R"("type": "principled", )" + members, mesh_of_m(uvs)));
        EXPECT_EQ(needs_tangents(read.materials.at(0)), !read.meshes.at(0).tangents.empty());
        return read.meshes.at(0).tangents;
    };
    const vec4 along_x(1, 0, 0, 1), along_y(0, 1, 0, 1);
    EXPECT_TRUE(tangents("\"roughness\": 0.1").empty());
    EXPECT_TRUE(tangents("\"anisotropy\": 0, \"anisotropy_map\": {\"image\": \"a.png\"}").empty());
    EXPECT_TRUE(tangents("\"base_color\": {\"image\": \"a.png\"}").empty());
    EXPECT_EQ(tangents("\"anisotropy\": 0.5").at(0), along_x);
    EXPECT_EQ(tangents(R"("anisotropy": {"image": "a.png"})").at(0), along_x);
    EXPECT_EQ(tangents(R"("anisotropy": {"image": "a.png", "uv_set": 1})").at(0), along_y);
    EXPECT_EQ(tangents(R"("anisotropy": 1, "anisotropy_map": {"image": "a.png", "uv_set": 1})").at(0),
              along_y);
    EXPECT_EQ(tangents(R"("coat": 1, "coat_normal_map": {"image": "a.png", "uv_set": 1})").at(0), along_y);
    // The first of normal map, coat and anisotropy decides.
    EXPECT_EQ(tangents(R"("normal_map": {"image": "a.png"}, "coat": 1,
        "coat_normal_map": {"image": "a.png", "uv_set": 1})")
                  .at(0),
              along_x);
    EXPECT_EQ(
        tangents(R"("coat": 1, "coat_normal_map": {"image": "a.png", "uv_set": 1}, "anisotropy": 1)").at(0),
        along_y);
}

TEST_F(ScenePrincipled, AnisotropicMeshesNeedCoordinates) {
    const auto refuse = [&](const std::string& members, const std::string& message) {
        folder_.expect_error(scene(R"("type": "principled", )" + members, '@' + mesh_of_m("")), message);
    };
    refuse("\"anisotropy\": 0.5",
           "the material \"m\" is anisotropic, but the mesh has no texture coordinates to say along which "
           "direction; export it with them, or use a material without anisotropy");
    const std::string textures =
        "the material \"m\" has textures, but the mesh has no texture coordinates; export it with them, or "
        "use "
        "a material without textures";
    refuse(R"("anisotropy": {"image": "a.png"})", textures);
    refuse(R"("coat": 1, "coat_normal_map": {"image": "a.png"})", textures);
    EXPECT_EQ(folder_.load(scene(R"("type": "principled", "anisotropy": 0)", mesh_of_m(""))).shapes.size(),
              1u);
}

TEST_F(ScenePrincipled, WarnsOfANormalMapOfTheCoatThatIsNone) {
    folder_.write("b.png", encode_png({.size = uvec2(1), .bits = 8, .color = png_grey, .samples = {0}}));
    const Scene read = folder_.load(principled(R"("coat": 1, "coat_normal_map": {"image": "b.png"})"));
    ASSERT_EQ(read.warnings.size(), 2u);  // And that the scene is empty.
    EXPECT_NE(read.warnings[1].find(": the coat's normal map of the material \"m\", "), std::string::npos)
        << read.warnings[1];
}

TEST_F(ScenePrincipled, ReadsRoughConductors) {
    const PrincipledMaterial gold = load(scene(
        R"("type": "rough_conductor", "reflectance": [1, 0.75, 0.25], "roughness": 0, "anisotropy": 0.5,
           "anisotropy_rotation": -90)"));
    EXPECT_EQ(gold.base_color, vec3(1, 0.75f, 0.25f));
    EXPECT_EQ(gold.metalness, 1.0f);
    EXPECT_EQ(gold.roughness, 0.0f);
    EXPECT_EQ(gold.anisotropy, 0.5f);
    EXPECT_EQ(gold.anisotropy_rotation, -0.5f * PI);
    const PrincipledMaterial worn = load(scene(
        R"("type": "rough_conductor", "reflectance": {"image": "a.png"}, "roughness": {"image": "a.png"})"));
    EXPECT_TRUE(worn.base_color.texture);
    EXPECT_TRUE(worn.roughness.texture);

    const auto refuse = [&](const std::string& text, const std::string& message) {
        folder_.expect_error(settings(GOOD_CAMERA + ", \"materials\": {\"m\": " + text + "}"), message);
    };
    refuse(R"(@{"type": "rough_conductor", "reflectance": 1})",
           "the key \"roughness\" is missing here; add it");
    refuse(R"(@{"type": "rough_conductor", "roughness": 1})",
           "the key \"reflectance\" is missing here; add it");
    refuse(R"({"type": "rough_conductor", "reflectance": 1, "roughness": @2})",
           "\"roughness\": expected a number from 0 to 1, found 2");
    refuse(R"({"type": "rough_conductor", "reflectance": 1, "roughness": 1, "anisotropy_rotation": @5})",
           "anisotropy_rotation has no effect without \"anisotropy\"; add that key, or remove this one");
    refuse(R"({"type": "rough_conductor", "reflectance": 1, "roughness": 1, @"alpha": 1})",
           "unknown key \"alpha\" (known: type, reflectance, roughness, anisotropy, anisotropy_rotation, "
           "normal_map, bump_map, opacity, vertex_colors)");
}

TEST_F(ScenePrincipled, ReadsRoughDielectrics) {
    const PrincipledMaterial frosted =
        load(scene(R"("type": "rough_dielectric", "ior": 1.52, "roughness": 0.25)"));
    EXPECT_EQ(frosted.base_color, vec3(1));
    EXPECT_EQ(frosted.metalness, 0.0f);
    EXPECT_EQ(frosted.transmission, 1.0f);
    EXPECT_EQ(frosted.ior, 1.52f);
    EXPECT_EQ(frosted.roughness, 0.25f);
    EXPECT_EQ(frosted.inside, Medium{});
    EXPECT_FALSE(
        load(scene(R"("type": "rough_dielectric", "ior": 1.5, "roughness": 0, "thin_walled": true)")).inside);
    const PrincipledMaterial bottle =
        load(scene(R"("type": "rough_dielectric", "ior": 1.5, "roughness": 0.1, "priority": 2,
                      "absorption": {"transmittance": 0.5, "distance": 1})"));
    EXPECT_EQ(bottle.inside, Medium{vec3(0.69314718056f)});
    EXPECT_EQ(bottle.priority, 2u);

    const auto refuse = [&](const std::string& text, const std::string& message) {
        folder_.expect_error(settings(GOOD_CAMERA + ", \"materials\": {\"m\": " + text + "}"), message);
    };
    refuse(R"({"type": "rough_dielectric", "roughness": 0, "ior": @0.5})",
           "\"ior\": expected a number from 1 to 1e+06, found 0.5");
    refuse(R"(@{"type": "rough_dielectric", "roughness": 0})", "the key \"ior\" is missing here; add it");
    refuse(R"(@{"type": "rough_dielectric", "ior": 1})", "the key \"roughness\" is missing here; add it");
    refuse(R"({"type": "rough_dielectric", "ior": 1.5, "roughness": 0, "thin_walled": @true,
               "absorption": {"transmittance": 0.5, "distance": 1}})",
           "a thin wall has no inside that could absorb or scatter light; remove thin_walled, or "
           "\"absorption\" and \"scattering\"");
    refuse(
        R"({"type": "rough_dielectric", "ior": 1.5, "roughness": 0, "thin_walled": true, "priority": @1})",
        "priority ranks the medium inside, and a thin wall has none; add \"absorption\" or \"thin_walled\": "
        "false, or remove priority");
}

TEST_F(ScenePrincipled, ReadsSubsurface) {
    const auto skin = load(
        principled(R"("subsurface": {"color": 0.5, "radius": [1, 0.5, 0.25], "g": 0.25, "weight": 0.75})"));
    EXPECT_EQ(skin.diffuse_transmission.factor, 0.75f);
    EXPECT_EQ(skin.diffuse_transmission_color.factor, vec3(1));
    ASSERT_TRUE(skin.inside);
    const vec3 extinction = skin.inside->scattering + skin.inside->absorption;
    EXPECT_NEAR(extinction.x, 1.0f, 1e-6f);
    EXPECT_NEAR(extinction.z, 4.0f, 1e-6f);
    EXPECT_EQ(skin.inside->g, 0.25f);
    // (1 - s^2) / (1 - g s^2), with s = 0.2971 for this colour.
    EXPECT_NEAR(skin.inside->scattering.x, 0.9323f, 1e-4f);
    // A thin wall scatters (1 + g) / 2 forwards.
    const auto leaf = load(principled(
        R"("base_color": 0.2, "thin_walled": true, "subsurface": {"color": 0.5, "radius": 1, "g": 0.5, "weight": 0.5})"));
    EXPECT_FALSE(leaf.inside);
    EXPECT_EQ(leaf.diffuse_transmission.factor, 0.375f);
    EXPECT_EQ(leaf.diffuse_transmission_color.factor, vec3(0.5f));
    EXPECT_NEAR(leaf.base_color.factor.x, (0.5f * 0.2f + 0.125f * 0.5f) / 0.625f, 1e-6f);
    const std::string subsurface = R"("subsurface": {"color": 0.5, "radius": 1}, )";
    expect_error(subsurface + "\"diffuse_transmission\": @1",
                 "\"subsurface\" says this, too; remove it, or diffuse_transmission");
    expect_error(subsurface + R"("scattering": @{"coefficient": 1})",
                 "\"subsurface\" says this, too; remove it, or scattering");
    expect_error(R"("subsurface": @{"color": 0.5})", "the key \"radius\" is missing here; add it");
}

}  // namespace
}  // namespace candela
