// MTL files: what is read, ignored and refused, with which message.
#include "unit/base/damage.h"
#include "unit/load/obj/mtl_fixture.h"

namespace candela {
namespace {

TEST_F(Mtl, ListsWhatIsIgnoredOnceForTheFile) {
    expect_library_warnings(
        "newmtl a\nKd 1\nKa 1\nmap_Ka a.png\ndisp b.png\nKm 0.5\nNi 0\nsharpness 60\nTf spectral a.rfl\n"
        "newmtl b\nKd 1\nmap_Kd c.png\ndisp e.png\nrefl -type sphere f.png\ndecal g.png\n"
        "map_foo h.png\nKm 1\nfoo\nPx 1\n",
        {"m.mtl: ignored disp, refl, decal, map_foo (textures of these kinds are not supported)",
         "m.mtl: ignored Km, foo, Px (unknown statements)"});
    std::string many = "newmtl a\nKd 1\n";
    for (int i = 0; i < 30; ++i)
        many += 'x' + std::to_string(i) + '\n';
    EXPECT_NE(load(many).warnings.at(0).find("x18, x19 and 10 more (unknown statements)"), std::string::npos);
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
    expect_library_warnings("newmtl a\nKd 0\nnewmtl b\nKd 1\nnewmtl a\nKd 1\n",
                            {"m.mtl:5: material \"a\" is defined again; the first definition is used"});
    expect_library_warnings(
        "newmtl a\nKd 0\nnewmtl a\nKd 1\nnewmtl a\nKd 1\n",
        {"m.mtl:3: material \"a\" is defined again; the first definition is used (2 times)"});
}

TEST_F(Mtl, StatementsMayBeInUpperOrLowerCase) {
    const MtlLibrary library = load("NewMtl a\nkd 0.5 0.25 0\nMAP_KS b.png\nNORM n.png\nILLUM 2\n");
    const Material& read = library.materials.at("a").material;
    EXPECT_EQ(std::get<PhongMaterial>(read.model).diffuse.factor.x, 0.5f / 1.5f);
    EXPECT_TRUE(std::get<PhongMaterial>(read.model).specular.texture);
    EXPECT_TRUE(read.normal_map);
    EXPECT_TRUE(library.warnings.empty());
}

TEST_F(Mtl, RefusesWhatIsNoNumber) {
    const std::string a = "newmtl a\n";
    for (const std::string command : {"Kd", "Ks", "Ke"}) {
        for (const std::string word : {"1,5", "x", "spectral", "+-1"})
            expect_error(a + command + " 1 " + word + " 1",
                         "m.mtl:2: " + command + " needs a number, found \"" + word + '"');
        expect_error(a + command, "m.mtl:2: " + command + " needs one or three numbers, found 0");
        expect_error(a + command + " 1 1 # 1",
                     "m.mtl:2: " + command + " needs one or three numbers, found 2");
    }
    for (const std::string command : {"Ns", "Ni", "d", "Tr", "Pr"})
        expect_error(a + "\n" + command + " 1x", "m.mtl:3: " + command + " needs a number, found \"1x\"");
}

TEST_F(Mtl, CountsWhatIsNotFiniteOrOutOfRange) {
    for (const std::string word : {"nan", "-nan(ind)", "inf", "1e39", "-1.#IND", "1.#QNAN"}) {
        expect_library_warnings("newmtl a\nKd 1\nKd 0 " + word + " 0\nNs " + word + "\nNs nan",
                                {"m.mtl:3: Kd has no finite number, and is ignored",
                                 "m.mtl:4: Ns has no finite number, and is ignored (2 times)"});
        EXPECT_EQ(model<DiffuseMaterial>("Kd 1\nKd 0 " + word + " 0").reflectance, vec3(1));
    }
    expect_library_warnings("newmtl a\nKd 1\nd\nTr # none",
                            {"m.mtl:3: d has no finite number, and is ignored",
                             "m.mtl:4: Tr has no finite number, and is ignored"});
    expect_library_warnings("newmtl a\nKd 1 -0.5 1\nNs -3\nPr 1.5\nPm -1",
                            {"m.mtl:2: Kd is negative; 0 is used", "m.mtl:3: Ns -3 is read as 0",
                             "m.mtl:4: Pr 1.5 is read as 1", "m.mtl:5: Pm -1 is read as 0"});
    EXPECT_EQ(model<PrincipledMaterial>("Kd 1 -0.5 1\nPr 1.5").base_color, vec3(1, 0, 1));
    EXPECT_EQ(model<PrincipledMaterial>("Kd 1 -0.5 1\nPr 1.5").roughness, 1.0f);
    for (const std::string word : {"11", "-1", "2.5", "x", "", "99999999999"}) {
        expect_library_warnings(
            "newmtl a\nKd 1\nillum " + word,
            {"m.mtl:3: illum \"" + word + "\" is not a whole number from 0 to 10, and is read as 2"});
    }
    EXPECT_EQ(model<MirrorMaterial>("Ks 1\nillum 3.0").reflectance, vec3(1));
}

TEST_F(Mtl, MayBeEmpty) {
    for (const char* text : {"", "# nothing\n\n", "newmtl \nKd 1\n"})
        expect_library_warnings(text, {"m.mtl: the file has no materials"});
    const MtlLibrary library = load("\xEF\xBB\xBFnewmtl a\nKd 1\nnewmtl\nKd 0\nnewmtl b\nKd 1");
    EXPECT_EQ(library.materials.size(), 2u);
    EXPECT_TRUE(library.warnings.empty());
    expect_error("# b\nKd 1\nnewmtl a", "m.mtl:2: \"Kd\" comes before the first newmtl; is it an MTL file?");
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
