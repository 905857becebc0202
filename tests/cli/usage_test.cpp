// Help, version, and everything that can be wrong with a command line before a device is needed.
#include <array>
#include <filesystem>
#include <utility>

#include "cli/cli_fixture.h"

namespace candela {
namespace {

class Usage : public CliTest {};

TEST_F(Usage, VersionAndHelpGoToStdout) {
    const ProcessResult version = candela({"--version"});
    EXPECT_EQ(version.exit_code, 0);
    EXPECT_TRUE(version.out.starts_with("candela 0.1.0\nbuilt with ")) << version.out;
    EXPECT_CONTAINS(version.out, ", OpenEXR 3.");

    const ProcessResult help = candela({"--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_EQ(help.err, "");
    for (const char* command : {"render", "view", "info", "devices", "compare", "merge", "denoise", "plot",
                                "selftest", "bench", "Exit codes"}) {
        EXPECT_CONTAINS(help.out, command);
    }
}

TEST_F(Usage, HelpOfRenderListsEveryOption) {
    const ProcessResult help = candela({"render", "--help"});
    EXPECT_EQ(help.exit_code, 0);
    for (const char* option : {"--output",        "--aov",         "--half",           "--exposure",
                               "--tonemap",       "--report",      "--size",           "--crop",
                               "--camera",        "--spp",         "--time-limit",     "--seed",
                               "--max-depth",     "--rr-depth",    "--estimator",      "--sampler",
                               "--light-sampler", "--device",      "--scene-buffers",  "--quiet",
                               "--verbose",       "--samples",     "--checkpoint",     "--checkpoint-every",
                               "--resume",        "--write-every", "--target-error",   "--progress",
                               "--reference",     "--cameras",     "--skip-existing",  "--stop-on-error",
                               "--view",          "--turntable",   "--dome",           "--lens",
                               "--margin",        "--camera-file", "--write-cameras",  "--batch-time",
                               "--labels",        "--labels-of",   "--depth-png",      "--depth-unit",
                               "--manifest",      "--denoise",     "--denoise-quality"}) {
        EXPECT_CONTAINS(help.out, option);
    }
}

TEST_F(Usage, UnknownWordsAreNamed) {
    const std::vector<std::pair<Words, const char*>> cases = {
        {{},
         "no command given; use render, fidelity, view, info, devices, compare, merge, denoise, plot, "
         "selftest, bench, serve, completion or manual"},
        {{"trace"}, "unknown command \"trace\""},
        {{"--trace"}, "unknown argument \"--trace\""},
        {{"render", CORNELL_BOX, "-o", "x.png", "--trace"},
         "unknown argument \"--trace\"; see candela render --help"},
        {{"info", CORNELL_BOX, "more"}, "unknown argument \"more\""},
        {{"render", "-o", "x.png"}, "SCENE is required"},
        {{"render", CORNELL_BOX, "-o", "x.png", "--spp"}, "--spp"},
        {{"render", CORNELL_BOX, "-o", "x.png", "--quiet", "--verbose"}, "--quiet"},
        {{"compare", "a.exr"}, "B is required"},
    };
    for (const auto& [arguments, message] : cases) {
        const ProcessResult result = candela(arguments);
        EXPECT_EQ(result.exit_code, 2) << message;
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(result.err.rfind("candela: error: ", 0), 0u) << result.err;
        EXPECT_CONTAINS(result.err, message);
    }
}

// One run per bad value: the message names flag, value and what is expected.
TEST_F(Usage, BadValuesAreNamedWithWhatIsExpected) {
    const std::string size = "WIDTHxHEIGHT in pixels, each from 1 to 65536";
    const std::string crop = "x0,y0,x1,y1 in pixels from the top left, with x0 < x1 and y0 < y1";
    const std::string spp = "a whole number from 1 to 16777216";
    const std::string duration = "a duration such as 90, 90s, 1.5m or 2h";
    const std::string aovs =
        "all, none or a list of albedo,n,p,z,variance,samples,depth,ids,cryptomatte,denoising,motion";
    const std::string view =
        "AZIMUTH,ELEVATION or AZIMUTH,ELEVATION,ROLL in degrees, such as 30,20, with an elevation from -90 "
        "to 90";
    const std::string turntable =
        "N or N,ELEVATION: a whole number from 1 to 65536, and degrees from -90 to 90";
    const std::string lens =
        "a vertical field of view from 0.1deg to 179deg, or a focal length from 1mm to 10000mm";
    const std::string tonemaps = "linear|reinhard|aces|agx|neutral";
    const std::vector<std::array<std::string, 3>> cases = {
        {"--size", "64", size},
        {"--size", "0x64", size},
        {"--size", "64x-1", size},
        {"--size", "64x65537", size},
        {"--size", "64x64x64", size},
        {"--crop", "0,0,8", crop},
        {"--crop", "8,0,8,8", crop},
        {"--crop", "0,9,8,8", crop},
        {"--crop", "-1,0,8,8", crop},
        {"--spp", "0", spp},
        {"--spp", "-5", spp},
        {"--spp", "1.5", spp},
        {"--spp", "16777217", spp},
        {"--spp", "", spp},
        {"--seed", "4294967296", "a whole number from 0 to 4294967295"},
        {"--max-depth", "4097", "a whole number from 0 to 4096, or unlimited"},
        {"--rr-depth", "unlimited", "a whole number from 0 to 4096"},
        {"--time-limit", "0", duration},
        {"--time-limit", "1d", duration},
        {"--time-limit", "nan", duration},
        {"--time-limit", "s", duration},
        {"--batch-time", "0", duration},
        {"--exposure", "1e3", "auto, first or a number from -100 to 100"},
        {"--exposure", "inf", "auto, first or a number from -100 to 100"},
        {"--tonemap", "filmic", tonemaps},
        {"--tonemap", "", tonemaps},
        {"--estimator", "nee", "bsdf|light|mis"},
        {"--sampler", "halton", "independent|stratified|sobol"},
        {"--light-sampler", "bvh", "auto|uniform|power|tree"},
        {"--scene-buffers", "image", "auto|texel|storage"},
        {"--aov", "albedo,colour", aovs},
        {"--aov", "", aovs},
        {"--aov", "all,n", aovs},
        {"--view", "30", view},
        {"--view", "30,91", view},
        {"--view", "30,20,x", view},
        {"--view", "1,2,3,4", view},
        {"--turntable", "0", turntable},
        {"--turntable", "8,-91", turntable},
        {"--turntable", "8,1,1", turntable},
        {"--dome", "65537", "a whole number from 1 to 65536"},
        {"--lens", "0mm", lens},
        {"--lens", "180", lens},
        {"--lens", "35cm", lens},
        {"--margin", "0.5", "a number from 0 to 0.45"},
    };
    for (const auto& [flag, value, expected] : cases) {
        const ProcessResult result = candela({"render", CORNELL_BOX, "-o", file("x.png"), flag, value});
        EXPECT_EQ(result.exit_code, 2) << flag << ' ' << value;
        EXPECT_EQ(result.err,
                  "candela: error: " + flag + ": cannot use \"" + value + "\"; expected " + expected + "\n");
    }
}

TEST_F(Usage, OutputsAreCheckedBeforeTheSceneIsRead) {
    const std::string scene = file("missing.json");
    const auto error = [&](const Words& arguments, int exit_code) {
        const ProcessResult result = candela(Words{"render", scene} + arguments);
        EXPECT_EQ(result.exit_code, exit_code);
        return result.err;
    };
    EXPECT_CONTAINS(error({}, 2), "no output given; use -o FILE.exr, -o FILE.png, or both");
    EXPECT_CONTAINS(error({"-o", "a.gif"}, 2), "image file \"a.gif\" has the unknown extension \".gif\"");
    EXPECT_CONTAINS(error({"-o", file("a.png"), "-o", "b"}, 2), "image file \"b\" has no extension");
    EXPECT_CONTAINS(error({"-o", file("none/a.png")}, 1), "none\" does not exist; create it first");
    std::filesystem::create_directory(file("folder.exr"));
    EXPECT_CONTAINS(error({"-o", file("folder.exr")}, 1), "it is a directory");
    EXPECT_CONTAINS(error({"-o", file("a.png"), "--report", file("none/r.json")}, 1),
                    "none\" does not exist");
    EXPECT_CONTAINS(error({"-o", file("a.png")}, 1),
                    "cannot read \"" + scene + "\": the file does not exist");
    EXPECT_FALSE(std::filesystem::exists(file("a.png")));
}

TEST_F(Usage, CameraAndCropMustFitTheScene) {
    const ProcessResult camera = candela({"render", MESH, "-o", file("a.png"), "--camera", "far"}, NO_DRIVER);
    EXPECT_EQ(camera.exit_code, 2);
    EXPECT_CONTAINS(camera.err, "--camera: unknown camera \"far\" (defined: main, close)");

    for (const std::string crop : {"0,0,33,32", "0,0,32,33"}) {
        const ProcessResult result = render({"-o", file("a.png"), "--crop", crop});
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_CONTAINS(result.err, "--crop: " + crop + " reaches beyond the picture of 32x32 pixels");
    }
}

TEST_F(Usage, ErrorsInScenesAreFailures) {
    const ProcessResult result =
        candela({"render", write("bad.json", "{ \"shapes\": "), "-o", file("a.png")});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_CONTAINS(result.err, "bad.json:1:");
}

}  // namespace
}  // namespace candela
