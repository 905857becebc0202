// Catchers as a user sees them: pictures with a shadow, layers that merge, and what is said of wrong options.
#include "base/color.h"
#include "cli/cli_fixture.h"
#include "image/texel_io.h"

namespace candela {
namespace {

class CatcherOptionsTest : public CliTest {
  protected:
    // Renders a ball under a sky in 24 x 24 pixels.
    ProcessResult render_ball(const Words& arguments) const {
        return candela(Words{"render", scene_, "--size", "24x24", "--spp", "16", "--quiet"} + arguments);
    }
    TexelImage picture(const std::string& name) const {
        std::vector<std::string> warnings;
        return decode_texels(read_file(file(name)), name, warnings);
    }
    // The most opaque black pixel of a transparent picture.
    static size_t deepest_shadow(const TexelImage& image) {
        size_t deepest = 0;
        for (size_t i = 0; i < 24 * 24; ++i) {
            const vec4 codes = texel_codes(image, i);
            if (vec3(codes) == vec3(0) && codes.w > texel_codes(image, deepest).w) deepest = i;
        }
        return deepest;
    }
    void expect_refused(const Words& arguments, int exit_code, const std::string& message) const {
        const ProcessResult result = render_ball(Words{"-o", file("never.png")} + arguments);
        EXPECT_EQ(result.exit_code, exit_code);
        EXPECT_EQ(result.err.rfind("candela: error: " + message, 0), 0u) << result.err;
    }

    std::string scene_ = write("ball.json", R"({
        "cameras": { "main": { "position": [0, 4, 8], "look_at": [0, 0.3, 0], "vertical_fov": 35 } },
        "materials": { "white": { "type": "diffuse", "reflectance": 1 }, "lit": { "type": "principled", "emission": 1 } },
        "environment": { "radiance": 1 },
        "shapes": [ { "type": "sphere", "center": [0, 0.5, 0], "radius": 0.5, "material": "white" },
                    { "type": "sphere", "center": [0, 9, 0], "radius": 0.1, "material": "lit" } ] })");
};

// The ground's pixels are black, as opaque as the shadow is deep.
TEST_F(CatcherOptionsTest, ATransparentPictureHasASoftShadow) {
    ASSERT_EQ(
        render_ball({"--ground", "catch", "--background", "transparent", "-o", file("a.png")}).exit_code, 0);
    const TexelImage image = picture("a.png");
    const size_t deepest = deepest_shadow(image);
    EXPECT_LT(texel_codes(image, 0).w, 0.15f);
    EXPECT_GT(texel_codes(image, deepest).w, texel_codes(image, 0).w + 0.1f);
    EXPECT_EQ(texel_codes(image, 11 * 24 + 12).w, 1.0f);  // The ball.
    EXPECT_GT(texel_codes(image, 11 * 24 + 12).x, 0.3f);

    ASSERT_EQ(render_ball({"--background", "transparent", "-o", file("b.png")}).exit_code, 0);
    EXPECT_EQ(texel_codes(picture("b.png"), deepest).w, 0.0f);
}

// The sky is not behind it, since that is what a catcher darkens.
TEST_F(CatcherOptionsTest, WithoutABackgroundItStandsBeforeGrey) {
    ASSERT_EQ(render_ball({"--ground", "catch", "-o", file("a.png")}).exit_code, 0);
    ASSERT_EQ(
        render_ball({"--ground", "catch", "--background", "transparent", "-o", file("b.png")}).exit_code, 0);
    const TexelImage image = picture("a.png");
    ASSERT_EQ(image.channels, 3u);
    const TexelImage shadow = picture("b.png");
    for (const size_t i : {size_t{0}, deepest_shadow(shadow)}) {  // #bcbcbc is the light 0.5.
        const float left = 0.5f * (1.0f - texel_codes(shadow, i).w);
        EXPECT_NEAR(texel_codes(image, i).x, srgb_encode(left), 2.0f / 255.0f);
    }
}

// In any order with the same bits; A is made anew of the merged layers, so it is that of one run of all
// samples but for rounding.
TEST_F(CatcherOptionsTest, PartsMergeLayerByLayer) {
    const Words ground = {"--ground", "catch-reflections", "--aov", "all"};
    ASSERT_EQ(render_ball(ground + Words{"-o", file("whole.exr")}).exit_code, 0);
    const auto part = [&](const char* name, const char* samples) {
        ASSERT_EQ(candela(Words{"render", scene_, "--size", "24x24", "--samples", samples, "-o", file(name)} +
                          ground)
                      .exit_code,
                  0);
    };
    part("1.exr", "0..5");
    part("2.exr", "5..16");
    ASSERT_EQ(candela({"merge", file("1.exr"), file("2.exr"), "-o", file("a.exr")}).exit_code, 0);
    ASSERT_EQ(candela({"merge", file("2.exr"), file("1.exr"), "-o", file("b.exr")}).exit_code, 0);
    const Image a = read_exr(file("a.exr")), b = read_exr(file("b.exr")), whole = read_exr(file("whole.exr"));
    ASSERT_EQ(a.channels.size(), whole.channels.size());
    for (const Channel& channel : a.channels) {
        EXPECT_EQ(channel.values, b.find(channel.name)->values) << channel.name;
        if (channel.name.starts_with("Variance") || channel.name.starts_with("N.")) continue;
        for (size_t i = 0; i < a.pixel_count(); ++i) {
            const float expected = whole.find(channel.name)->values[i];
            if (std::isinf(expected)) continue;
            ASSERT_NEAR(channel.values[i], expected, 1e-6f * (1.0f + std::abs(expected)))
                << channel.name << ' ' << i;
        }
    }
    // The mean of the parts' own alphas is another.
    const Image first = read_exr(file("1.exr")), second = read_exr(file("2.exr"));
    double apart = 0.0;
    for (size_t i = 0; i < a.pixel_count(); ++i) {
        const float mean = (5.0f * first.find("A")->values[i] + 11.0f * second.find("A")->values[i]) / 16.0f;
        apart = std::max(apart, double(std::abs(mean - a.find("A")->values[i])));
    }
    EXPECT_GT(apart, 1e-4);
}

TEST_F(CatcherOptionsTest, ResumedRenderingsHaveTheSameBits) {
    const Words ground = {"--ground", "catch"};
    const Words checkpoint = {"--checkpoint", file("state"), "--resume"};
    ASSERT_EQ(render_ball(ground + Words{"-o", file("whole.exr")}).exit_code, 0);
    ASSERT_EQ(render_ball(ground + checkpoint + Words{"--spp", "5", "-o", file("a.exr")}).exit_code, 0);
    ASSERT_EQ(render_ball(ground + checkpoint + Words{"-o", file("a.exr")}).exit_code, 0);
    const Image a = read_exr(file("a.exr")), whole = read_exr(file("whole.exr"));
    for (const Channel& channel : whole.channels)
        EXPECT_EQ(channel.values, a.find(channel.name)->values) << channel.name;
    EXPECT_EQ(render_ball(checkpoint + Words{"-o", file("a.exr")}).exit_code, 1);  // Without the ground.
}

TEST_F(CatcherOptionsTest, WrongOptionsAreRefused) {
    expect_refused({"--ground", "grass"}, 2,
                   "--ground: cannot use \"grass\"; expected show|catch|catch-reflections");
    expect_refused({"--shadow-catcher", "floor"}, 2,
                   "--shadow-catcher: unknown material \"floor\" (defined: white, lit)");
    expect_refused({"--shadow-catcher", "white", "--reflection-catcher", "floor"}, 2,
                   "--reflection-catcher: unknown material \"floor\" (defined: white, lit)");
    expect_refused({"--shadow-catcher", "lit"}, 1, scene_ + ":");
}

}  // namespace
}  // namespace candela
