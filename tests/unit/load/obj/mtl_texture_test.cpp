// Statements of MTL files that name textures: what they do to materials, and what is refused or ignored.
#include <gtest/gtest.h>

#include "load/obj/mtl.h"
#include "unit/base/damage.h"
#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

class MtlTextures : public testing::Test {
  protected:
    // The one material of a file, whose statements are `text`, from line 2 on.
    MtlMaterial material(const std::string& text) {
        folder_.write("m.mtl", "newmtl a\n" + text);
        MtlLibrary library = load_mtl(folder_.path() / "m.mtl", FileReach(folder_.path() / "m.obj"));
        library_warnings_ = library.warnings;
        return library.materials.at("a");
    }

    template <class Model>
    Model model(const std::string& text) {
        return std::get<Model>(material(text).material.model);
    }

    void expect_error(const std::string& text, const std::string& message) {
        SCOPED_TRACE(text);
        EXPECT_EQ(folder_.without_folder(error_of([&] { material(text); })), message);
    }

    // Checks the only warnings about a material, after its place and name.
    void expect_warnings(const std::string& text, const std::vector<std::string>& expected) {
        SCOPED_TRACE(text);
        const std::vector<MtlWarning> warnings = material(text).warnings;
        ASSERT_EQ(warnings.size(), expected.size());
        for (size_t i = 0; i < warnings.size(); ++i)
            EXPECT_EQ(folder_.without_folder(warnings[i].text), "m.mtl:1: material \"a\": " + expected[i]);
    }

    // Checks the only warnings about the file.
    void expect_ignored(const std::string& text, const std::vector<std::string>& expected) {
        SCOPED_TRACE(text);
        material(text);
        ASSERT_EQ(library_warnings_.size(), expected.size());
        for (size_t i = 0; i < expected.size(); ++i)
            EXPECT_EQ(folder_.without_folder(library_warnings_[i]), "m.mtl: ignored " + expected[i]);
    }

    // The only texture of a material: that of its Kd, so that its options can be looked at.
    Texture texture(const std::string& options) {
        const auto diffuse = model<DiffuseMaterial>("map_Kd " + options + " a.png");
        return diffuse.reflectance.texture.value();
    }

    // The name of the file that a statement names.
    std::string file(const std::string& text) { return material(text).images.at(0).file; }

    SceneFolder folder_;
    std::vector<std::string> library_warnings_;
};

constexpr TextureEncoding SRGB = TextureEncoding::srgb;
constexpr TextureEncoding LINEAR = TextureEncoding::linear;
const std::string UNUSED = " (their materials do not use them, because of illum, Pm or a factor of 0)";

TEST_F(MtlTextures, ColoursAreMultipliedByTheirStatement) {
    const auto plain = model<DiffuseMaterial>("map_Kd a.png").reflectance;
    EXPECT_EQ(plain.factor, vec3(1));
    ASSERT_TRUE(plain.texture);
    EXPECT_EQ(*plain.texture, (Texture{.image = 0, .encoding = SRGB}));
    const auto tinted = model<DiffuseMaterial>("map_Kd a.png\nKd 0.5 0.25 0.125").reflectance;
    EXPECT_EQ(tinted.factor, vec3(0.5f, 0.25f, 0.125f));
    EXPECT_TRUE(tinted.texture);
    EXPECT_EQ(model<DiffuseMaterial>("map_Kd a.png\nKe 1").reflectance.factor, vec3(1));
    expect_warnings("map_Kd a.png", {});
    expect_warnings("map_Kd a.png\nKd 2", {"Kd is 2 in a channel; it is scaled to 1"});
    expect_ignored("map_Kd a.png", {});
    expect_ignored("map_Kd a.png\nKd 0", {"map_Kd" + UNUSED});
}

TEST_F(MtlTextures, HighlightsMayHaveTextures) {
    const char* text = "Kd 0.5\nmap_Kd a.png\nKs 0.25\nmap_Ks b.png\nNs 100\nmap_Ns -imfchan g c.png";
    const MtlMaterial read = material(text);
    const auto phong = std::get<PhongMaterial>(read.material.model);
    EXPECT_EQ(phong.diffuse, (Textured<vec3>(vec3(0.5f), Texture{.image = 0, .encoding = SRGB})));
    EXPECT_EQ(phong.specular, (Textured<vec3>(vec3(0.25f), Texture{.image = 1, .encoding = SRGB})));
    EXPECT_EQ(phong.exponent,
              (Textured<float>(100.0f, Texture{.image = 2, .encoding = LINEAR, .channel = 1})));
    ASSERT_EQ(read.images.size(), 3u);
    EXPECT_EQ(read.images[2].file, "c.png");
    EXPECT_EQ(read.images[2].folder, folder_.path());
    EXPECT_EQ(folder_.without_folder(read.images[2].place), "m.mtl:7");
    expect_warnings(text, {});
    expect_ignored(text, {});
    // A map without a factor is a highlight, too, and 1 + 1 is too much.
    EXPECT_EQ(model<PhongMaterial>("map_Kd a.png\nmap_Ks b.png").specular.factor, vec3(0.5f));
    expect_warnings("map_Kd a.png\nmap_Ks b.png", {"Kd + Ks is 2 in a channel; it is scaled to 1"});
    EXPECT_EQ(model<PhongMaterial>("map_Ks b.png").diffuse, vec3(0));
    expect_ignored("Kd 1\nKs 0\nmap_Ks b.png\nmap_Ns c.png", {"map_Ks, map_Ns" + UNUSED});
    expect_ignored("Kd 1\nKs 1\nmap_Ks b.png\nillum 1", {"map_Ks" + UNUSED});
    expect_ignored("Kd 1\nKs 1\nNs 0\nmap_Ns b.png", {"map_Ns" + UNUSED});
}

TEST_F(MtlTextures, MirrorsAndGlass) {
    const auto mirror = model<MirrorMaterial>("map_Ks a.png\nKs 0.5\nillum 3");
    EXPECT_EQ(mirror.reflectance, (Textured<vec3>(vec3(0.5f), Texture{.encoding = SRGB})));
    expect_ignored("map_Ks a.png\nKd 0\nmap_Kd b.png\nillum 5", {"map_Kd" + UNUSED});
    const MtlMaterial glass = material("map_Kd a.png\nd 0.25\nmap_d b.png\nnorm c.png\nillum 7");
    EXPECT_TRUE(std::holds_alternative<DielectricMaterial>(glass.material.model));
    EXPECT_EQ(glass.material.opacity.value.factor, 1.0f);
    EXPECT_TRUE(glass.material.opacity.value.texture);
    EXPECT_TRUE(glass.material.normal_map);
    expect_ignored("map_Kd a.png\nd 0.5\nmap_d b.png\nillum 7", {"map_Kd" + UNUSED});
    const MtlMaterial leaf = material("map_Kd a.png\nmap_d b.png\nillum 7");  // No glass has a colour.
    EXPECT_TRUE(std::holds_alternative<DiffuseMaterial>(leaf.material.model));
    EXPECT_TRUE(leaf.material.opacity.value.texture);
}

TEST_F(MtlTextures, EmissionMayComeFromAnImage) {
    const auto emission = material("Kd 1\nmap_Ke a.png").emission;
    EXPECT_EQ(emission, (Textured<vec3>(vec3(1), Texture{.encoding = SRGB})));
    const auto bright = material("Kd 1\nKe 10 20 30\nmap_Ke a.png").emission;
    EXPECT_EQ(bright, (Textured<vec3>(vec3(10, 20, 30), Texture{.encoding = SRGB})));
    EXPECT_EQ(material("Kd 1\nKe 0\nmap_Ke a.png").emission, vec3(0));
    expect_ignored("Kd 1\nKe 0\nmap_Ke a.png", {"map_Ke" + UNUSED});
    EXPECT_EQ(model<DiffuseMaterial>("map_Ke a.png").reflectance, vec3(0));  // A lamp.
}

TEST_F(MtlTextures, OpacityIsAlphaOrRed) {
    const auto opacity = [&](const std::string& text) {
        const Opacity read = material("Kd 1\n" + text).material.opacity;
        EXPECT_FALSE(read.cutoff) << text;
        return read.value;
    };
    EXPECT_EQ(opacity("map_d a.png"), (Textured<float>(1.0f, Texture{.channel = ALPHA_OR_RED})));
    EXPECT_EQ(opacity("d 0.5\nmap_d a.png").factor, 0.5f);
    EXPECT_EQ(opacity("Tr 0.75\nmap_d a.png").factor, 0.25f);
    EXPECT_EQ(opacity("map_d -imfchan m a.png").texture->channel, 3u);
    EXPECT_EQ(opacity("map_d -imfchan l a.png").texture->channel, 0u);
    EXPECT_EQ(opacity("map_d -imfchan b a.png").texture->channel, 2u);
    // The file of the colours says by its alpha what is transparent.
    EXPECT_EQ(opacity("map_Kd a.png\nmap_d a.png").texture->channel, 3u);
    EXPECT_EQ(opacity("map_Kd a.png\nmap_d b.png").texture->channel, ALPHA_OR_RED);
    expect_ignored("Kd 1\nd 0\nmap_d a.png", {"map_d" + UNUSED});
}

TEST_F(MtlTextures, NormalsComeFromImages) {
    EXPECT_FALSE(material("Kd 1").material.normal_map);
    for (const char* command : {"norm", "map_Kn"}) {
        const MtlMaterial plain = material(std::string("Kd 1\n") + command + " a.png");
        ASSERT_TRUE(plain.material.normal_map);
        EXPECT_EQ(plain.material.normal_map->texture, (Texture{.encoding = LINEAR}));
        EXPECT_EQ(plain.material.normal_map->scale, 1.0f);
        EXPECT_EQ(folder_.without_folder(plain.images.at(0).place), "m.mtl:3");
        const MtlMaterial scaled = material(std::string(command) + " -bm -0.5 a.png");
        EXPECT_EQ(scaled.material.normal_map->scale, -0.5f);
    }
}

TEST_F(MtlTextures, HeightsComeFromImages) {
    EXPECT_FALSE(material("Kd 1\nnorm a.png").material.bump_map);
    for (const std::string command : {"bump", "map_bump", "map_Bump"}) {
        const MtlMaterial plain = material("Kd 1\n" + command + " a.png");
        EXPECT_FALSE(plain.material.normal_map);
        ASSERT_TRUE(plain.material.bump_map);
        EXPECT_EQ(plain.material.bump_map->texture, (Texture{.encoding = LINEAR}));
        EXPECT_EQ(plain.material.bump_map->multiplier, 1.0f);
        EXPECT_EQ(folder_.without_folder(plain.images.at(0).place), "m.mtl:3");
        const auto placed = material(command + " -bm -0.5 -imfchan b -s 2 -o 3 4 -clamp on a.png").material;
        EXPECT_EQ(placed.bump_map->multiplier, -0.5f);
        Texture expected{.encoding = LINEAR, .wrap_u = Wrap::clamp, .wrap_v = Wrap::clamp, .channel = 2};
        expected.rows[0] = vec3(2, 0, 3);
        expected.rows[1] = vec3(0, 1, 4);
        EXPECT_EQ(placed.bump_map->texture, expected);
        expect_ignored("Kd 1\n" + command + " a.png", {});
        const std::string spelled = command == "bump" ? "bump" : "map_bump";
        expect_error(command + " -bm x a.png",
                     "m.mtl:2: the option -bm of " + spelled + " needs a finite number, found \"x\"");
    }
    // Many files state it under two names.
    EXPECT_EQ(file("map_bump a.png\nbump b.png"), "b.png");
    EXPECT_FALSE(material("Kd 1\nbump -bm 0 a.png").material.bump_map);
    expect_ignored("Kd 1\nbump -bm 0 a.png", {"bump" + UNUSED});
    const MtlMaterial both = material("Kd 1\nbump a.png\nnorm b.png");
    EXPECT_TRUE(both.material.normal_map);
    EXPECT_FALSE(both.material.bump_map);
    EXPECT_EQ(both.images.size(), 1u);
    expect_ignored("Kd 1\nbump a.png\nnorm b.png", {"bump (their materials have normal maps)"});
}

TEST_F(MtlTextures, PbrStatementsMayHaveTextures) {
    const std::string text =
        "map_Kd a.png\nPm 0.5\nmap_Pm -imfchan b b.png\nPr 0.25\nmap_Pr -imfchan g b.png";
    const auto metal = model<PrincipledMaterial>(text);
    EXPECT_EQ(metal.base_color, (Textured<vec3>(vec3(1), Texture{.image = 0, .encoding = SRGB})));
    EXPECT_EQ(metal.metalness,
              (Textured<float>(0.5f, Texture{.image = 1, .encoding = LINEAR, .channel = 2})));
    EXPECT_EQ(metal.roughness,
              (Textured<float>(0.25f, Texture{.image = 2, .encoding = LINEAR, .channel = 1})));
    expect_warnings(text, {});
    expect_ignored(text, {});
    EXPECT_EQ(model<PrincipledMaterial>("Kd 1\nmap_Pr a.png").roughness.factor, 1.0f);
    EXPECT_EQ(model<PrincipledMaterial>("Kd 1\nmap_Pr a.png").metalness, 0.0f);
    EXPECT_EQ(model<PrincipledMaterial>("Kd 1\nPr 0.5\nmap_Pm a.png").metalness.factor, 1.0f);
    const auto glass = model<PrincipledMaterial>("Kd 0\nmap_Pr a.png\nillum 7");
    EXPECT_EQ(glass.roughness, (Textured<float>(1.0f, Texture{.encoding = LINEAR})));
    expect_ignored("Kd 1\nPm 1\nPr 0.5\nKs 1\nmap_Ks a.png", {"map_Ks" + UNUSED});
    expect_ignored("Kd 1\nPm 0\nmap_Pm a.png\nPr 0.5", {"map_Pm" + UNUSED});
    expect_warnings("Pm 1\nPr 1", {"it has no colour (Kd); grey of 0.5 is used"});
    expect_warnings("Kd 2\nPm 1\nPr 1", {"Kd is 2 in a channel; it is scaled to 1"});
}

TEST_F(MtlTextures, OptionsPlaceTheImage) {
    Texture expected{.encoding = SRGB};
    EXPECT_EQ(texture(""), expected);
    expected.rows[0] = vec3(2, 0, 5);
    expected.rows[1] = vec3(0, -3, 6);
    EXPECT_EQ(texture("-s 2 -3 4 -o 5 6 7"), expected);
    EXPECT_EQ(texture("-o 5 6\t-s  2 -3"), expected);
    expected.rows[0] = vec3(2, 0, 5);
    expected.rows[1] = vec3(0, 1, 0);
    EXPECT_EQ(texture("-s 2 -o 5"), expected);
}

TEST_F(MtlTextures, OptionsWrapTheImage) {
    for (const char* options : {"-clamp off", ""}) {
        EXPECT_EQ(texture(options).wrap_u, Wrap::repeat);
        EXPECT_EQ(texture(options).wrap_v, Wrap::repeat);
    }
    EXPECT_EQ(texture("-clamp on").wrap_u, Wrap::clamp);
    EXPECT_EQ(texture("-clamp on").wrap_v, Wrap::clamp);
}

TEST_F(MtlTextures, OptionsThatChangeThePictureAreIgnoredWithAWarning) {
    const std::string why = " (options of textures that are not supported)";
    expect_ignored(
        "map_Kd -blendu on -blendv on -cc off -mm 0 1 -t 0 0 0 -boost 0 -bm 1 -imfchan r -clamp off a.png",
        {});
    expect_ignored(
        "map_Kd -blendu off -mm 0 2 -t 0 1 a.png\nmap_Ks -mm 0.5 1 -blendv off -cc on -boost 1 b.png\n"
        "norm -texres 64 -type sphere -imfchan z -foo 1 2 c.png",
        {"-blendu, -mm, -t, -blendv, -cc, -boost, -texres, -type, -imfchan z, -foo" + why});
    EXPECT_EQ(file("map_Kd -foo 1 2 a.png"), "a.png");
}

TEST_F(MtlTextures, NamesMayHaveBlanksAndBackslashes) {
    EXPECT_EQ(file("map_Kd  my own\\wall 1.png \t"), "my own/wall 1.png");
    EXPECT_EQ(file("map_Kd -s 1 1 1 -clamp on my wall.png"), "my wall.png");
    EXPECT_EQ(file("map_Kd -s 1 1 2 bricks.png"), "bricks.png");
    EXPECT_EQ(file("map_Kd -wall.png"), "-wall.png");
    EXPECT_EQ(file("map_Kd -5"), "-5");
    EXPECT_EQ(material("map_Kd /a/b.png").images.at(0).file, "/a/b.png");
    EXPECT_EQ(file("map_Kd a.png\nmap_Kd b.png"), "b.png");
    EXPECT_EQ(file("map_Kd a # b.png"), "a # b.png");  // May be a name; add_images() sees whether it is.
}

TEST_F(MtlTextures, OptionsMayFollowTheName) {
    const MtlMaterial bumps = material("Kd 1\nbump my wall.png -bm 0.25 -s 2");
    EXPECT_EQ(bumps.images.at(0).file, "my wall.png");
    EXPECT_EQ(bumps.material.bump_map->multiplier, 0.25f);
    EXPECT_EQ(bumps.material.bump_map->texture.rows[0], vec3(2, 0, 0));
    EXPECT_EQ(file("map_Kd a -x b.png"), "a -x b.png");
}

TEST_F(MtlTextures, NeedTheNameOfAFile) {
    material("Kd 1\nmap_Kd\nnorm -bm 1 \nmap_Kd -s 1\n");
    ASSERT_EQ(library_warnings_.size(), 2u);
    EXPECT_EQ(folder_.without_folder(library_warnings_[0]),
              "m.mtl:3: map_Kd names no file, and is ignored (2 times)");
    EXPECT_EQ(folder_.without_folder(library_warnings_[1]), "m.mtl:4: norm names no file, and is ignored");
}

TEST_F(MtlTextures, RefusesMalformedOptions) {
    const auto option = [&](const std::string& options, const std::string& cause) {
        expect_error("map_Kd " + options + " a.png", "m.mtl:2: the option " + cause);
    };
    for (const std::string name : {"-s", "-o", "-t", "-bm", "-boost", "-texres", "-mm 1"}) {
        const std::string first = name.substr(0, name.find(' '));
        option(name, first + " of map_Kd needs a finite number, found \"a.png\"");
        option(name + " nan", first + " of map_Kd needs a finite number, found \"nan\"");
        const std::string max = name == "-bm" ? "1000" : "1e+06";
        option(name + " -2e6", first + " of map_Kd needs numbers of at most " + max + ", found \"-2e6\"");
    }
    option("-s 1 2e6", "-s of map_Kd needs numbers of at most 1e+06, found \"2e6\"");
    for (const std::string name : {"-clamp", "-blendu", "-blendv", "-cc"})
        option(name, name + " of map_Kd needs on or off, found \"a.png\"");
    option("-imfchan rg", "-imfchan of map_Kd needs r, g, b, m, l or z, found \"rg\"");
}

TEST_F(MtlTextures, LoadOrAreRefusedAfterAnyChangeOfAByte) {
    const std::string good =
        "map_Kd -s 2 3 -o 0 -clamp on a b.png\nd 0.5\nmap_d -imfchan m a.png\nnorm -bm 2 n.png\nPm 1\nPr "
        "0.5\n"
        "map_Ke -mm 0 1 -blendu off e.png\n";
    const std::string likely = "-slamponbfichgrdPK. 019\n\\";
    const size_t refused =
        count_refused(good, likely, 1000, [&](const std::string& text) { material(text); });
    EXPECT_GT(refused, 150u);
    EXPECT_LT(refused, 1000u);
}

}  // namespace
}  // namespace candela
