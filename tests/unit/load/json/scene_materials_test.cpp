// Materials of a scene file: what each type reads, and what it refuses.
#include <gtest/gtest.h>

#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

// A scene with the material "m".
std::string material(const std::string& value) {
    return settings(GOOD_CAMERA + ",\n\"materials\": {\"m\": " + value + "}");
}

// The material that is read from the text.
template <class Model>
Model material(const std::string& value) {
    SceneFolder folder;
    const Scene scene = folder.load(material(value));
    EXPECT_EQ(scene.materials.at(0).name, "m");
    return std::get<Model>(scene.materials.at(0).model);
}

TEST(SceneMaterials, AreFoundByName) {
    SceneFolder folder;
    const std::string box = R"({"type": "box", "min": [0, 0, 0], "max": [1, 1, 1], "material": )";
    folder.expect_error(scene_of(box + "@\"glas\"}"),
                        "unknown material \"glas\" (did you mean \"glass\"? defined: glass, white)");
    folder.expect_error(scene_of(box + "@\"(black)\"}"),
                        "unknown material \"(black)\" (defined: glass, white)");
    folder.expect_error(
        "{" + GOOD_CAMERA + R"(, "materials": {"b": {"type": "mirror"}, "a": {"type": "mirror"}},
        "shapes": [{"type": "sphere", "emission": 1}, {"type": "sphere", "material": @"marble"}]})",
        "unknown material \"marble\" (defined: b, a)");
}

TEST(SceneMaterials, HaveAKnownType) {
    SceneFolder folder;
    folder.expect_error(
        material(R"({"type": @"difuse", "reflectance": 1})"),
        "unknown type \"difuse\" (did you mean \"diffuse\"? known: diffuse, phong, mirror, "
        "conductor, dielectric, diffuse_transmission, interface, principled, rough_conductor, "
        "rough_dielectric)");
    folder.expect_error(material(R"(@{"reflectance": 1})"), "the key \"type\" is missing here; add it");
    folder.expect_error(
        material(R"({"type": "mirror", @"alpha": 0.1})"),
        "unknown key \"alpha\" (known: type, reflectance, normal_map, bump_map, opacity, vertex_colors)");
}

TEST(SceneMaterials, ReadDiffuse) {
    EXPECT_EQ(material<DiffuseMaterial>(R"({"type": "diffuse", "reflectance": 0.25})").reflectance,
              vec3(0.25f));
    SceneFolder folder;
    folder.expect_error(material(R"({"type": "diffuse", "reflectance": @[0.5, 0.5, 1.01]})"),
                        "\"reflectance\": expected numbers from 0 to 1, found [0.5, 0.5, 1.01]");
    folder.expect_error(material(R"({"type": "diffuse", "reflectance": @-0.25})"),
                        "\"reflectance\": expected numbers of at least 0, found -0.25");
    folder.expect_error(material(R"({"type": "diffuse", "reflectance": @"white"})"),
                        "\"reflectance\": expected one grey number or three [r, g, b], found \"white\"");
    folder.expect_error(material(R"({"type": "diffuse", "reflectance": @[1, 1]})"),
                        "\"reflectance\": expected three numbers, found [1, 1]");
    folder.expect_error(material(R"(@{"type": "diffuse"})"),
                        "the key \"reflectance\" is missing here; add it");
}

TEST(SceneMaterials, ReadPhong) {
    const auto phong = material<PhongMaterial>(
        R"({"type": "phong", "diffuse": [0.1, 0.2, 0.3], "specular": 0.5, "exponent": 12.5})");
    EXPECT_EQ(phong.diffuse, vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(phong.specular, vec3(0.5f));
    EXPECT_EQ(phong.exponent, 12.5f);
    const auto polished = material<PhongMaterial>(R"({"type": "phong", "specular": 1, "exponent": 1e5})");
    EXPECT_EQ(polished.diffuse, vec3(0));
    EXPECT_EQ(polished.exponent, 1e5f);
    EXPECT_EQ(material<PhongMaterial>(R"({"type": "phong", "specular": 1, "exponent": 0})").exponent, 0.0f);

    SceneFolder folder;
    const std::string exponent = "\"exponent\": expected a number from 0 to 100000, found ";
    folder.expect_error(material(R"({"type": "phong", "specular": 1, "exponent": @-1})"), exponent + "-1");
    folder.expect_error(material(R"({"type": "phong", "specular": 1, "exponent": @100001})"),
                        exponent + "100001");
    folder.expect_error(material(R"(@{"type": "phong", "specular": 1})"),
                        "the key \"exponent\" is missing here; add it");
    folder.expect_error(material(R"(@{"type": "phong", "diffuse": 1, "exponent": 1})"),
                        "the key \"specular\" is missing here; add it");
    folder.expect_error(material(R"({"type": "phong", "specular": 0, "diffuse": @1.5, "exponent": 1})"),
                        "\"diffuse\": expected numbers from 0 to 1, found 1.5");
}

TEST(SceneMaterials, PhongMakesNoLight) {
    SceneFolder folder;
    const auto phong = [](const std::string& diffuse, const std::string& specular) {
        return material("{\"type\": \"phong\", \"exponent\": 9, \"diffuse\": " + diffuse +
                        ", \"specular\": @" + specular + "}");
    };
    const std::string remedy = "; lower one of the two until the sum is at most 1";
    folder.expect_error(phong("0.75", "0.5"), "diffuse + specular is 1.25 in red" + remedy);
    folder.expect_error(phong("[0, 0.7, 0]", "[1, 0.4, 1]"), "diffuse + specular is 1.1 in green" + remedy);
    folder.expect_error(phong("[0, 0, 0.9]", "0.100000000001"),
                        "diffuse + specular is 1.000000000001 in blue" + remedy);
}

// Decimals that add up to 1 are always accepted, and add up to at most 1 as floats.
TEST(SceneMaterials, PhongMayReflectAllLight) {
    constexpr int STEPS = 1000;
    std::string members;
    for (int i = 0; i <= STEPS; ++i) {
        const auto decimal = [](int thousandths) {
            const std::string digits = std::to_string(thousandths);
            return thousandths == STEPS ? "1" : "0." + std::string(3 - digits.size(), '0') + digits;
        };
        members +=
            (i == 0 ? "\"" : ",\n\"") + std::to_string(i) + "\": {\"type\": \"phong\", \"exponent\": 1, ";
        members += "\"diffuse\": " + decimal(i) + ", \"specular\": " + decimal(STEPS - i) + "}";
    }
    SceneFolder folder;
    const Scene scene = folder.load(settings(GOOD_CAMERA + ", \"materials\": {" + members + "}"));
    ASSERT_EQ(scene.materials.size(), size_t(STEPS + 1));
    for (const Material& m : scene.materials) {
        const auto& phong = std::get<PhongMaterial>(m.model);
        EXPECT_LE(phong.diffuse.factor.x + phong.specular.factor.x, 1.0f) << m.name;
        EXPECT_GT(phong.diffuse.factor.x + phong.specular.factor.x, 0.999999f) << m.name;
    }
}

TEST(SceneMaterials, ReadMirrorsAndConductors) {
    EXPECT_EQ(material<MirrorMaterial>(R"({"type": "mirror"})").reflectance, vec3(1));
    EXPECT_EQ(material<MirrorMaterial>(R"({"type": "mirror", "reflectance": [1, 0.5, 0]})").reflectance,
              vec3(1, 0.5f, 0));
    const auto gold = material<ConductorMaterial>(
        R"({"type": "conductor", "reflectance": [1, 0.78, 0.34], "alpha": 0.001})");
    EXPECT_EQ(gold.reflectance, vec3(1, 0.78f, 0.34f));
    EXPECT_EQ(gold.alpha, MIN_ALPHA);
    EXPECT_EQ(material<ConductorMaterial>(R"({"type": "conductor", "reflectance": 1, "alpha": 1})").alpha,
              1.0f);

    SceneFolder folder;
    const auto conductor = [](const std::string& alpha) {
        return material(R"({"type": "conductor", "reflectance": 1, "alpha": @)" + alpha + "}");
    };
    folder.expect_error(conductor("0"),
                        "a \"conductor\" needs some roughness; without any, use the type \"mirror\"");
    folder.expect_error(conductor("0.0009"), "\"alpha\": expected a number from 0.001 to 1, found 9e-04");
    folder.expect_error(conductor("-0.5"), "\"alpha\": expected a number from 0.001 to 1, found -0.5");
    folder.expect_error(conductor("1.5"), "\"alpha\": expected a number from 0.001 to 1, found 1.5");
    folder.expect_error(material(R"(@{"type": "conductor", "reflectance": 1})"),
                        "the key \"alpha\" is missing here; add it");
    folder.expect_error(material(R"(@{"type": "conductor", "alpha": 1})"),
                        "the key \"reflectance\" is missing here; add it");
    folder.expect_error(material(R"({"type": "mirror", "reflectance": @2})"),
                        "\"reflectance\": expected numbers from 0 to 1, found 2");
}

TEST(SceneMaterials, ReadDiffuseTransmission) {
    const auto leaf = material<DiffuseTransmissionMaterial>(
        R"({"type": "diffuse_transmission", "reflectance": [0.1, 0.2, 0.3], "transmittance": 0.7})");
    EXPECT_EQ(leaf.reflectance, vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(leaf.transmittance, vec3(0.7f));
    EXPECT_FALSE(leaf.inside);
    const auto shell = material<DiffuseTransmissionMaterial>(
        R"({"type": "diffuse_transmission", "reflectance": 0, "transmittance": 1,
            "absorption": {"transmittance": [0.5, 1, 0.25], "distance": 0.1}})");
    ASSERT_TRUE(shell.inside);
    EXPECT_EQ(shell.inside->absorption, vec3(6.9314718056f, 0.0f, 13.8629436112f));

    SceneFolder folder;
    folder.expect_error(
        material(R"({"type": "diffuse_transmission", "reflectance": 0.5, "transmittance": @[0.5, 0.6, 0]})"),
        "reflectance + transmittance is 1.1 in green; lower one of the two until the sum is at most 1");
    folder.expect_error(material(R"(@{"type": "diffuse_transmission", "reflectance": 0.5})"),
                        "the key \"transmittance\" is missing here; add it");
    folder.expect_error(material(R"(@{"type": "diffuse_transmission", "transmittance": 0.5})"),
                        "the key \"reflectance\" is missing here; add it");
}

TEST(SceneMaterials, ReadDielectrics) {
    const auto glass = material<DielectricMaterial>(R"({"type": "dielectric", "ior": 1.52})");
    EXPECT_EQ(glass.ior, 1.52f);
    EXPECT_FALSE(glass.exterior_ior);
    EXPECT_EQ(glass.priority, 0u);
    EXPECT_EQ(glass.fresnel, Fresnel::schlick);
    EXPECT_EQ(glass.inside.absorption, vec3(0));
    const auto bubble = material<DielectricMaterial>(
        R"({"type": "dielectric", "ior": 1, "exterior_ior": 1.33, "fresnel": "exact",
            "absorption": {"transmittance": [0.5, 1, 0.25], "distance": 0.1}})");
    EXPECT_EQ(bubble.exterior_ior, 1.33f);
    EXPECT_EQ(bubble.fresnel, Fresnel::exact);
    // ln 2 / 0.1 m, 0, and twice the first.
    EXPECT_EQ(bubble.inside.absorption, vec3(6.9314718056f, 0.0f, 13.8629436112f));
    const auto same =
        material<DielectricMaterial>(R"({"type": "dielectric", "ior": 1.5, "exterior_ior": 1.5})");
    EXPECT_EQ(same.ior, same.exterior_ior);
    EXPECT_EQ(material<DielectricMaterial>(R"({"type": "dielectric", "ior": 2, "priority": 15})").priority,
              15u);
    EXPECT_EQ(
        material<DielectricMaterial>(R"({"type": "dielectric", "ior": 2, "fresnel": "schlick"})").fresnel,
        Fresnel::schlick);
}

TEST(SceneMaterials, CheckDielectrics) {
    SceneFolder folder;
    const auto dielectric = [](const std::string& members) {
        return material("{\"type\": \"dielectric\", " + members + "}");
    };
    folder.expect_error(dielectric("\"ior\": @0"), "\"ior\": expected a number above 0, found 0");
    folder.expect_error(dielectric("\"ior\": @-1.5"), "\"ior\": expected a number above 0, found -1.5");
    folder.expect_error(dielectric("\"ior\": 1.5, \"exterior_ior\": @0"),
                        "\"exterior_ior\": expected a number above 0, found 0");
    folder.expect_error(dielectric("\"ior\": 1.5, \"priority\": @16"),
                        "\"priority\": expected a whole number from 0 to 15, found 16");
    const std::string contrast =
        "ior and exterior_ior differ by a factor above a million; give both as those of real media";
    folder.expect_error(dielectric("\"ior\": @1000001"), contrast);
    folder.expect_error(dielectric("\"ior\": @1, \"exterior_ior\": 1e30"), contrast);
    folder.expect_error(material("@{\"type\": \"dielectric\"}"), "the key \"ior\" is missing here; add it");
    folder.expect_error(dielectric("\"ior\": 1.5, \"fresnel\": @\"exakt\""),
                        "unknown fresnel \"exakt\" (did you mean \"exact\"? known: schlick, exact)");

    const auto absorption = [&](const std::string& members) {
        return dielectric("\"ior\": 1.5, \"absorption\": " + members);
    };
    folder.expect_error(absorption(R"({"transmittance": @[0.5, 0, 1], "distance": 1})"),
                        "\"transmittance\": expected numbers above 0 and up to 1, found [0.5, 0, 1]");
    folder.expect_error(absorption(R"({"transmittance": @1.5, "distance": 1})"),
                        "\"transmittance\": expected numbers from 0 to 1, found 1.5");
    folder.expect_error(absorption(R"({"transmittance": 0.5, "distance": @0})"),
                        "\"distance\": expected a number above 0, found 0");
    folder.expect_error(absorption(R"({"transmittance": 1e-300, "distance": @1e-37})"),
                        "the medium exceeds the range of 32-bit floats; use a longer distance");
    folder.expect_error(absorption(R"(@{"transmittance": 0.5})"),
                        "the key \"distance\" is missing here; add it");
    folder.expect_error(absorption(R"(@{"distance": 0.5})"),
                        "the key \"transmittance\" is missing here; add it");
}

TEST(SceneMaterials, ReadInterfacesAndScattering) {
    const auto cloud = material<InterfaceMaterial>(
        R"({"type": "interface", "scattering": {"coefficient": [1, 2, 0], "g": -0.25},
            "absorption": {"transmittance": [0.5, 1, 0.25], "distance": 0.1}, "priority": 2})");
    EXPECT_EQ(cloud.inside.scattering, vec3(1, 2, 0));
    EXPECT_EQ(cloud.inside.absorption, vec3(6.9314718056f, 0.0f, 13.8629436112f));
    EXPECT_EQ(cloud.inside.g, -0.25f);
    EXPECT_EQ(cloud.priority, 2u);
    EXPECT_EQ(material<InterfaceMaterial>(R"({"type": "interface"})"), InterfaceMaterial());
    // Of what comes as far as 0.1 m, a particle scatters 0.75.
    const auto milk = material<DielectricMaterial>(
        R"({"type": "dielectric", "ior": 1.33,
            "scattering": {"albedo": [0.75, 1, 0], "mean_free_path": [0.125, 0.5, 1], "g": 0.75}})");
    EXPECT_EQ(milk.inside.scattering, vec3(6, 2, 0));
    EXPECT_EQ(milk.inside.absorption, vec3(2, 0, 1));
    EXPECT_EQ(milk.inside.g, 0.75f);
    const auto paper = material<DiffuseTransmissionMaterial>(
        R"({"type": "diffuse_transmission", "reflectance": 0, "transmittance": 1, "scattering": {"coefficient": 3}})");
    ASSERT_TRUE(paper.inside);
    EXPECT_EQ(paper.inside->scattering, vec3(3));
}

// A medium that fills half of space, of particles that scatter in all directions, reflects (1 - s) (1 - 0.139
// s) / (1 + 1.17 s) of diffuse light, with s = sqrt(1 - albedo), within 0.002. Ref: van de Hulst 1980,
// Multiple Light Scattering, chapter 11.
TEST(SceneMaterials, ReadScatteringByWhatItReflects) {
    for (const double reflectance : {0.0, 0.1, 0.5, 0.9, 1.0}) {
        const auto solid = material<InterfaceMaterial>(
            R"({"type": "interface", "scattering": {"mean_free_path": 0.5, "reflectance": )" +
            std::to_string(reflectance) + "}}");
        const vec3 extinction = solid.inside.scattering + solid.inside.absorption;
        EXPECT_NEAR(extinction.x, 2.0, 1e-6);
        const double s = std::sqrt(std::max(0.0, 1.0 - double(solid.inside.scattering.x) / 2.0));
        EXPECT_NEAR((1.0 - s) * (1.0 - 0.139 * s) / (1.0 + 1.17 * s), reflectance, 0.002);
    }
}

TEST(SceneMaterials, CheckScattering) {
    SceneFolder folder;
    const auto scattering = [](const std::string& value) {
        return material("{\"type\": \"interface\", \"scattering\": " + value + "}");
    };
    folder.expect_error(scattering("@{}"), "expected one of \"coefficient\", \"albedo\" and \"reflectance\"");
    folder.expect_error(scattering(R"(@{"coefficient": 1, "albedo": 1})"),
                        "expected one of \"coefficient\", \"albedo\" and \"reflectance\"");
    folder.expect_error(scattering(R"({"coefficient": @-1})"),
                        "\"coefficient\": expected numbers of at least 0, found -1");
    folder.expect_error(scattering(R"({"coefficient": 1, "g": @1})"),
                        "\"g\": expected a number from -0.999 to 0.999, found 1");
    folder.expect_error(scattering(R"({"coefficient": 1, "mean_free_path": @1})"),
                        "the coefficient says how far light comes; remove mean_free_path");
    folder.expect_error(scattering(R"(@{"albedo": 1})"),
                        "the key \"mean_free_path\" is missing here; add it");
    folder.expect_error(scattering(R"({"albedo": @1.5, "mean_free_path": 1})"),
                        "\"albedo\": expected numbers from 0 to 1, found 1.5");
    folder.expect_error(scattering(R"({"albedo": 1, "mean_free_path": @[1, 0, 1]})"),
                        "\"mean_free_path\": expected numbers above 0, found [1, 0, 1]");
    folder.expect_error(scattering(R"({"albedo": 1, "mean_free_path": @1e-300})"),
                        "the medium exceeds the range of 32-bit floats; use a longer distance");
    folder.expect_error(
        material(R"({"type": "interface", "scattering": {"albedo": @1, "mean_free_path": 1},
                     "absorption": {"transmittance": 0.5, "distance": 1}})"),
        "this says how much light is absorbed; remove \"absorption\", or use \"coefficient\"");
}

}  // namespace
}  // namespace candela
