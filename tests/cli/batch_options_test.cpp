// Options for a batch as a whole: one exposure for all its pictures, and a time for all of them.
#include <cmath>
#include <sstream>

#include "base/color.h"
#include "cli/cli_fixture.h"
#include "image/texel_io.h"

namespace candela {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class BatchOptions : public CliTest {
  protected:
    // A wall of that radiance fills the picture.
    std::string write_wall(const std::string& name, double radiance) const {
        return write(name, R"({
            "cameras": {"main": {"position": [0, 0, 1], "look_at": [0, 0, 0], "orthographic_height": 1}},
            "shapes": [{"type": "quad", "vertices": [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]],
                        "emission": )" +
                               std::to_string(radiance) + "}]}");
    }
    ProcessResult render_walls(const Words& scenes, const Words& arguments,
                               const std::map<std::string, std::string>& more = {},
                               const std::string& output = "out/{stem}.png") const {
        fs::create_directory(file("out"));
        return candela(
            Words{"render"} + scenes +
                Words{"--size", "8x8", "--spp", "1", "-o", file(output), "--report", file("report.jsonl")} +
                arguments,
            std::map<std::string, std::string>{{"CANDELA_VALIDATION", "0"}} + more);
    }
    // `key` of the report's lines; null where a line lacks it.
    std::vector<Json> reported(const char* key) const {
        std::vector<Json> values;
        std::istringstream stream(read_file(file("report.jsonl")));
        for (std::string line; std::getline(stream, line);)
            values.push_back(Json::parse(line).value(key, Json()));
        return values;
    }
    int code(const std::string& name) const {
        std::vector<std::string> warnings;
        const TexelImage picture = decode_texels(read_file(file(name)), name, warnings);
        return int(std::lround(255.0f * texel_codes(picture, 27).x));
    }
    bool exists(const std::string& name) const { return fs::exists(file(name)); }

    const std::string dim_ = write_wall("dim.json", 0.2), bright_ = write_wall("bright.json", 0.4),
                      dark_ = write_wall("dark.json", 0.025);
};

// 0.2 becomes 0.8 by two stops, 0.4 would be 1.6, and 0.025 is 0.1.
TEST_F(BatchOptions, AllPicturesHaveTheExposureOfTheFirst) {
    const Words walls{dim_, bright_, dark_}, first{"--exposure", "first"};
    const ProcessResult result = render_walls(walls, first);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_CONTAINS(result.err, file("out/dim.png") + ": exposure: 2.00 EV\n");
    EXPECT_EQ(result.err.find("bright.png: exposure"), std::string::npos);
    for (const Json& exposure : reported("exposure"))
        EXPECT_NEAR(double(exposure), 2.0, 1e-5);
    const auto code_of = [](float light) { return int(std::lround(255.0f * srgb_encode(light))); };
    EXPECT_EQ(code("out/dim.png"), code_of(0.8f));
    EXPECT_EQ(code("out/bright.png"), 255);
    EXPECT_EQ(code("out/dark.png"), code_of(0.1f));

    // A batch that goes on has the same exposure.
    const std::string dim = read_file(file("out/dim.png")), dark = read_file(file("out/dark.png"));
    fs::remove(file("out/dark.png"));
    const ProcessResult second = render_walls(walls, first + Words{"--skip-existing"});
    EXPECT_EQ(second.exit_code, 0) << second.err;
    EXPECT_CONTAINS(second.err, "1 done, 2 skipped, 0 failed\n");
    EXPECT_EQ(reported("state"), (std::vector<Json>{"skipped", "skipped", "done"}));
    EXPECT_EQ(read_file(file("out/dim.png")), dim);
    EXPECT_EQ(read_file(file("out/dark.png")), dark);
    // If nothing is missing, nothing is rendered.
    const ProcessResult third = render_walls(walls, first + Words{"--skip-existing"}, NO_DRIVER);
    EXPECT_EQ(third.exit_code, 0) << third.err;
    EXPECT_EQ(third.err, "0 done, 3 skipped, 0 failed\n");
}

// The views of a scene are known only when it is read.
TEST_F(BatchOptions, TheExposureOfTheFirstViewIsFoundAgain) {
    const Words views{"--turntable", "3", "--exposure", "first", "--skip-existing"};
    ASSERT_EQ(render_walls({dim_}, views, {}, "out/{view}.png").exit_code, 0);
    const std::string last = read_file(file("out/2.png"));
    const Json exposure = reported("exposure").back();
    fs::remove(file("out/2.png"));
    ASSERT_EQ(render_walls({dim_}, views, {}, "out/{view}.png").exit_code, 0);
    EXPECT_EQ(reported("state"), (std::vector<Json>{"skipped", "skipped", "done"}));
    EXPECT_EQ(read_file(file("out/2.png")), last);
    EXPECT_EQ(reported("exposure").back(), exposure);
}

TEST_F(BatchOptions, NoPictureIsDevelopedByTheExposureOfAnotherThanTheFirst) {
    const ProcessResult result =
        render_walls({write("bad.json", "{"), dim_, bright_}, {"--exposure", "first"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_CONTAINS(result.err,
                    "candela: error: --exposure first: the first picture failed, and no other is developed "
                    "without its exposure; mend it, or give auto or a number\n");
    EXPECT_CONTAINS(result.err, "0 done, 0 skipped, 1 failed\n");
    EXPECT_FALSE(exists("out/dim.png"));
}

// There is no time for any picture, and no device is needed; what is there is skipped nevertheless.
TEST_F(BatchOptions, WhatIsNotBegunInTimeIsLeftOut) {
    fs::create_directory(file("out"));
    write("out/bright.png", "old");
    const ProcessResult result =
        render_walls({dim_, bright_, dark_}, {"--batch-time", "1e-9", "--skip-existing"}, NO_DRIVER);
    EXPECT_EQ(result.exit_code, 7);
    EXPECT_EQ(result.err, "0 done, 1 skipped, 0 failed, 2 left out: the time (--batch-time) is over\n");
    EXPECT_EQ(reported("state"), (std::vector<Json>{"left out", "skipped", "left out"}));
    EXPECT_FALSE(exists("out/dim.png"));
    const ProcessResult rest =
        render_walls({dim_, bright_, dark_}, {"--batch-time", "1000h", "--skip-existing"});
    EXPECT_EQ(rest.exit_code, 0) << rest.err;
    EXPECT_CONTAINS(rest.err, "2 done, 1 skipped, 0 failed\n");
    EXPECT_EQ(read_file(file("out/bright.png")), "old");
}

// Rendering all samples would take hours.
TEST_F(BatchOptions, ThePictureThatIsNotWholeInTimeIsLeftOut) {
    const ProcessResult result = render_walls({dim_, bright_}, {"--batch-time", "1s", "--spp", "16777216"});
    EXPECT_EQ(result.exit_code, 7);
    EXPECT_CONTAINS(result.err, "0 done, 0 skipped, 0 failed, 2 left out: the time (--batch-time) is over\n");
    EXPECT_EQ(reported("state"), (std::vector<Json>{"left out", "left out"}));
    EXPECT_TRUE(fs::is_empty(file("out")));
}

}  // namespace
}  // namespace candela
