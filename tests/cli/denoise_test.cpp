// Denoising as a user sees it: `--denoise` of `render` and `merge`, and `candela denoise`. A library of the
// tests stands in for Open Image Denoise (tests/faults/fake_oidn.cpp): it gives twice the colour plus the
// albedo.
#include <algorithm>
#include <cmath>
#include <limits>

#include "cli/cli_fixture.h"
#include "denoise/blend.h"
#include "denoise/denoise_image.h"
#include "denoise/smooth_albedo.h"

namespace candela {
namespace {

using Variables = std::map<std::string, std::string>;

const Variables FAKE = {{"CANDELA_OIDN", CANDELA_FAKE_OIDN}};
const Variables MISSING = {{"CANDELA_OIDN", "/nowhere/oidn.so"}};
const std::string IS_MISSING = "Open Image Denoise, a library that removes noise, is not there";

class DenoiseTest : public CliTest {
  protected:
    static Words box(const Words& arguments) {
        return Words{"render", CORNELL_BOX, "--size", "32x32", "--quiet"} +
               (std::ranges::find(arguments, "--samples") == arguments.end() ? Words{"--spp", "4"}
                                                                             : Words{}) +
               arguments;
    }
    // Renders the Cornell box, and expects no message.
    static void render_box(const Words& arguments, const Variables& environment = FAKE) {
        const ProcessResult result = candela(box(arguments), environment);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err, "");
    }
    static Words names(const Image& image) {
        Words names;
        for (const Channel& channel : image.channels)
            names.push_back(channel.name);
        return names;
    }
};

const std::vector<float>& values(const Image& image, const std::string& channel) {
    return image.find(channel)->values;
}

TEST_F(DenoiseTest, NoisyLayersKeepTheirBitsBesideTheDenoisedOnes) {
    render_box({"-o", file("plain.exr")});
    render_box({"-o", file("both.exr"), "--denoise", "oidn"});
    const Image plain = read_exr(file("plain.exr")), both = read_exr(file("both.exr"));
    ASSERT_EQ(both.channels.size(), plain.channels.size() + 3) << testing::PrintToString(names(both));
    for (const Channel& channel : plain.channels)
        EXPECT_TRUE(channel.values == values(both, channel.name)) << channel.name;
    EXPECT_EQ(both.attributes.at("candela.identity"), plain.attributes.at("candela.identity"));
    // Compared as if it had never been denoised.
    const ProcessResult compared = candela({"compare", file("both.exr"), file("plain.exr"), "--relmse", "0"});
    EXPECT_EQ(compared.exit_code, 0) << compared.out;
}

// The layers that only the denoiser needs are not in the file, unless they are asked for.
TEST_F(DenoiseTest, OnlyWhatIsAskedForIsInTheFile) {
    render_box({"-o", file("a.exr"), "--denoise", "oidn", "--aov", "none"});
    EXPECT_EQ(names(read_exr(file("a.exr"))),
              (Words{"A", "B", "Denoised.B", "Denoised.G", "Denoised.R", "G", "R"}));
    render_box({"-o", file("b.exr"), "--denoise", "oidn", "--aov", "denoising,variance,samples"});
    const Image b = read_exr(file("b.exr"));
    EXPECT_EQ(b.channels.size(), 4u + 3 + 7 + 3 + 1);
    // What the library of the tests makes of it, blended with the noisy picture.
    const NoisyPicture noisy = noisy_picture(b, false, "b.exr");
    const std::vector<vec3> albedo = smooth_albedo(noisy, b.data);
    Denoised expected;
    for (size_t c = 0; c < 3; ++c) {
        for (size_t i = 0; i < b.pixel_count(); ++i)
            expected.rgb[c].push_back(2.0f * noisy.rgb[c][i] + std::min(albedo[i][int(c)], 1.0f));
    }
    blend_with(noisy, expected);
    for (size_t c = 0; c < 3; ++c) {
        const std::vector<float>& found = values(b, DENOISED[c]);
        for (size_t i = 0; i < b.pixel_count(); ++i)
            ASSERT_NEAR(found[i], expected.rgb[c][i], 1e-5f * std::abs(expected.rgb[c][i]));
    }
    EXPECT_TRUE(values(b, "Denoised.R") == values(read_exr(file("a.exr")), "Denoised.R"));
}

TEST_F(DenoiseTest, PicturesForTheScreenAreDenoised) {
    render_box({"-o", file("noisy.png"), "-o", file("plain.exr")});
    render_box({"-o", file("denoised.png"), "-o", file("a.exr"), "--denoise", "variance"});
    EXPECT_NE(read_file(file("noisy.png")), read_file(file("denoised.png")));
    // The same as of an image whose colours are the denoised ones.
    Image image = read_exr(file("a.exr"));
    std::erase_if(image.channels,
                  [](const Channel& c) { return c.name == "R" || c.name == "G" || c.name == "B"; });
    for (Channel& channel : image.channels) {
        if (channel.name.starts_with("Denoised.")) channel.name = channel.name.substr(9);
    }
    write_exr(file("renamed.exr"), image);
    const ProcessResult merged = candela({"merge", file("renamed.exr"), "-o", file("renamed.png")});
    ASSERT_EQ(merged.exit_code, 0) << merged.err;
    EXPECT_EQ(read_file(file("renamed.png")), read_file(file("denoised.png")));
}

TEST_F(DenoiseTest, TheReportSaysWhatDenoisedAndHashesTheNoisyPicture) {
    const auto report = [&](const Words& arguments) {
        const ProcessResult result =
            candela(box(Words{"-o", file("a.png"), "--report", "-"} + arguments), FAKE);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return nlohmann::json::parse(result.out);
    };
    const nlohmann::json plain = report({}), denoised = report({"--denoise", "auto"});
    EXPECT_TRUE(plain["denoiser"].is_null());
    EXPECT_TRUE(plain["denoiser_version"].is_null());
    EXPECT_TRUE(plain["denoise_seconds"].is_null());
    EXPECT_EQ(denoised["denoiser"], "oidn");
    EXPECT_EQ(denoised["denoiser_version"], "Open Image Denoise 2.5.1");
    EXPECT_GT(denoised["denoise_seconds"], 0.0);
    EXPECT_EQ(denoised["image_hash"], plain["image_hash"]);
}

TEST_F(DenoiseTest, TheExposureIsThatOfTheNoisyPicture) {
    const auto exposure = [&](const Words& arguments) {
        const ProcessResult result =
            candela(box(Words{"-o", file("a.png"), "--report", "-", "--exposure", "auto"} + arguments), FAKE);
        return nlohmann::json::parse(result.out)["exposure"].get<double>();
    };
    EXPECT_EQ(exposure({"--denoise", "oidn"}), exposure({}));
}

TEST_F(DenoiseTest, WithoutTheLibraryOidnIsAUsageErrorBeforeAnythingIsRendered) {
    const ProcessResult result =
        candela(box({"-o", file("a.png"), "--denoise", "oidn"}), MISSING + NO_DRIVER);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_CONTAINS(result.err, "candela: error: " + IS_MISSING + " (looked for in \"/nowhere/oidn.so\")");
    EXPECT_CONTAINS(result.err, "sh cmake/denoiser.sh");
    EXPECT_FALSE(std::filesystem::exists(file("a.png")));
}

// On the device, in `render`, `merge` and `denoise` alike, to the same bits.
TEST_F(DenoiseTest, WithoutTheLibraryAutoIsByVariance) {
    const Words aovs = {"--aov", "albedo,n,variance,samples,denoising"};
    const ProcessResult automatic =
        candela(box(Words{"-o", file("a.exr"), "--denoise", "auto", "--report", "-"} + aovs), MISSING);
    ASSERT_EQ(automatic.exit_code, 0) << automatic.err;
    EXPECT_EQ(nlohmann::json::parse(automatic.out)["denoiser"], "variance");
    const Image image = read_exr(file("a.exr"));
    const Channel* const denoised = image.find("Denoised.G");
    ASSERT_NE(denoised, nullptr);
    EXPECT_NE(denoised->values, image.find("G")->values);
    const std::vector<Words> ways = {
        box(Words{"-o", file("b.exr"), "--denoise", "variance"} + aovs),
        {"merge", file("a.exr"), "-o", file("b.exr"), "--denoise", "variance"},
        {"denoise", file("a.exr"), "-o", file("b.exr"), "--denoise", "variance", "--device", "0"}};
    for (const Words& way : ways) {
        const ProcessResult result = candela(way, FAKE);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(read_exr(file("b.exr")).find("Denoised.G")->values, denoised->values) << way.front();
    }
    const ProcessResult none =
        candela({"denoise", file("a.exr"), "-o", file("c.png"), "--denoise", "variance"}, NO_DRIVER);
    EXPECT_EQ(none.exit_code, 3) << none.err;
    EXPECT_FALSE(std::filesystem::exists(file("c.png")));
}

// Whatever fails when the picture is there: it is written as it is, and a warning says why.
TEST_F(DenoiseTest, ALibraryThatFailsHalfwayLosesNoPicture) {
    render_box({"-o", file("plain.exr"), "-o", file("plain.png")});
    for (const std::string where : {"filter", "execute"}) {
        const ProcessResult result =
            candela(box({"-o", file("a.exr"), "-o", file("a.png"), "--denoise", "oidn"}),
                    FAKE + Variables{{"FAKE_OIDN_FAILS", where}, {"FAKE_OIDN_AFTER", "1"}});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err, "candela: warning: the picture stays noisy: Open Image Denoise (\"" +
                                  std::string(CANDELA_FAKE_OIDN) + "\") failed: out of luck in " + where +
                                  '\n');
        EXPECT_EQ(names(read_exr(file("a.exr"))), names(read_exr(file("plain.exr"))));
        EXPECT_EQ(read_file(file("a.png")), read_file(file("plain.png")));
    }
    const ProcessResult version = candela(box({"-o", file("b.png"), "--denoise", "oidn"}),
                                          FAKE + Variables{{"FAKE_OIDN_VERSION", "1"}});
    EXPECT_EQ(version.exit_code, 1);
    EXPECT_CONTAINS(version.err, "it is version 1.5.1, and candela needs version 2");
}

TEST_F(DenoiseTest, PicturesOnTheWayAndOfBatchesAreDenoised) {
    const Words words = {"--size", "32x32", "--spp", "4", "--quiet", "--aov", "none", "--denoise", "oidn"};
    const ProcessResult result =
        candela(Words{"render", CORNELL_BOX, DEPTH_OF_FIELD, "-o", file("{stem}.exr")} + words, FAKE);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    for (const char* name : {"cornell-box.exr", "depth-of-field.exr"})
        EXPECT_NE(read_exr(file(name)).find("Denoised.R"), nullptr) << name;
    // The log has a line for each filter of each picture that is denoised: three of the last, and more
    // before.
    render_box({"-o", file("a.exr"), "--denoise", "oidn", "--spp", "64", "--write-every", "0.000001s"},
               FAKE + Variables{{"FAKE_OIDN_LOG", file("log")}});
    EXPECT_GT(std::ranges::count(read_file(file("log")), '\n'), 2);
}

// What glass shows of the background is as noisy as what it shows of the rest.
TEST_F(DenoiseTest, AlphaIsDenoisedWhereABackgroundIsSeen) {
    const Words words = {"-o",           file("a.exr"), "-o",    file("a.png"),
                         "--background", "transparent", "--aov", "none"};
    render_box(words + Words{"--denoise", "oidn"});
    const Image image = read_exr(file("a.exr"));
    ASSERT_NE(image.find("Denoised.A"), nullptr);
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        // The library gives twice the alpha plus the albedo, of which a share is blended with the alpha.
        ASSERT_GE(values(image, "Denoised.A")[i], values(image, "A")[i]);
        ASSERT_LE(values(image, "Denoised.A")[i], 1.0f);
    }
    render_box({"-o", file("b.exr"), "--aov", "none", "--denoise", "oidn"});
    EXPECT_EQ(read_exr(file("b.exr")).find("Denoised.A"), nullptr);
}

TEST_F(DenoiseTest, CheckpointsGoOnToTheSameBitsAndNameOtherOutputs) {
    const Words words = {"-o", file("a.exr"), "--checkpoint", file("state.exr"), "--denoise", "oidn"};
    render_box(words);
    render_box(words + Words{"--resume", "--spp", "8"});
    render_box({"-o", file("whole.exr"), "--denoise", "oidn", "--spp", "8"});
    const Image resumed = read_exr(file("a.exr")), whole = read_exr(file("whole.exr"));
    for (const Channel& channel : whole.channels)
        EXPECT_TRUE(channel.values == values(resumed, channel.name)) << channel.name;
    const ProcessResult without =
        candela(box({"-o", file("a.exr"), "--checkpoint", file("state.exr"), "--resume", "--spp", "16"}));
    EXPECT_EQ(without.exit_code, 1);
    EXPECT_CONTAINS(
        without.err,
        "it holds guides for denoisers, which the outputs do not need; give the same outputs, --aov "
        "and --denoise as for the checkpoint");
    std::filesystem::remove(file("state.exr"));
    render_box({"-o", file("a.exr"), "--checkpoint", file("state.exr")});
    const ProcessResult with = candela(box(words + Words{"--resume", "--spp", "16"}), FAKE);
    EXPECT_EQ(with.exit_code, 1);
    EXPECT_CONTAINS(with.err, "it holds no guides for denoisers, which the outputs need");
}

TEST_F(DenoiseTest, PartsAreMergedNoisyAndThenDenoised) {
    const Words layers = {"--aov", "albedo,n,variance,samples,denoising", "--denoise", "oidn"};
    render_box(Words{"-o", file("0.exr"), "--samples", "0..2"} + layers);
    render_box(Words{"-o", file("1.exr"), "--samples", "2..4"} + layers);
    render_box(Words{"-o", file("whole.exr")} + layers);
    const ProcessResult plain = candela({"merge", file("0.exr"), file("1.exr"), "-o", file("plain.exr")});
    EXPECT_EQ(plain.exit_code, 0) << plain.err;
    EXPECT_EQ(
        plain.err,
        "candela: warning: the layers Denoised of the parts are left out: the merged picture is denoised "
        "anew, by --denoise\n");
    const ProcessResult result =
        candela({"merge", file("0.exr"), file("1.exr"), "-o", file("a.exr"), "--denoise", "oidn"}, FAKE);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const Image merged = read_exr(file("a.exr")), whole = read_exr(file("whole.exr"));
    EXPECT_EQ(names(merged), names(whole));
    EXPECT_EQ(names(read_exr(file("plain.exr"))).size(), names(whole).size() - 3);
    // Parts, weights and sum are rounded: see film/part_sum.h. Colours are at most 30, normals at most 1.
    for (const Channel& channel : whole.channels) {
        if (channel.name.starts_with("Variance.") || is_denoised_channel(channel.name)) continue;
        for (size_t i = 0; i < whole.pixel_count(); ++i)
            ASSERT_NEAR(channel.values[i], values(merged, channel.name)[i],
                        4 * 0x1p-24 * std::max(1.0f, 2.0f * std::abs(channel.values[i])))
                << channel.name;
    }
    // As if the merged picture had been denoised later.
    ASSERT_EQ(
        candela({"denoise", file("plain.exr"), "-o", file("later.exr"), "--denoise", "oidn"}, FAKE).exit_code,
        0);
    for (const char* const name : DENOISED)
        EXPECT_TRUE(values(merged, name) == values(read_exr(file("later.exr")), name)) << name;
    const ProcessResult missing =
        candela({"merge", file("0.exr"), file("1.exr"), "-o", file("b.exr"), "--denoise", "oidn"}, MISSING);
    EXPECT_EQ(missing.exit_code, 2);
    EXPECT_CONTAINS(missing.err, IS_MISSING);
}

TEST_F(DenoiseTest, TheCommandDenoisesWhatWasRenderedBefore) {
    render_box({"-o", file("noisy.exr"), "--aov", "all"});
    render_box({"-o", file("at-once.exr"), "-o", file("at-once.png"), "--aov", "all", "--denoise", "oidn"});
    const ProcessResult result =
        candela({"denoise", file("noisy.exr"), "-o", file("later.exr"), "-o", file("later.png")}, FAKE);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(result.out, "denoised by Open Image Denoise 2.5.1 with DenoisingAlbedo and DenoisingNormal\n");
    const Image later = read_exr(file("later.exr")), at_once = read_exr(file("at-once.exr"));
    ASSERT_EQ(names(later), names(at_once));
    for (const Channel& channel : at_once.channels) {
        const std::vector<float>& others = values(later, channel.name);
        EXPECT_TRUE(std::ranges::equal(channel.values, others, [](float a, float b) {
            return a == b || (std::isnan(a) && std::isnan(b));
        })) << channel.name;
    }
    EXPECT_EQ(read_file(file("later.png")), read_file(file("at-once.png")));
    EXPECT_CONTAINS(std::get<std::string>(later.attributes.at("candela.commandLine")), " denoise ");
    const ProcessResult piped = candela({"denoise", file("noisy.exr"), "-o", "-"}, FAKE);
    EXPECT_EQ(piped.exit_code, 0);
    EXPECT_CONTAINS(piped.err, "denoised by Open Image Denoise 2.5.1");
    EXPECT_EQ(names(decode_exr(piped.out, "piped")), names(later));
}

// Images of other renderers may hold anything.
TEST_F(DenoiseTest, ForeignImagesAreDenoisedByWhatTheyHave) {
    Image image{.full = {5, 3}, .data = {1, 1, 4, 3}, .channels = {}, .attributes = {}};
    for (const char* name : {"R", "G", "B"})
        image.add(name, 0.25f);
    image.channels[0].values = {std::numeric_limits<float>::quiet_NaN(),
                                std::numeric_limits<float>::infinity(),
                                1e38f,
                                -1.0f,
                                0.25f,
                                0.25f};
    write_exr(file("foreign.exr"), image);
    const ProcessResult result =
        candela({"denoise", file("foreign.exr"), "-o", file("a.exr"), "-o", file("a.png"), "--half"}, FAKE);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(
        result.out,
        "denoised by Open Image Denoise 2.5.1 with colour alone: it has no layer Albedo (--aov albedo,n or, "
        "better, denoising); not blended with the noisy picture: it has no layer Variance (--aov "
        "variance)\n");
    const Image denoised = read_exr(file("a.exr"));
    EXPECT_EQ(denoised.data, image.data);
    for (const float value : values(denoised, "Denoised.R"))
        EXPECT_TRUE(std::isfinite(value) && value >= 0.0f);
    EXPECT_EQ(values(denoised, "Denoised.G")[0], 0.5f);
}

TEST_F(DenoiseTest, TheCommandExplainsWhatIsWrong) {
    render_box({"-o", file("a.exr"), "--aov", "none"});
    Image grey = read_exr(file("a.exr"));
    std::erase_if(grey.channels, [](const Channel& channel) { return channel.name != "G"; });
    write_exr(file("grey.exr"), grey);
    struct Case {
        Words words;
        Variables environment;
        int exit_code;
        std::string message;
    };
    const std::vector<Case> cases = {
        {{"denoise", file("a.exr")}, FAKE, 2, "no output given; use -o FILE.exr, -o FILE.png, or both"},
        {{"denoise", file("a.exr"), "-o", file("a.exr")}, FAKE, 2, "IMAGE"},
        {{"denoise", file("grey.exr"), "-o", file("b.png")},
         FAKE,
         1,
         "it has no channels R, G and B, so that there is nothing to denoise"},
        {{"denoise", file("none.exr"), "-o", file("b.png")}, FAKE, 1, "none.exr"},
        {{"denoise", file("a.exr"), "-o", file("b.png"), "--denoise", "oidn"}, MISSING, 2, IS_MISSING},
        {{"denoise", file("a.exr"), "-o", file("b.png"), "--denoise", "none"},
         FAKE,
         2,
         "--denoise: cannot use \"none\"; expected auto|oidn|variance"},
        {{"denoise", file("a.exr"), "-o", file("b.png")},
         FAKE + Variables{{"FAKE_OIDN_FAILS", "execute"}},
         1,
         "failed: out of luck in execute"},
        {{"denoise", file("a.exr"), "-o", file("b.png"), "--denoise", "oidn"},
         FAKE + Variables{{"FAKE_OIDN_VERSION", "3"}},
         1,
         "it is version 3.5.1, and candela needs version 2"}};
    for (const Case& c : cases) {
        const ProcessResult result = candela(c.words, c.environment);
        EXPECT_EQ(result.exit_code, c.exit_code) << c.message;
        EXPECT_CONTAINS(result.err, c.message);
        EXPECT_FALSE(std::filesystem::exists(file("b.png")));
    }
}

}  // namespace
}  // namespace candela
