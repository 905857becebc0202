// MTL files: the material that statements make.
#include "unit/load/obj/mtl_fixture.h"

namespace candela {
namespace {

class MtlModels : public Mtl {};

TEST_F(MtlModels, WithoutHighlightIsDiffuse) {
    for (const char* text :
         {"Kd 0.1 0.2 0.3", "Kd 0.1 0.2 0.3\nKs 0 0 0\nNs 5\nillum 2",
          "Kd 0.1 0.2 0.3\nKs 1 1 1\nNs 5\nillum 1", "Ks 1 1 1\nKd .1 +.2 3e-1 1 # red\nillum 0"}) {
        SCOPED_TRACE(text);
        EXPECT_EQ(model<DiffuseMaterial>(text).reflectance, vec3(0.1f, 0.2f, 0.3f));
        EXPECT_TRUE(material(text).warnings.empty());
    }
}

TEST_F(MtlModels, WithHighlightIsPhong) {
    for (const char* text :
         {"Kd 0.1 0.2 0.3\nKs 0.5 0 0\nNs 30", "Ns 30\nKs 0.5 0 0\nKd 0.1 0.2 0.3\nillum 2"}) {
        const auto phong = model<PhongMaterial>(text);
        EXPECT_EQ(phong.diffuse, vec3(0.1f, 0.2f, 0.3f));
        EXPECT_EQ(phong.specular, vec3(0.5f, 0, 0));
        EXPECT_EQ(phong.exponent, 30.0f);
        EXPECT_TRUE(material(text).warnings.empty());
    }
    EXPECT_EQ(model<PhongMaterial>("Ks 0.5\nKd 0.5").exponent, 1.0f);
    EXPECT_EQ(model<PhongMaterial>("Ks 0.5 0 0").diffuse, vec3(0));
    EXPECT_EQ(model<PhongMaterial>("Ks 0.5 0 0\nNs 0").exponent, 0.0f);
    EXPECT_EQ(model<PhongMaterial>("Ks 0.5 0 0\nNs 100000").exponent, 1e5f);
}

TEST_F(MtlModels, ClampsExponentsThatAreTooGreat) {
    EXPECT_EQ(model<PhongMaterial>("Ks 0.5\nNs 200000").exponent, 1e5f);
    expect_warning("Ks 0.5\nNs 200000", "Ns 200000 is read as 100000, the greatest exponent");
}

// The sums are 0.4, 1.6 and 0.75, so that all is divided by 1.6; the quotients are exact.
TEST_F(MtlModels, ScalesWhatWouldMakeLight) {
    const char* text = "Kd 0.2 0.8 0.5\nKs 0.2 0.8 0.25\nNs 10";
    const auto phong = model<PhongMaterial>(text);
    EXPECT_EQ(phong.diffuse, vec3(0.125f, 0.5f, 0.3125f));
    EXPECT_EQ(phong.specular, vec3(0.125f, 0.5f, 0.15625f));
    expect_warning(text, "Kd + Ks is 1.6 in a channel; it is scaled to 1");
    expect_warning("Kd 0.5 1.25 0", "Kd is 1.25 in a channel; it is scaled to 1");
    EXPECT_EQ(model<DiffuseMaterial>("Kd 0.5 1.25 0").reflectance, vec3(0.4f, 1, 0));
    expect_warning("Ks 2\nillum 3", "Ks is 2 in a channel; it is scaled to 1");
    EXPECT_EQ(model<MirrorMaterial>("Ks 2 1 0\nillum 3").reflectance, vec3(1, 0.5f, 0));
    EXPECT_TRUE(material("Kd 0.333334\nKs 0.666667").warnings.empty());  // Rounding is not reported.
}

TEST_F(MtlModels, ReflectsByKsBesideKd) {
    for (const char* illum : {"\nillum 3", "\nillum 5", "\nillum 8"}) {
        const std::string text = illum;
        EXPECT_EQ(model<MirrorMaterial>("Kd 0\nKs 0.9 0.8 0.7\nNs 9" + text).reflectance,
                  vec3(0.9f, 0.8f, 0.7f));
        EXPECT_EQ(model<MirrorMaterial>("Ks 0.9" + text).reflectance, vec3(0.9f));
        EXPECT_EQ(model<DiffuseMaterial>("Kd 0.7 0.5 0.1" + text).reflectance, vec3(0.7f, 0.5f, 0.1f));
        EXPECT_EQ(model<DiffuseMaterial>("Kd 0.7\nKs 0 0 0" + text).reflectance, vec3(0.7f));
        const auto glazed = model<PhongMaterial>("Kd 0.9 0 0\nKs 0.1\nNs 50" + text);
        EXPECT_EQ(glazed.diffuse, vec3(0.9f, 0, 0));
        EXPECT_EQ(glazed.specular, vec3(0.1f));
        EXPECT_EQ(glazed.exponent, 50.0f);
        for (const char* sharp : {"", "\nNs 1000"})
            EXPECT_EQ(model<PhongMaterial>("Kd 0.9 0 0\nKs 0.1" + text + sharp).exponent, 1e5f);
        EXPECT_TRUE(material("Kd 0.9 0 0\nKs 0.1\nNs 50" + text).warnings.empty());
        expect_warning(text, "it has no colour (Kd); grey of 0.5 is used");
    }
    for (const char* illum : {"9", "10"}) {
        const std::string text = std::string("Kd 0.5\nKs 0.5\nillum ") + illum;
        EXPECT_EQ(model<PhongMaterial>(text).specular, vec3(0.5f));
        expect_warning(text,
                       std::string("illum ") + illum + " is not supported; the material is read as illum 2");
    }
}

// Blender converts roughness to an exponent by Ns = 1000 (1 - roughness)^2, and metalness to Ka.
TEST_F(MtlModels, IsAMetalWhereKdAndKsAreTooMuch) {
    const std::string gold = "Kd 1 0.7 0.2\nKs 0.5\nNs 360\nillum ";
    for (const char* illum : {"3", "5"}) {
        const auto metal = model<PrincipledMaterial>(gold + illum + "\nKa 1 1 1");
        EXPECT_EQ(metal.base_color, vec3(1, 0.7f, 0.2f));
        EXPECT_EQ(metal.metalness, 1.0f);
        EXPECT_FLOAT_EQ(metal.roughness.factor, 0.4f);
        EXPECT_EQ(metal.specular, 1.0f);
        EXPECT_TRUE(material(gold + illum + "\nKa 1 1 1").warnings.empty());
        EXPECT_EQ(model<PrincipledMaterial>(gold + illum).metalness, 1.0f);
        EXPECT_EQ(model<PrincipledMaterial>(gold + illum + "\nKa 0 0 0").metalness, 1.0f);
        EXPECT_EQ(model<PrincipledMaterial>(gold + illum + "\nKa 0.2 0.1 0.1").metalness, 1.0f);
        EXPECT_EQ(model<PrincipledMaterial>(gold + illum + "\nKa 0.25").metalness, 0.25f);
    }
    EXPECT_EQ(model<PrincipledMaterial>("Kd 1\nKs 0.5\nillum 3").roughness, 0.0f);
    EXPECT_EQ(model<PrincipledMaterial>("Kd 1\nKs 0.25\nillum 3").specular, 0.5f);
}

TEST_F(MtlModels, WhatBlenderWroteIsItsPrincipledMaterial) {
    const auto by_blender = [&](const std::string& text) {
        return load("# Blender 5.0.1 MTL File: 'None'\n\nnewmtl a\n" + text).materials.at("a");
    };
    const auto principled = [&](const std::string& text) {
        return std::get<PrincipledMaterial>(by_blender(text).material.model);
    };
    const std::string plastic =
        "Ns 250\nKa 1 1 1\nKd 0.8 0.1 0.1\nKs 0.5 0.5 0.5\nKe 0 0 0\nNi 1.45\nd 1\nillum 2";
    EXPECT_EQ(principled(plastic).base_color, vec3(0.8f, 0.1f, 0.1f));
    EXPECT_EQ(principled(plastic).metalness, 0.0f);
    EXPECT_FLOAT_EQ(principled(plastic).roughness.factor, 0.5f);
    EXPECT_EQ(principled(plastic).ior, 1.45f);
    EXPECT_EQ(principled(plastic).specular, 1.0f);
    EXPECT_TRUE(by_blender(plastic).warnings.empty());
    EXPECT_EQ(principled("Kd 0.2\nKs 0.25\nKa 0.3\nNs 490\nillum 3").metalness, 0.3f);
    EXPECT_EQ(principled("Kd 0.2\nKs 0.25\nKa 0.3\nNs 490\nillum 3").specular, 0.5f);
    const MtlMaterial veil = by_blender("Kd 0.5\nKs 0.5\nKa 1\nNs 250\nNi 1.5\nd 0.25\nillum 6");  // A metal.
    EXPECT_EQ(std::get<PrincipledMaterial>(veil.material.model).metalness, 1.0f);
    EXPECT_EQ(veil.material.opacity.value, 0.25f);
    const MtlMaterial leaf = by_blender("Kd 0.5\nKs 0.5\nKa 1\nNs 250\nNi 1.5\nd 0.25\nillum 9");  // None.
    EXPECT_EQ(std::get<PrincipledMaterial>(leaf.material.model).metalness, 0.0f);
    EXPECT_EQ(leaf.material.opacity.value, 0.25f);
    EXPECT_TRUE(leaf.warnings.empty());
    const auto glass = principled("Kd 1\nKs 0.5\nNi 1.5\nd 1\nillum 2\nPr 0.25\nPm 0\nTf 0.5 0.5 0.5");
    EXPECT_EQ(glass.transmission, 0.5f);
    EXPECT_TRUE(glass.inside);
    EXPECT_EQ(glass.roughness, 0.25f);
    const auto maps = principled("Ks 0.5\nillum 2\nmap_Ns r.png\nmap_refl m.png");
    EXPECT_EQ(maps.roughness.factor, 1.0f);
    EXPECT_TRUE(maps.roughness.texture);
    EXPECT_EQ(maps.metalness.factor, 1.0f);
    EXPECT_TRUE(maps.metalness.texture);
}

TEST_F(MtlModels, PbrStatementsDecide) {
    const std::string text =
        "Kd 0.8 0.1 0.1\nKs 0.2\nNs 5\nNi 1.33\nPr 0.4\nPm 0.3\nPs 0.25\nPc 0.75\nPcr 0.125";
    for (const char* illum : {"2", "3", "5"}) {
        const auto m = model<PrincipledMaterial>(text + "\nillum " + illum);
        EXPECT_EQ(m.base_color, vec3(0.8f, 0.1f, 0.1f));
        EXPECT_EQ(m.roughness, 0.4f);
        EXPECT_EQ(m.metalness, 0.3f);
        EXPECT_EQ(m.specular, 1.0f);
        EXPECT_EQ(m.ior, 1.33f);
        EXPECT_EQ(m.sheen_color, vec3(0.25f));
        EXPECT_EQ(m.coat, 0.75f);
        EXPECT_EQ(m.coat_roughness, 0.125f);
        EXPECT_EQ(m.transmission, 0.0f);
        EXPECT_TRUE(material(text + "\nillum " + illum).warnings.empty());
    }
    EXPECT_EQ(model<PrincipledMaterial>("Kd 1\nPr 0.4").ior, 1.5f);
    EXPECT_EQ(model<PrincipledMaterial>("Kd 1\nPr 0.4\nNi 1").ior, 1.5f);
    EXPECT_EQ(model<PrincipledMaterial>("Kd 1\nPm 1").roughness, 0.5f);
    expect_warning("Kd 1\nPm 1", "it has no roughness (Pr); 0.5 is used");
    expect_library_warnings("newmtl a\nKd 1\nPr 0.4\naniso 0\nanisor 0\n", {});
    expect_library_warnings("newmtl a\nKd 1\nPr 0.4\naniso 0.5\nanisor 0.2\n",
                            {"m.mtl: ignored aniso (brushed metal is not supported)"});
}

TEST_F(MtlModels, PbrStatementsMayComeWithTransmission) {
    const std::string text = "Kd 1\nPr 0\nPm 0\nNi 1.5\nTf 0.5 0.5 0.5";
    EXPECT_EQ(model<PrincipledMaterial>(text).transmission, 0.5f);
    EXPECT_TRUE(model<PrincipledMaterial>(text).inside);
    expect_warning(text,
                   "Tf beside Pr or Pm is read as a fraction 0.5 of the light that passes, as through glass");
    for (const char* opaque : {"Tf 1 1 1\nTr 0\nNi 1.5", "Tf 0 0 0\nNi 1.5", "Tf 1 1 1\nNi 1", "Tf 1 1 1",
                               "Tf 1 1 1\nNi 1.5\nillum 4"}) {
        SCOPED_TRACE(opaque);
        EXPECT_EQ(model<PrincipledMaterial>("Kd 1\nPr 0\n" + std::string(opaque)).transmission, 0.0f);
        EXPECT_TRUE(material("Kd 1\nPr 0\n" + std::string(opaque)).warnings.empty());
    }
}

TEST_F(MtlModels, GlassRefractsAndPassesLight) {
    for (const std::string illum : {"\nillum 4", "\nillum 6", "\nillum 7"}) {
        for (const std::string passes : {"Kd 0", "Kd 1\nd 0.1", "Kd 1\nTr 0.9", "", "Kd 1\nd 0.5\nTf 1"}) {
            SCOPED_TRACE(passes + illum);
            EXPECT_EQ(model<DielectricMaterial>(passes + illum).ior, 1.5f);
            EXPECT_EQ(model<DielectricMaterial>(passes + illum + "\nNi 1.33").ior, 1.33f);
            EXPECT_FALSE(model<DielectricMaterial>(passes + illum).exterior_ior);
            EXPECT_TRUE(material(passes + illum).warnings.empty());
        }
        const auto green = model<PrincipledMaterial>("Kd 0.5\nNi 1.5\nTf 0.25 1 2" + illum);
        EXPECT_EQ(green.base_color, vec3(0.25f, 1, 1));
        EXPECT_EQ(green.transmission, 1.0f);
        EXPECT_EQ(green.roughness, 0.0f);
        EXPECT_EQ(green.ior, 1.5f);
        EXPECT_TRUE(green.inside);
        EXPECT_EQ(model<PrincipledMaterial>("Kd 0\nNi 1.5\nPr 0.5" + illum).roughness, 0.5f);
        EXPECT_EQ(model<PrincipledMaterial>("Kd 0\nNi 1.5\nPr 0.5\nPm 1" + illum).transmission, 0.0f);
        expect_warning("Kd 0\nTf 0 0 0" + illum, "Tf 0 would let no light through the glass, and is ignored");
        EXPECT_EQ(model<DielectricMaterial>("Kd 0\nTf 0 0 0" + illum).ior, 1.5f);
    }
}

// Maya writes illum 4, Tf 1 and Ni 1 for opaque materials.
TEST_F(MtlModels, WhatDoesNotRefractOrPassLightIsOpaque) {
    const std::string clay = "Kd 0.5 0.3 0.2\nKa 0 0 0\nTf 1.00 1.00 1.00\nillum 4\n";
    for (const char* ni : {"Ni 1.00", "Ni 1.5", "", "Ni 0"}) {
        SCOPED_TRACE(ni);
        EXPECT_EQ(model<DiffuseMaterial>(clay + ni).reflectance, vec3(0.5f, 0.3f, 0.2f));
        EXPECT_EQ(material(clay + ni).material.opacity.value, 1.0f);
        EXPECT_TRUE(material(clay + ni).warnings.empty());
        EXPECT_EQ(model<PhongMaterial>(clay + "Ks 0.5\nNs 18\n" + ni).exponent, 18.0f);
    }
    EXPECT_EQ(model<DiffuseMaterial>("Kd 0.5\nTf 0 0 0\nillum 7").reflectance, vec3(0.5f));
    const std::string veil = "Kd 0.5\nTf 0.25 0.25 0.25\nNi 1.00\nillum 4";
    EXPECT_EQ(material(veil).material.opacity.value, 0.25f);
    expect_warning(veil, "Tf is read as an opacity of 0.25, since Ni is not above 1");
    EXPECT_EQ(material("Kd 0.5\nd 0.5\nTf 0.25 0.25 0.25\nNi 1.00\nillum 4").material.opacity.value, 0.5f);
}

TEST_F(MtlModels, EmissionIsTakenAsItIs) {
    const MtlMaterial lamp = material("Kd 0.5\nKe 10 20.5 0");
    EXPECT_EQ(lamp.emission, vec3(10, 20.5f, 0));
    EXPECT_EQ(std::get<DiffuseMaterial>(lamp.material.model).reflectance, vec3(0.5f));
    EXPECT_EQ(model<DiffuseMaterial>("Ke 1 1 1").reflectance, vec3(0));
    EXPECT_EQ(material("Kd 0.5").emission, vec3(0));
}

TEST_F(MtlModels, WithoutColourIsGrey) {
    for (const char* text : {"Ka 1 1 1", "Ks 0 0 0", "Ke 0", "map_d a.png"}) {
        expect_warning(text, "it has no colour (Kd); grey of 0.5 is used");
        EXPECT_EQ(model<DiffuseMaterial>(text).reflectance, vec3(0.5f));
    }
}

TEST_F(MtlModels, OpacityIsDOrElseWhatTrLeaves) {
    const auto opacity = [&](const std::string& text) {
        const Opacity read = material("Kd 1\n" + text).material.opacity;
        EXPECT_TRUE(material("Kd 1\n" + text).warnings.empty()) << text;
        EXPECT_FALSE(read.cutoff || read.value.texture) << text;
        return read.value.factor;
    };
    EXPECT_EQ(opacity(""), 1.0f);
    EXPECT_EQ(opacity("d 0.25"), 0.25f);
    EXPECT_EQ(opacity("d -halo 0.25"), 0.25f);
    EXPECT_EQ(opacity("Tr 0.25"), 0.75f);
    EXPECT_EQ(opacity("illum 3\nd 0.25"), 0.25f);
    EXPECT_EQ(opacity("illum 7\nd 0.25"), 1.0f);  // It is glass, which lets light through.
    EXPECT_EQ(opacity("illum 7\nKd 0\nd 7"), 1.0f);
    for (const char* text : {"d 0.5\nTr 0", "Tr 1\nd 0.5"})  // d is used: it is in the specification.
        EXPECT_EQ(opacity(text), 0.5f);
}

TEST_F(MtlModels, WarnsOfOddOpacity) {
    expect_warning("Kd 1\nd 0", "it is invisible: d is 0, or Tr is 1");
    expect_warning("Kd 1\nTr 1", "it is invisible: d is 0, or Tr is 1");
    expect_warning("Kd 1\nd 1.5", "d 1.5 is not from 0 to 1; the material is read as opaque");
    expect_warning("Kd 1\nTr -3", "Tr -3 is not from 0 to 1; the material is read as opaque");
    EXPECT_EQ(material("d 1.5").material.opacity.value, 1.0f);
    const MtlMaterial none = material("Kd 1\nTr 2");
    EXPECT_EQ(none.material.opacity.value, 0.0f);
    ASSERT_EQ(none.warnings.size(), 2u);
    EXPECT_NE(none.warnings[0].text.find("Tr 2 is not from 0 to 1; the material is read as transparent"),
              std::string::npos);
}

}  // namespace
}  // namespace candela
