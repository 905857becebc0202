// Frames of animations: each has the bits that it has alone.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <sstream>

#include "cli/cli_fixture.h"
#include "unit/load/gltf/moving_file.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

class Frames : public CliTest {
  protected:
    Frames() { write("m.glb", moving_file().glb()); }

    // Runs candela without validation, which takes most of the time of a tiny picture.
    ProcessResult rendered(const Words& arguments) const {
        return candela(Words{"render", scene_, "--size", "16x16", "--spp", "1"} + arguments,
                       {{"CANDELA_VALIDATION", "0"}});
    }
    std::vector<Json> lines() const {
        std::vector<Json> lines;
        std::istringstream stream(read_file(file("r.jsonl")));
        for (std::string line; std::getline(stream, line);)
            lines.push_back(Json::parse(line));
        return lines;
    }
    bool exists(const std::string& name) const { return fs::exists(file(name)); }

    const std::string scene_ = file("m.glb");
};

// From different beginnings, so that what was shown before differs, too.
TEST_F(Frames, HaveTheSameBitsAloneAndInARange) {
    const Words style{"--fps", "4", "--studio", "sunset", "--turntable", "2", "--seed-per-frame"};
    const ProcessResult range = rendered(
        style + Words{"--frames", "all", "-o", file("{frame:02}-{view}.exr"), "--report", file("r.jsonl")});
    EXPECT_EQ(range.exit_code, 0) << range.err;
    EXPECT_CONTAINS(range.err, "10 done, 0 skipped, 0 failed\n");
    const std::vector<Json> all = lines();
    ASSERT_EQ(all.size(), 10u);
    for (const int frame : {2, 3}) {
        EXPECT_EQ(all[size_t(frame) * 2]["frame"], frame);
        EXPECT_EQ(all[size_t(frame) * 2]["seed"], frame);
        const ProcessResult alone = rendered(style + Words{"--frames", std::to_string(frame), "--cameras",
                                                           "all", "-o", file("alone-{view}.exr")});
        EXPECT_EQ(alone.exit_code, 0) << alone.err;
        for (const std::string view : {"-0.exr", "-1.exr"}) {
            const Image a = read_exr(file("0" + std::to_string(frame) + view)),
                        b = read_exr(file("alone" + view));
            EXPECT_EQ(a.attributes.at("candela.identity"), b.attributes.at("candela.identity"));
            for (const Channel& channel : a.channels)
                EXPECT_EQ(channel.values, b.find(channel.name)->values) << channel.name;
        }
    }
}

// The picture of a frame is that of its time, but for the rounding of other internal coordinates: what the
// rays through the pixels' centres hit is as far away. They decide otherwise only along edges.
TEST_F(Frames, ShowTheirTime) {
    const Words style{"--aov", "z", "--size", "32x32"};
    EXPECT_EQ(rendered(style + Words{"--frames", "1,3", "--fps", "4", "-o", file("{frame}.exr")}).exit_code,
              0);
    for (const auto& [frame, time] : {std::pair("1.exr", "0.25"), std::pair("3.exr", "0.75")}) {
        EXPECT_EQ(rendered(style + Words{"--time", time, "-o", file("t.exr")}).exit_code, 0);
        const Image a = read_exr(file(frame)), b = read_exr(file("t.exr"));
        const std::vector<float>&za = a.find("Z")->values, &zb = b.find("Z")->values;
        size_t hits = 0, others = 0;
        for (size_t i = 0; i < za.size(); ++i) {
            hits += std::isfinite(zb[i]);
            others += za[i] != zb[i] && !(std::abs(za[i] - zb[i]) < 1e-4f);
        }
        EXPECT_GT(hits, 100u);
        EXPECT_LE(others, 5u);
    }
}

TEST_F(Frames, ThatAreThereAreSkipped) {
    write("0001.png", "old");
    const ProcessResult result = rendered({"--frames", "0..2", "--fps", "2", "--skip-existing", "-o",
                                           file("{frame:04}.png"), "--report", file("r.jsonl")});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_CONTAINS(result.err, "2 done, 1 skipped, 0 failed\n");
    EXPECT_EQ(lines()[1]["state"], "skipped");
    EXPECT_EQ(lines()[1]["frame"], 1);
    EXPECT_TRUE(exists("0000.png") && exists("0002.png"));
    EXPECT_EQ(read_file(file("0001.png")), "old");
}

TEST_F(Frames, OfOneSceneDoNotEndThoseOfAnother) {
    write("still.glb", corner_file().glb());
    const ProcessResult result =
        rendered({file("still.glb"), "--frames", "0..1", "-o", file("{stem}-{frame}.png")});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_CONTAINS(result.err,
                    "candela: error: " + file("still.glb") +
                        ": the file has no animations, so that all frames would be the same; leave "
                        "--frames out\n");
    EXPECT_CONTAINS(result.err, "2 done, 0 skipped, 2 failed\n");
}

TEST_F(Frames, InterruptedLeaveWholePicturesOnly) {
    Process process(call({"render", scene_, "--size", "16x16", "--spp", "16777216", "--frames", "0..3",
                          "--progress", "json", "-o", file("{frame}.png")}),
                    options({{"CANDELA_VALIDATION", "0"}}));
    ASSERT_TRUE(process.wait_for_err("\"picture\":\"" + file("0.png") + '"'));
    process.send(SIGINT);
    EXPECT_EQ(process.finish().exit_code, 130);
    EXPECT_FALSE(exists("0.png") || exists("1.png"));
}

TEST_F(Frames, AreRefusedBeforeAnythingIsRead) {
    const auto refused = [&](const Words& arguments, const std::string& message) {
        const ProcessResult result = candela(Words{"render", scene_} + arguments, NO_DRIVER);
        EXPECT_EQ(result.exit_code, 2) << message;
        EXPECT_CONTAINS(result.err, "candela: error: " + message);
    };
    const std::string name = file("{frame}.png");
    for (const std::string bad :
         {"5..1", "1..9:0", "1:2", "0..1000000", "0..100000", "-1", "1,,2", "1,0..2", "x", "1.5", ""}) {
        refused({"--frames", bad, "-o", name},
                "--frames: cannot use \"" + bad +
                    "\"; expected all, or whole numbers from 0 to 999999 such as 7, 1..120, 1..120:2 or "
                    "1,5,9..12, "
                    "each once, with A <= B in A..B:STEP and a step of at least 1; at most 100000 frames\n");
    }
    for (const std::string bad : {"0", "-24", "nan", "inf", "1e9"}) {
        refused({"--frames", "1", "--fps", bad, "-o", name},
                "--fps: cannot use \"" + bad +
                    "\"; expected a number of frames per second from 0.001 to 100000, such as 24\n");
    }
    refused({"--frames", "0..1", "-o", file("x.png")},
            "-o: \"" + file("x.png") + "\" would be the picture of each frame; add the field {frame}\n");
    refused({file("x/m.glb"), "--frames", "1", "-o", name},
            "-o: \"" + file("1.png") + "\" would be two pictures, of \"" + scene_ +
                "\" in frame 1 and of \"" + file("x/m.glb") + "\" in frame 1; tell them apart ");
    refused({"--frames", "1", "--time", "1", "-o", name}, "--time excludes --frames");
    refused({"--fps", "1", "-o", name}, "--fps requires --frames");
    refused({"--animation", "all", "-o", name},
            "--animation: it is not shown without a time; also give --time or --frames\n");
    refused({"--frames", "all", "-o", name, "--write-cameras", file("c.json")},
            "--write-cameras: \"" + file("c.json") +
                "\" would hold the cameras of each frame; add the field {frame}\n");
    refused({"--frames", "all", "--fps", "100000", "-o", name},
            scene_ +
                ": --frames all: the animation lasts from 0 s to 1 s, which is more than 100000 frames or "
                "beyond frame 999999; name frames, or give fewer frames per second (--fps)\n");
    write("box.json", read_file(CORNELL_BOX));
    const ProcessResult native =
        candela({"render", file("box.json"), "--frames", "1", "-o", name}, NO_DRIVER);
    EXPECT_CONTAINS(native.err,
                    ": --scene, --animation, --time, --frames, --variant and --light-units are for glTF ");
}

}  // namespace
}  // namespace candela
