// Every option of `candela render` does what it says.
#include <algorithm>
#include <bit>
#include <set>

#include "cli/cli_fixture.h"

namespace candela {
namespace {

class RenderOptionsTest : public CliTest {};

TEST_F(RenderOptionsTest, SizeAndSamplesAreAsAskedFor) {
    ASSERT_EQ(
        candela({"render", CORNELL_BOX, "-o", file("a.exr"), "--size", "40x24", "--spp", "3"}).exit_code, 0);
    const Image image = read_exr(file("a.exr"));
    EXPECT_EQ(image.full, uvec2(40, 24));
    EXPECT_EQ(image.data, (PixelRect{0, 0, 40, 24}));
    for (const float count : image.find("SampleCount.V")->values)
        ASSERT_EQ(count, 3.0f);
}

TEST_F(RenderOptionsTest, CropHasTheSameBitsAsTheWhole) {
    ASSERT_EQ(render({"-o", file("whole.exr")}).exit_code, 0);
    ASSERT_EQ(render({"-o", file("crop.exr"), "--crop", "5,9,18,30"}).exit_code, 0);
    const Image whole = read_exr(file("whole.exr"));
    const Image crop = read_exr(file("crop.exr"));
    EXPECT_EQ(crop.full, uvec2(32, 32));
    ASSERT_EQ(crop.data, (PixelRect{5, 9, 18, 30}));
    ASSERT_EQ(crop.channels.size(), whole.channels.size());
    for (const Channel& channel : crop.channels) {
        const Channel* const expected = whole.find(channel.name);
        ASSERT_NE(expected, nullptr);
        for (size_t i = 0; i < crop.pixel_count(); ++i) {
            const size_t x = 5 + i % 13;
            const size_t y = 9 + i / 13;
            ASSERT_EQ(std::bit_cast<uint32_t>(channel.values[i]),
                      std::bit_cast<uint32_t>(expected->values[y * 32 + x]))
                << channel.name << " at " << x << ", " << y;
        }
    }
}

TEST_F(RenderOptionsTest, FiltersAndLimitsThatCannotBeAreRefused) {
    const auto error = [&](const std::string& option, const std::string& text, const std::string& expected) {
        const ProcessResult result =
            candela({"render", CORNELL_BOX, "-o", file("a.exr"), option, text}, NO_DRIVER);
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_CONTAINS(result.err, option + ": cannot use \"" + text + "\"; expected " + expected);
    };
    for (const char* filter :
         {"box,0", "gaussian,100", "tent,-1", "tent,nan", "tent,", "sinc", "box,1,1", ""}) {
        error("--filter", filter,
              "box, tent, gaussian or blackman-harris, also with a comma and a width from 0.01 to 10 pixels");
    }
    for (const char* limit : {"-1", "0", "nan", "inf", "1e39", "1e-40", "L"})
        error("--clamp-indirect", limit, "a number above 0, such as 10");
}

// Parts belong together only if their filter and their limit are the same.
TEST_F(RenderOptionsTest, FilterAndLimitAreInTheFile) {
    const auto render_part = [&](const char* name, const char* samples, const Words& arguments) {
        const ProcessResult part =
            candela(Words{"render", CORNELL_BOX, "--size", "8x8", "-o", file(name), "--samples", samples} +
                    arguments);
        ASSERT_EQ(part.exit_code, 0) << part.err;
    };
    const Words filtered{"--filter", "gaussian", "--clamp-indirect", "10"};
    render_part("a.exr", "0..2", filtered);
    render_part("b.exr", "2..4", filtered);
    render_part("c.exr", "2..4", {});
    const Image image = read_exr(file("a.exr"));
    EXPECT_EQ(std::get<std::string>(image.attributes.at("candela.filter")), "gaussian,3");
    EXPECT_EQ(std::get<std::string>(image.attributes.at("candela.clampIndirect")), "10");
    EXPECT_EQ(candela({"merge", file("a.exr"), file("b.exr"), "-o", file("whole.exr")}).exit_code, 0);
    const ProcessResult refused = candela({"merge", file("a.exr"), file("c.exr"), "-o", file("d.exr")});
    EXPECT_NE(refused.exit_code, 0);
    EXPECT_CONTAINS(refused.err,
                    "its filter is box,1, not gaussian,3, its clamp of indirect light is none, not 10");
    const auto report = report_of({"--size", "8x8", "--filter", "gaussian", "--clamp-indirect", "10"});
    EXPECT_EQ(report["filter"], "gaussian");
    EXPECT_EQ(report["filter_width"], 3.0);
    EXPECT_EQ(report["clamp_indirect"], 10.0);
    EXPECT_EQ(report_of({"--size", "8x8"})["clamp_indirect"], nullptr);
}

TEST_F(RenderOptionsTest, SamplingOptionsChangeTheImage) {
    const std::string plain = hash_of({});
    EXPECT_EQ(plain, hash_of({"--filter", "box,1", "--clamp-indirect", "1e30"}));
    EXPECT_EQ(plain, hash_of({"--seed", "0", "--estimator", "mis", "--sampler", "sobol", "--rr-depth", "3"}));
    std::set<std::string> hashes = {plain};
    for (const Words& change : std::vector<Words>{{"--seed", "1"},
                                                  {"--estimator", "bsdf"},
                                                  {"--estimator", "light"},
                                                  {"--sampler", "independent"},
                                                  {"--sampler", "stratified"},
                                                  {"--rr-depth", "0"},
                                                  {"--max-depth", "1"},
                                                  {"--filter", "tent"},
                                                  {"--clamp-indirect", "0.1"},
                                                  {"--spp", "5"}}) {
        EXPECT_TRUE(hashes.insert(hash_of(change)).second)
            << change[0] << ' ' << change[1] << " changed nothing";
    }
}

TEST_F(RenderOptionsTest, DepthZeroShowsLightsOnly) {
    ASSERT_EQ(render({"-o", file("a.exr"), "--max-depth", "0"}).exit_code, 0);
    const Image image = read_exr(file("a.exr"));
    const RgbPlanes rgb = *image.find_rgb();
    float brightest = 0.0f;
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        brightest = std::max(brightest, rgb[0][i]);
        EXPECT_FLOAT_EQ(rgb[0][i] * 4.0f,
                        rgb[2][i] * 17.0f);  // The light emits 17 12 4, and all else is black.
    }
    EXPECT_EQ(brightest, 17.0f);
}

TEST_F(RenderOptionsTest, TheLastOfAnOptionCounts) {
    EXPECT_EQ(hash_of({"--seed", "1", "--seed", "2"}), hash_of({"--seed", "2"}));
}

TEST_F(RenderOptionsTest, UnlimitedDepthIsTheSafetyLimit) {
    EXPECT_EQ(hash_of({"--max-depth", "unlimited"}), hash_of({"--max-depth", "4096"}));
}

TEST_F(RenderOptionsTest, CameraIsChosenByName) {
    const std::string first = hash_of({}, MESH);
    EXPECT_EQ(first, hash_of({"--camera", "main"}, MESH));
    EXPECT_NE(first, hash_of({"--camera", "close"}, MESH));
}

// The estimator bsdf leaves them out, and says so.
TEST_F(RenderOptionsTest, LightsWithoutASurfaceNeedLightSamples) {
    const std::string scene = CANDELA_SCENES "/../tests/references/punctual-lights.json";
    const auto warnings = [&](const std::string& estimator, const std::string& of) {
        const ProcessResult result = candela({"render", of, "-o", file("a.png"), "--size", "8x8", "--spp",
                                              "1", "-q", "--estimator", estimator});
        EXPECT_EQ(result.exit_code, 0);
        return result.err;
    };
    EXPECT_EQ(
        warnings("bsdf", scene),
        "candela: warning: the estimator bsdf cannot find the point, spot and directional lights of this "
        "scene, which have no surface; use mis or light\n");
    EXPECT_EQ(warnings("mis", scene), "");
    EXPECT_EQ(warnings("light", scene), "");
    EXPECT_EQ(warnings("bsdf", CORNELL_BOX), "");
    EXPECT_EQ(report_of({"--size", "8x8", "--spp", "1", "-o", file("a.png")}, scene)["lights"], 4);
}

TEST_F(RenderOptionsTest, SceneBuffersChangeNoBit) {
    const nlohmann::json texel = report_of({"--size", "32x32", "--spp", "4", "--scene-buffers", "texel"});
    const nlohmann::json storage = report_of({"--size", "32x32", "--spp", "4", "--scene-buffers", "storage"});
    EXPECT_EQ(texel["scene_buffers"], "texel");
    EXPECT_EQ(storage["scene_buffers"], "storage");
    EXPECT_EQ(texel["image_hash"], storage["image_hash"]);
}

TEST_F(RenderOptionsTest, ToneMapAndExposureChangeThePngOnly) {
    std::set<std::string> pictures;
    std::set<std::string> hashes;
    for (const Words& change : std::vector<Words>{{"--tonemap", "linear"},
                                                  {"--tonemap", "reinhard"},
                                                  {"--tonemap", "aces"},
                                                  {"--tonemap", "agx"},
                                                  {"--tonemap", "neutral"},
                                                  {"--exposure", "-1.5"},
                                                  {"--exposure", "2"}}) {
        hashes.insert(hash_of(change));
        EXPECT_TRUE(pictures.insert(read_file(file("report.png"))).second) << change[1] << " changed nothing";
    }
    EXPECT_EQ(hashes.size(), 1u);
    hash_of({});
    EXPECT_EQ(pictures.count(read_file(file("report.png"))), 1u) << "linear is not the default";
}

TEST_F(RenderOptionsTest, AovListNamesTheChannels) {
    const auto channels = [this](const Words& arguments) {
        EXPECT_EQ(render(Words{"-o", file("a.exr"), "--crop", "0,0,8,8"} + arguments).exit_code, 0);
        std::string names;
        for (const Channel& channel : read_exr(file("a.exr")).channels)
            names += channel.name + ' ';
        return names;
    };
    EXPECT_EQ(channels({}),
              "A Albedo.B Albedo.G Albedo.R B G N.X N.Y N.Z P.X P.Y P.Z R SampleCount.V "
              "Variance.B Variance.G Variance.R Z ");
    EXPECT_EQ(channels({"--aov", "none"}), "A B G R ");
    EXPECT_EQ(channels({"--aov", "albedo,z"}), "A Albedo.B Albedo.G Albedo.R B G R Z ");
    EXPECT_EQ(channels({"--aov", "samples,p"}), "A B G P.X P.Y P.Z R SampleCount.V ");
    EXPECT_EQ(channels({"--aov", "n,variance"}), "A B G N.X N.Y N.Z R Variance.B Variance.G Variance.R ");
}

TEST_F(RenderOptionsTest, HalfIsForColourAndAlbedoOnly) {
    ASSERT_EQ(render({"-o", file("a.exr"), "--half"}).exit_code, 0);
    const std::set<std::string> colours = {"R", "G", "B", "A", "Albedo.R", "Albedo.G", "Albedo.B"};
    for (const Channel& channel : read_exr(file("a.exr")).channels) {
        EXPECT_EQ(channel.half, colours.count(channel.name) == 1) << channel.name;
    }
}

TEST_F(RenderOptionsTest, WhatHalfCannotHoldStaysFloat) {
    const std::string scene = write("bright.json", R"({
        "cameras": { "main": { "position": [0, 0, 1], "look_at": [0, 0, 0], "vertical_fov": 40 } },
        "shapes": [ { "type": "quad", "vertices": [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]],
                      "emission": [1, 2, 70000] } ] })");
    const ProcessResult result =
        candela({"render", scene, "-o", file("a.exr"), "--size", "8x8", "--spp", "1", "--half"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_CONTAINS(result.err, "candela: warning: channel B holds values beyond 65504");
    const Image image = read_exr(file("a.exr"));
    EXPECT_TRUE(image.find("R")->half);
    EXPECT_FALSE(image.find("B")->half);
    EXPECT_EQ(image.find("B")->values[0], 70000.0f);
}

TEST_F(RenderOptionsTest, TimeLimitEndsARenderingThatWouldNotEnd) {
    const ProcessResult result = render(
        {"-o", file("a.exr"), "--spp", "16777216", "--time-limit", "0.01m", "--report", file("report.json")});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_CONTAINS(result.err, " of 16777216 spp in ");
    const Image image = read_exr(file("a.exr"));
    for (const float count : image.find("SampleCount.V")->values)
        ASSERT_GE(count, 1.0f);
    const auto report = nlohmann::json::parse(read_file(file("report.json")));
    EXPECT_EQ(report["complete"], false);
    EXPECT_GE(report["render_seconds"], 0.6);
    EXPECT_EQ(float(report["spp"]), std::ranges::min(image.find("SampleCount.V")->values));
}

TEST_F(RenderOptionsTest, QuietIsQuietAndVerboseTellsMore) {
    EXPECT_EQ(render({"-o", file("a.png"), "--quiet"}).err, "");
    const std::string normal = render({"-o", file("a.png")}).err;
    EXPECT_EQ(normal.rfind("rendered 4 spp in ", 0), 0u) << normal;
    const std::string verbose = render({"-o", file("a.png"), "--verbose"}).err;
    for (const char* word :
         {"device: ", "driver ", "scene: 32 primitives, 1 lights", "BVH: depth ", "device memory: "}) {
        EXPECT_CONTAINS(verbose, word);
    }
}

}  // namespace
}  // namespace candela
