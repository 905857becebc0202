// MTL files: the material that each statement makes, and what is refused, with which message.
#include "load/obj/mtl.h"

#include <gtest/gtest.h>

#include "damage.h"
#include "scene_fixture.h"

namespace candela {
namespace {

class Mtl : public testing::Test {
  protected:
    MtlLibrary load(const std::string& text) {
        folder_.write("m.mtl", text);
        return load_mtl(folder_.path() / "m.mtl", FileReach(folder_.path() / "m.obj"));
    }

    // The one material of a file, whose statements are `text`, from line 2 on.
    MtlMaterial material(const std::string& text) { return load("newmtl a\n" + text).materials.at("a"); }

    template <class Model>
    Model model(const std::string& text) {
        return std::get<Model>(material(text).material.model);
    }

    void expect_error(const std::string& text, const std::string& message) {
        SCOPED_TRACE(text);
        EXPECT_EQ(folder_.without_folder(error_of([&] { load(text); })), message);
    }

    // Checks the one warning of a material, after its place and name.
    void expect_warning(const std::string& text, const std::string& warning) {
        SCOPED_TRACE(text);
        const std::vector<std::string> warnings = material(text).warnings;
        ASSERT_EQ(warnings.size(), 1u);
        EXPECT_EQ(folder_.without_folder(warnings[0]), "m.mtl:1: material \"a\": " + warning);
    }

    SceneFolder folder_;
};

TEST_F(Mtl, WithoutHighlightIsDiffuse) {
    for (const char* text :
         {"Kd 0.1 0.2 0.3", "Kd 0.1 0.2 0.3\nKs 0 0 0\nNs 5\nillum 2",
          "Kd 0.1 0.2 0.3\nKs 1 1 1\nNs 5\nillum 1", "Ks 1 1 1\nKd .1 +.2 3e-1 1 # red\nillum 0"}) {
        SCOPED_TRACE(text);
        EXPECT_EQ(model<DiffuseMaterial>(text).reflectance, vec3(0.1f, 0.2f, 0.3f));
        EXPECT_TRUE(material(text).warnings.empty());
    }
}

TEST_F(Mtl, WithHighlightIsPhong) {
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

TEST_F(Mtl, ClampsExponentsThatAreTooGreat) {
    EXPECT_EQ(model<PhongMaterial>("Ks 0.5\nNs 200000").exponent, 1e5f);
    expect_warning("Ks 0.5\nNs 200000", "Ns 200000 is read as 100000, the greatest exponent");
}

// The sums are 0.4, 1.6 and 0.75, so that all is divided by 1.6; the quotients are exact.
TEST_F(Mtl, ScalesWhatWouldMakeLight) {
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

TEST_F(Mtl, IlluminationMakesMirrorsAndGlass) {
    for (const char* illum : {"\nillum 3", "\nillum 5"}) {
        const std::string text = illum;
        EXPECT_EQ(model<MirrorMaterial>("Kd 1 0 0\nKs 0.9 0.8 0.7" + text).reflectance,
                  vec3(0.9f, 0.8f, 0.7f));
        EXPECT_EQ(model<MirrorMaterial>("Kd 1 0 0" + text).reflectance, vec3(1));
        EXPECT_EQ(model<MirrorMaterial>("Ks 0 0 0" + text).reflectance, vec3(0));
    }
    for (const char* illum : {"\nillum 4", "\nillum 6", "\nillum 7"}) {
        const std::string text = "Kd 1 1 1\nKs 1 1 1\nd 0.1\nTf 1 1 1" + std::string(illum);
        EXPECT_EQ(model<DielectricMaterial>(text).ior, 1.5f);
        EXPECT_EQ(model<DielectricMaterial>(text + "\nNi 1.33").ior, 1.33f);
        EXPECT_FALSE(model<DielectricMaterial>(text).exterior_ior);
        EXPECT_TRUE(material(text).warnings.empty());
    }
    for (const char* illum : {"8", "9", "10"}) {
        const std::string text = std::string("Kd 0.5\nKs 0.5\nillum ") + illum;
        EXPECT_EQ(model<PhongMaterial>(text).specular, vec3(0.5f));
        expect_warning(text,
                       std::string("illum ") + illum + " is not supported; the material is read as illum 2");
    }
}

TEST_F(Mtl, EmissionIsTakenAsItIs) {
    const MtlMaterial lamp = material("Kd 0.5\nKe 10 20.5 0");
    EXPECT_EQ(lamp.emission, vec3(10, 20.5f, 0));
    EXPECT_EQ(std::get<DiffuseMaterial>(lamp.material.model).reflectance, vec3(0.5f));
    EXPECT_EQ(model<DiffuseMaterial>("Ke 1 1 1").reflectance, vec3(0));
    EXPECT_EQ(material("Kd 0.5").emission, vec3(0));
}

TEST_F(Mtl, WithoutColourIsGrey) {
    for (const char* text : {"Ka 1 1 1", "Ks 0 0 0", "Ke 0", "map_d a.png"}) {
        expect_warning(text, "it has no colour (Kd); grey of 0.5 is taken");
        EXPECT_EQ(model<DiffuseMaterial>(text).reflectance, vec3(0.5f));
    }
}

TEST_F(Mtl, OpacityIsDOrElseWhatTrLeaves) {
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
    EXPECT_EQ(opacity("illum 7\nd 7"), 1.0f);
    for (const char* text : {"d 0.5\nTr 0", "Tr 1\nd 0.5"})  // d counts: it is in the specification.
        EXPECT_EQ(opacity(text), 0.5f);
}

TEST_F(Mtl, WarnsOfOddOpacity) {
    expect_warning("Kd 1\nd 0", "nothing is seen of it: d is 0, or Tr is 1");
    expect_warning("Kd 1\nTr 1", "nothing is seen of it: d is 0, or Tr is 1");
    expect_warning("Kd 1\nd 1.5", "d 1.5 is not from 0 to 1; the material is taken to be opaque");
    expect_warning("Kd 1\nTr -3", "Tr -3 is not from 0 to 1; the material is taken to be opaque");
    EXPECT_EQ(material("d 1.5").material.opacity.value, 1.0f);
    const MtlMaterial none = material("Kd 1\nTr 2");
    EXPECT_EQ(none.material.opacity.value, 0.0f);
    ASSERT_EQ(none.warnings.size(), 2u);
    EXPECT_NE(none.warnings[0].find("Tr 2 is not from 0 to 1; the material is taken to be transparent"),
              std::string::npos);
}

TEST_F(Mtl, ListsWhatIsIgnoredOnceForTheFile) {
    const MtlLibrary library = load(
        "newmtl a\nKd 1\nmap_Ka a.png\ndisp b.png\nPc 0.5\nNi 0\nsharpness 60\nTf 0 0 0\n"
        "newmtl b\nKd 1\nmap_Kd c.png\ndisp e.png\nrefl -type sphere f.png\ndecal g.png\n"
        "map_foo h.png\nPc 1\nfoo\n");
    ASSERT_EQ(library.warnings.size(), 2u);
    EXPECT_EQ(
        folder_.without_folder(library.warnings[0]),
        "m.mtl: ignored map_Ka, disp, refl, decal, map_foo (textures of these kinds are not supported)");
    EXPECT_EQ(folder_.without_folder(library.warnings[1]), "m.mtl: ignored Pc, foo (unknown statements)");
    std::string many = "newmtl a\nKd 1\n";
    for (int i = 0; i < 30; ++i)
        many += 'x' + std::to_string(i) + '\n';
    EXPECT_NE(load(many).warnings.at(0).find("x18, x19, ... (unknown statements)"), std::string::npos);
}

TEST_F(Mtl, ReadsNamesAndLinesOfAllKinds) {
    const MtlLibrary library = load(
        "# comment\r\n\r\n  newmtl  red clay \t\r\n\tKd 1 0 0\r\nnewmtl b\rKd\t0 1 0\rnewmtl \xC3\xA9\n#Kd "
        "2\nKd 0 0 1");
    ASSERT_EQ(library.materials.size(), 3u);
    const auto reflectance = [&](const char* name) {
        return std::get<DiffuseMaterial>(library.materials.at(name).material.model).reflectance;
    };
    EXPECT_EQ(reflectance("red clay"), vec3(1, 0, 0));
    EXPECT_EQ(reflectance("b"), vec3(0, 1, 0));
    EXPECT_EQ(reflectance("\xC3\xA9"), vec3(0, 0, 1));
    EXPECT_EQ(library.materials.at("b").material.name, "b");
    EXPECT_TRUE(library.warnings.empty());
}

TEST_F(Mtl, TakesTheFirstOfEqualNames) {
    const MtlLibrary library = load("newmtl a\nKd 0\nnewmtl b\nKd 1\nnewmtl a\nKd 1\n");
    EXPECT_EQ(std::get<DiffuseMaterial>(library.materials.at("a").material.model).reflectance, vec3(0));
    ASSERT_EQ(library.warnings.size(), 1u);
    EXPECT_EQ(folder_.without_folder(library.warnings[0]),
              "m.mtl:5: material \"a\" is defined again; the first definition counts");
}

TEST_F(Mtl, RefusesWhatIsNoNumberOrOutOfRange) {
    const std::string a = "newmtl a\n";
    for (const std::string command : {"Kd", "Ks", "Ke"}) {
        for (const std::string word : {"-0.1", "nan", "inf", "1e39", "1,5", "x", "spectral", "+-1"}) {
            expect_error(
                a + command + " 1 " + word + " 1",
                "m.mtl:2: " + command + " needs finite numbers of at least 0, found \"" + word + '"');
        }
        expect_error(a + command, "m.mtl:2: " + command + " needs one or three numbers, found 0");
        expect_error(a + command + " 1 1 # 1",
                     "m.mtl:2: " + command + " needs one or three numbers, found 2");
    }
    for (const std::string command : {"Ns", "Ni", "d", "Tr"}) {
        expect_error(a + "\n" + command + " 1x",
                     "m.mtl:3: " + command + " needs a finite number, found \"1x\"");
        expect_error(a + command, "m.mtl:2: " + command + " needs a finite number, found \"\"");
    }
    expect_error(a + "Ns -1", "m.mtl:2: Ns, an exponent, must not be negative");
    for (const char* ior : {"0", "-1.5", "1e-60"})
        expect_error(a + "Ni " + ior + "\nillum 7", "m.mtl:2: Ni of the glass \"a\" must be above 0");
    for (const std::string word : {"11", "-1", "2.5", "x", "", "99999999999"})
        expect_error(a + "illum " + word,
                     "m.mtl:2: illum needs a whole number from 0 to 10, found \"" + word + '"');
}

TEST_F(Mtl, RefusesWhatIsNoLibrary) {
    const std::string none = "m.mtl: the file has no materials (lines \"newmtl name\"); is it an MTL file?";
    expect_error("", none);
    expect_error("# nothing\n\n", none);
    expect_error("newmtl\nKd 1", "m.mtl:1: newmtl needs the name of the material");
    expect_error("# b\nKd 1\nnewmtl a", "m.mtl:2: \"Kd\" stands before the first newmtl; is it an MTL file?");
    expect_error("\xEF\xBB\xBFnewmtl a",
                 "m.mtl:1: the file begins with a byte order mark; save it without one");
}

TEST_F(Mtl, LoadsOrIsRefusedAfterAnyChangeOfAByte) {
    const std::string good =
        "newmtl a\nKd 1 0.5 0\nKs 0.5 0.5 0.5\nNs 10\nillum 2\nd 0.5\nnewmtl b\nillum 7\nNi 1.5\nmap_Kd "
        "x.png\n";
    const std::string likely = "KdsNietwm#-.e0123 \n\r";
    const size_t refused = count_refused(good, likely, 2000, [&](const std::string& text) { load(text); });
    EXPECT_GT(refused, 300u);
    EXPECT_LT(refused, 2000u);
}

}  // namespace
}  // namespace candela
