// Pictures for the screen: backgrounds, alpha, formats, exposure, and what is said of impossible ones.
#include <cmath>

#include "cli/cli_fixture.h"
#include "image/texel_io.h"
#include "support/png_writer.h"

namespace candela {
namespace {

// A white sphere that fills half of the picture's height, alone or under a sky that the camera sees.
std::string ball(const std::string& rest) {
    return R"({ "cameras": { "main": { "position": [0, 0, 4], "look_at": [0, 0, 0], "orthographic_height": 4 } },
        "materials": { "white": { "type": "diffuse", "reflectance": 1 } },
        "shapes": [ { "type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "white" } ],)" +
           rest + "}";
}

class BackgroundOptions : public CliTest {
  protected:
    // Renders the sphere in 16 x 16 pixels.
    ProcessResult render_ball(const Words& arguments) const {
        return candela(Words{"render", scene_, "--size", "16x16", "--spp", "16"} + arguments);
    }
    TexelImage picture(const std::string& name) const {
        std::vector<std::string> warnings;
        return decode_texels(read_file(file(name)), name, warnings);
    }
    // Codes of 8 bits of the pixel in the corner, and of one in the middle.
    static vec4 corner(const TexelImage& image) { return 255.0f * texel_codes(image, 0); }
    static vec4 middle(const TexelImage& image) { return 255.0f * texel_codes(image, 8 * 16 + 8); }
    void expect_refused(const Words& arguments, const std::string& message) const {
        const ProcessResult result = render_ball(arguments);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_EQ(result.err.rfind("candela: error: " + message, 0), 0u) << result.err;
    }

    std::string scene_ = write("ball.json", ball(R"("environment": { "radiance": [0.5, 0.25, 1] })"));
};

TEST_F(BackgroundOptions, ATransparentPictureHasStraightAlphaAndTheExrIsPremultiplied) {
    ASSERT_EQ(render_ball({"--background", "transparent", "-o", file("a.png"), "-o", file("a.exr"), "-o",
                           file("a.webp")})
                  .exit_code,
              0);
    const Image exr = read_exr(file("a.exr"));
    const std::vector<float>&alpha = exr.find("A")->values, &red = exr.find("R")->values;
    EXPECT_EQ(alpha, exr.find("FirstHit.A")->values);  // No glass.
    size_t edges = 0;
    for (const char* name : {"a.png", "a.webp"}) {
        const TexelImage image = picture(name);
        ASSERT_EQ(image.channels, 4u);
        for (size_t i = 0; i < alpha.size(); ++i) {
            const vec4 codes = texel_codes(image, i);
            ASSERT_NEAR(codes.w, alpha[i], 0.5 / 255 + 1e-6);
            if (alpha[i] == 0.0f || image.type != TexelType::unorm8 || name[2] != 'p') continue;
            // A white surface in a sky of (0.5, 0.25, 1) has its colour, also at its edges.
            EXPECT_NEAR(codes.x * 255.0f, 188, 2) << i;
            EXPECT_NEAR(red[i], 0.5f * alpha[i], 0.01f) << i;
            edges += alpha[i] < 1.0f;
        }
    }
    EXPECT_GT(edges, 8u);
    EXPECT_EQ(corner(picture("a.png")), vec4(0.0f));
}

TEST_F(BackgroundOptions, AColourOrAnImageLiesBehind) {
    ASSERT_EQ(
        render_ball({"--background", "#12aBfF", "--tonemap", "aces", "--exposure", "3", "-o", file("a.png")})
            .exit_code,
        0);
    EXPECT_EQ(picture("a.png").channels, 3u);
    EXPECT_EQ(corner(picture("a.png")), vec4(0x12, 0xAB, 0xFF, 255));
    // The picture itself as the background: nothing changes where the background is seen.
    ASSERT_EQ(render_ball({"--background", file("a.png"), "-o", file("b.png"), "-o", file("b.jpg"),
                           "--quality", "100"})
                  .exit_code,
              0);
    EXPECT_EQ(corner(picture("b.png")), vec4(0x12, 0xAB, 0xFF, 255));
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(corner(picture("b.jpg"))[c], corner(picture("b.png"))[c], 3.0f);
    EXPECT_EQ(middle(picture("b.png")), vec4(188, 137, 255, 255));  // White in the sky (0.5, 0.25, 1).
}

TEST_F(BackgroundOptions, WithoutOneTheSkyIsSeenAndNothingChanges) {
    ASSERT_EQ(render_ball({"-o", file("a.png"), "-o", file("a.exr")}).exit_code, 0);
    EXPECT_EQ(corner(picture("a.png")), vec4(188, 137, 255, 255));
    const Image exr = read_exr(file("a.exr"));
    EXPECT_EQ(exr.find("A")->values, std::vector<float>(256, 1.0f));
    EXPECT_EQ(exr.find("FirstHit.A"), nullptr);
}

TEST_F(BackgroundOptions, GlassIsSeenThroughUnlessFirstHitsDecide) {
    const std::string glass = write("glass.json", R"({
        "cameras": { "main": { "position": [0, 0, 4], "look_at": [0, 0, 0], "orthographic_height": 1 } },
        "materials": { "glass": { "type": "dielectric", "ior": 1.5 } },
        "shapes": [ { "type": "box", "min": [-1, -1, -1], "max": [1, 1, 0], "material": "glass" } ] })");
    const auto alpha = [&](const Words& convention) {
        EXPECT_EQ(candela(Words{"render", glass, "--size", "8x8", "--spp", "64", "--background",
                                "transparent", "-o", file("a.exr"), "--aov", "none"} +
                          convention)
                      .exit_code,
                  0);
        double sum = 0.0;
        const Image image = read_exr(file("a.exr"));
        for (const float value : image.find("A")->values)
            sum += double(value) / 64;
        return sum;
    };
    // (1 - 0.04)^2 passes; six standard errors of 4096 samples.
    EXPECT_NEAR(alpha({}), 1.0 - 0.9216, 6.0 * std::sqrt(0.9216 * 0.0784 / 4096));
    EXPECT_EQ(alpha({"--alpha", "transmission"}), alpha({}));
    EXPECT_EQ(alpha({"--alpha", "first-hit"}), 1.0);
}

// Parts keep both alphas, and their merge is developed as the whole is.
TEST_F(BackgroundOptions, MergedPartsGoBeforeABackground) {
    const Words common = {"--background", "#204060", "-o"};
    ASSERT_EQ(render_ball(common + Words{file("whole.png")}).exit_code, 0);
    for (const char* samples : {"0..8", "8..16"}) {
        ASSERT_EQ(candela(Words{"render", scene_, "--size", "16x16", "--samples", samples} + common +
                          Words{file(samples) + ".exr"})
                      .exit_code,
                  0);
    }
    const ProcessResult merged =
        candela(Words{"merge", file("0..8.exr"), file("8..16.exr")} + common + Words{file("merged.png")});
    ASSERT_EQ(merged.exit_code, 0) << merged.err;
    EXPECT_EQ(merged.err, "");
    EXPECT_EQ(corner(picture("merged.png")), vec4(0x20, 0x40, 0x60, 255));
    const TexelImage a = picture("whole.png"), b = picture("merged.png");
    for (size_t i = 0; i < 256; ++i)
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(texel_codes(a, i)[c], texel_codes(b, i)[c], 1.01 / 255);
    // A picture before the sky is another picture.
    ASSERT_EQ(
        candela({"render", scene_, "--size", "16x16", "--samples", "8..16", "-o", file("sky.exr")}).exit_code,
        0);
    EXPECT_NE(candela({"merge", file("0..8.exr"), file("sky.exr"), "-o", file("no.exr")}).exit_code, 0);
}

TEST_F(BackgroundOptions, APngHas16BitsIfAskedForAndSaysHowItWasMade) {
    ASSERT_EQ(
        render_ball({"--bits", "16", "-o", file("a.png"), "-o", file("a.exr"), "--seed", "9"}).exit_code, 0);
    const TexelImage image = picture("a.png");
    EXPECT_EQ(image.type, TexelType::unorm16);
    const double expected = 1.055 * std::pow(0.5, 1.0 / 2.4) - 0.055;
    EXPECT_NEAR(texel_codes(image, 0).x, expected, 1e-5);
    const std::string png = read_file(file("a.png"));
    const auto& attributes = read_exr(file("a.exr")).attributes;
    for (const char* name : {"candela.seed", "candela.samples", "candela.camera", "candela.identity",
                             "candela.device", "candela.version"}) {
        const auto& text = std::get<std::string>(attributes.at(name));
        EXPECT_CONTAINS(png, png_chunk("tEXt", name + std::string(1, '\0') + text));
    }
    EXPECT_EQ(png.find(scene_), std::string::npos);  // No command line, which names folders.
    // So pictures of equal codes are equal files.
    ASSERT_EQ(render_ball({"--bits", "16", "-o", file("b.png"), "--seed", "9"}).exit_code, 0);
    EXPECT_EQ(read_file(file("b.png")), png);
}

TEST_F(BackgroundOptions, AnExrGoesToStandardOutput) {
    const ProcessResult result = render_ball({"-o", "-", "-o", file("a.exr"), "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const Image there = decode_exr(result.out, "stdout"), here = read_exr(file("a.exr"));
    EXPECT_EQ(there.find("R")->values, here.find("R")->values);
    const ProcessResult merged = candela({"merge", file("a.exr"), "-o", "-"});
    EXPECT_EQ(decode_exr(merged.out, "stdout").find("R")->values, here.find("R")->values);
    EXPECT_EQ(merged.err, "merged 1 part: samples 0..16\n");
}

TEST_F(BackgroundOptions, AutomaticExposureIsFoundFromThePicture) {
    // All surfaces and the sky have the luminance 0.3573: 0.2126 / 2 + 0.7152 / 4 + 0.0722.
    const double expected = std::log2(0.8 / 0.3573);
    const ProcessResult result =
        render_ball({"--exposure", "auto", "-o", file("a.png"), "--report", file("r.json")});
    ASSERT_EQ(result.exit_code, 0);
    EXPECT_CONTAINS(result.err, "exposure: 1.16 EV\n");
    const auto report = nlohmann::json::parse(read_file(file("r.json")));
    EXPECT_NEAR(report["exposure"], expected, 0.01);
    ASSERT_EQ(render_ball({"--exposure", report["exposure"].dump(), "-o", file("b.png")}).exit_code, 0);
    EXPECT_EQ(read_file(file("a.png")), read_file(file("b.png")));
    // Before a background, that of the scene alone.
    ASSERT_EQ(render_ball({"--exposure", "auto", "--background", "#000000", "-o", file("a.png"), "--report",
                           file("r.json")})
                  .exit_code,
              0);
    EXPECT_NEAR(nlohmann::json::parse(read_file(file("r.json")))["exposure"], expected, 0.01);
}

TEST_F(BackgroundOptions, WhatCannotBeDoneIsRefused) {
    const std::string png = file("a.png");
    expect_refused({"-o", png, "--background", "#12345"},
                   "--background: cannot use \"#12345\"; expected transparent, #rrggbb or an image file");
    expect_refused({"-o", png, "--background", ""},
                   "--background: cannot use \"\"; expected transparent, #rrggbb or an image file");
    expect_refused({"-o", file("a.jpg"), "--background", "transparent"},
                   "--background: JPEG has no alpha for \"" + file("a.jpg") +
                       "\"; write .png or .webp, or give a colour such as '#ffffff'");
    expect_refused({"-o", png, "--bits", "12"}, "--bits: cannot use \"12\"; expected 8|16");
    expect_refused({"-o", png, "--quality", "0"},
                   "--quality: cannot use \"0\"; expected a whole number from 1 to 100");
    expect_refused({"-o", png, "--alpha", "none", "--background", "#000000"},
                   "--alpha: cannot use \"none\"; expected transmission|first-hit");
    expect_refused({"-o", png, "--exposure", "automatic"},
                   "--exposure: cannot use \"automatic\"; expected auto, first or a number from -100 to 100");
    expect_refused({"-o", "-", "-o", "-"}, "-o: standard output gets one image; give - once");
    expect_refused({"-o", "-", "--report", "-"},
                   "--report and -o both go to standard output; give one of them a file");
    EXPECT_EQ(render_ball({"-o", png, "--alpha", "first-hit"}).exit_code, 2);
    expect_refused(
        {"-o", png, "--background", png},
        "-o: \"" + png + "\" is the same file as --background \"" + png + "\"; give it a name of its own");
    const ProcessResult missing = render_ball({"-o", png, "--background", file("none.png")});
    EXPECT_EQ(missing.exit_code, 1);
    EXPECT_CONTAINS(missing.err, "candela: error: cannot read \"" + file("none.png") + "\": ");
    const ProcessResult text = render_ball({"-o", png, "--background", scene_});
    EXPECT_EQ(text.exit_code, 1);
    EXPECT_CONTAINS(text.err, "candela: error: cannot read \"" + scene_ + "\": ");
}

}  // namespace
}  // namespace candela
