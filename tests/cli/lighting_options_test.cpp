// Light from the command line, and surfaces that are seen from behind: what is said and written.
#include "cli/cli_fixture.h"
#include "image/texel_io.h"

namespace candela {
namespace {

// A single-sided, dark square of 2 x 2 metres in a picture of 4 x 4, under a sky; it faces the camera or not.
std::string square(bool faces) {
    return std::string(R"({
        "cameras": { "main": { "position": [0, 0, 4], "look_at": [0, 0, 0], "orthographic_height": 4 } },
        "materials": { "dark": { "type": "principled", "base_color": 0, "specular": 0, "double_sided": false } },
        "environment": { "radiance": 0.25 },
        "shapes": [ { "type": "quad", "material": "dark", "vertices": )") +
           (faces ? "[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]"
                  : "[[-1, 1, 0], [1, 1, 0], [1, -1, 0], [-1, -1, 0]]") +
           " } ] }";
}

class LightingOptionsTest : public CliTest {
  protected:
    ProcessResult picture(const std::string& scene, const Words& arguments) const {
        return candela(Words{"render", scene, "--size", "8x8", "--spp", "4", "--quiet", "-o", file("a.exr")} +
                       arguments);
    }
    float red(uint32_t x, uint32_t y) const { return read_exr(file("a.exr")).find("R")->values[8 * y + x]; }
    void expect_refused(const Words& arguments, const std::string& message) const {
        const ProcessResult result = picture(CORNELL_BOX, arguments);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_EQ(result.err.rfind("candela: error: " + message, 0), 0u) << result.err;
    }
};

TEST_F(LightingOptionsTest, BacksAreInvisibleUnlessAllSurfacesAreDoubleSided) {
    const std::string back = write("back.json", square(false)), front = write("front.json", square(true));
    EXPECT_EQ(picture(front, {}).err, "");
    EXPECT_EQ(red(4, 4), 0.0f);
    EXPECT_EQ(picture(back, {}).err,
              "candela: warning: single-sided surfaces are seen from behind, and are invisible, in about "
              "25.0 % of the "
              "picture; if something looks hollow, use --double-sided\n");
    EXPECT_EQ(red(4, 4), 0.25f);
    EXPECT_EQ(picture(back, {"--double-sided"}).err, "");
    EXPECT_EQ(red(4, 4), 0.0f);
    EXPECT_EQ(red(0, 0), 0.25f);
}

TEST_F(LightingOptionsTest, TheSkyIsReplacedScaledTurnedAndHidden) {
    const std::string scene = write("front.json", square(true));
    Image sky{.full = {4, 2}, .data = {0, 0, 4, 2}, .channels = {}, .attributes = {}};
    for (const char* name : {"R", "G", "B"})
        sky.add(name).values = {1, 2, 2, 4, 1, 2, 2, 4};  // 2 in the middle, towards -Z.
    write_exr(file("sky.exr"), sky);
    ASSERT_EQ(picture(scene, {"--environment", file("sky.exr")}).exit_code, 0);
    EXPECT_EQ(red(0, 0), 2.0f);
    ASSERT_EQ(picture(scene, {"--environment", file("sky.exr"), "--environment-intensity", "1.5",
                              "--environment-rotation", "90"})
                  .exit_code,
              0);
    EXPECT_EQ(red(0, 0), 6.0f);  // What was on the right lies before the camera.
    ASSERT_EQ(picture(scene, {"--environment-hidden"}).exit_code, 0);
    EXPECT_EQ(red(0, 0), 0.0f);
    ASSERT_EQ(picture(scene, {"--studio", "white"}).exit_code, 0);
    EXPECT_NEAR(red(0, 0), 1.0f, 1e-5f);
}

// The camera looks along -Z: at the horizon below the sun, or opposite to it. Aerosol scatters forwards.
TEST_F(LightingOptionsTest, ASkyHasItsSunWhereTheNumbersSay) {
    const std::string scene = write("front.json", square(true));
    ASSERT_EQ(picture(scene, {"--sky", "3,540"}).exit_code, 0);
    const float sun = red(0, 0);
    ASSERT_EQ(picture(scene, {"--sky", "3,0"}).exit_code, 0);
    EXPECT_GT(sun, 10.0f * red(0, 0));
    ASSERT_EQ(picture(scene, {"--sky", "-6,0"}).err, "");
}

// Not black: a dark model would vanish. The EXR stays as it is, and its parts are developed in the same way.
TEST_F(LightingOptionsTest, AModelInTheStudioStandsBeforeASoftGrey) {
    const std::string scene = write("front.json", square(true));
    const auto corner = [this](const char* name) {
        std::vector<std::string> warnings;
        return 255.0f * texel_codes(decode_texels(read_file(file(name)), name, warnings), 0).y;
    };
    const Words png = {"-o", file("a.png"), "--tonemap", "agx"};
    for (const char* studio : {"default", "softbox"}) {
        ASSERT_EQ(picture(scene, png + Words{"--studio", studio}).exit_code, 0);
        EXPECT_EQ(corner("a.png"), 188.0f);
        EXPECT_EQ(red(0, 0), 0.0f);
        EXPECT_EQ(read_exr(file("a.exr")).find("FirstHit.A"), nullptr);
    }
    ASSERT_EQ(candela({"merge", file("a.exr"), "-o", file("b.png")}).exit_code, 0);
    EXPECT_EQ(corner("b.png"), 188.0f);
    ASSERT_EQ(picture(scene, png + Words{"--studio", "default", "--background", "#000000"}).exit_code, 0);
    EXPECT_EQ(corner("a.png"), 0.0f);
    ASSERT_EQ(picture(scene, png + Words{"--environment-hidden"}).exit_code, 0);
    EXPECT_EQ(corner("a.png"), 0.0f);
}

TEST_F(LightingOptionsTest, WhatCannotBeDoneIsRefused) {
    expect_refused(
        {"--environment-intensity", "-1"},
        "--environment-intensity: cannot use \"-1\"; expected a number of at least 0, such as 1.5");
    expect_refused({"--environment-rotation", "east"},
                   "--environment-rotation: cannot use \"east\"; expected a number of degrees, such as 90");
    for (const char* text :
         {"-6.1,0", "90.1,0", "30", "30,east", "30,0,0.9", "30,0,11", "30,0,2,1", "nan,0"}) {
        expect_refused(
            {"--sky", text},
            std::string("--sky: cannot use \"") + text +
                "\"; expected ELEVATION,AZIMUTH or ELEVATION,AZIMUTH,TURBIDITY: where the sun stands "
                "in degrees, with an elevation from -6 to 90 (below 0 is twilight), and a turbidity "
                "from 1 to 10, such as 30,120,2");
    }
    expect_refused({"--studio", "white", "--sky", "30,0"},
                   "--sky and --studio both light the scene; give one of them");
    expect_refused({"--studio", "white", "--environment", "sky.exr"},
                   "--environment and --studio both light the scene; give one of them");
    const ProcessResult none = picture(CORNELL_BOX, {"--environment-hidden"});
    EXPECT_EQ(none.exit_code, 2);
    EXPECT_CONTAINS(none.err,
                    "the scene has no environment to turn, scale or hide; give one (--environment FILE)");
    // The image of the sky is one of the scene's files.
    const std::string sky = file("a.exr");
    ASSERT_EQ(picture(CORNELL_BOX, {"--aov", "none"}).exit_code, 0);
    const ProcessResult same = picture(CORNELL_BOX, {"--environment", sky});
    EXPECT_EQ(same.exit_code, 2);
    EXPECT_CONTAINS(same.err, "is the same file as -o");
}

}  // namespace
}  // namespace candela
