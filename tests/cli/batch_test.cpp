// Many pictures by one call: each is what a call of its own would make, and an error ends no other.
#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <sstream>

#include "cli/cli_fixture.h"

namespace candela {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class Batch : public CliTest {
  protected:
    Batch() {
        fs::copy_file(CORNELL_BOX, a_);
        fs::copy_file(CORNELL_BOX, b_);
        fs::create_directory(file("out"));
    }

    Words render_all(const Words& scenes, const std::string& output = "out/{stem}.png") const {
        return Words{"render"} + scenes + Words{"--size", "8x8", "--spp", "1", "-o", file(output)};
    }
    // Runs candela without validation, which takes most of the time of a tiny picture.
    static ProcessResult quickly(const Words& arguments) {
        return candela(arguments, {{"CANDELA_VALIDATION", "0"}});
    }
    // The report's lines.
    static std::vector<Json> lines_of(const std::string& text) {
        std::vector<Json> lines;
        std::istringstream stream(text);
        for (std::string line; std::getline(stream, line);)
            lines.push_back(Json::parse(line));
        return lines;
    }
    std::vector<Json> lines() const { return lines_of(read_file(file("report.jsonl"))); }
    static Words states_of(const std::vector<Json>& lines) {
        Words states;
        for (const Json& line : lines)
            states.push_back(line["state"]);
        return states;
    }
    bool exists(const std::string& name) const { return fs::exists(file(name)); }

    const std::string a_ = file("a.json"), b_ = file("b.json"), report_ = file("report.jsonl");
    // A square that two cameras see, one of which has a name that leads elsewhere.
    const std::string square_ = write("square.json", R"({
        "cameras": {"front": {"position": [0, 0, 3], "look_at": [0, 0, 0], "vertical_fov": 40},
                    "../side": {"position": [2, 0, 3], "look_at": [0, 0, 0], "vertical_fov": 30}},
        "lights": [{"type": "point", "position": [0, 1, 2], "intensity": [1, 1, 1]}],
        "shapes": [{"type": "quad", "vertices": [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]],
                    "emission": [1, 2, 3]}]})");
    const std::string bad_ = write("bad.json", "{");
};

TEST_F(Batch, HasTheBitsOfSinglePictures) {
    write("list.txt", "# two boxes\n\n " + a_ + "\n" + b_ + "\n");
    const ProcessResult result =
        quickly(render_all({square_, '@' + file("list.txt")}, "out/{stem}/{view:02}-{camera}.exr") +
                Words{"--cameras", "all", "--report", "-"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_CONTAINS(result.err, "4 done, 0 skipped, 0 failed\n");
    EXPECT_CONTAINS(result.err, "out/b/00-main.exr: rendered 1 spp in ");
    const std::vector<Json> lines = lines_of(result.out);
    ASSERT_EQ(lines.size(), 4u);
    const std::vector<std::array<std::string, 3>> expected = {
        {square_, "front", "out/square/00-front.exr"},
        {square_, "../side", "out/square/01-_._side.exr"},
        {a_, "main", "out/a/00-main.exr"},
        {b_, "main", "out/b/00-main.exr"}};
    for (size_t i = 0; i < lines.size(); ++i) {
        const auto& [scene, camera, output] = expected[i];
        EXPECT_EQ(lines[i]["state"], "done");
        EXPECT_EQ(lines[i]["scene"], scene);
        EXPECT_EQ(lines[i]["camera"], camera);
        EXPECT_EQ(lines[i]["view"], i == 1 ? 1 : 0);
        EXPECT_EQ(lines[i]["outputs"], Words{file(output)});
        // The second camera, and the scene that is like another, have kernels already.
        EXPECT_EQ(lines[i]["kernels_compiled"], i % 2 == 0 ? 2 : 0);
        EXPECT_EQ(lines[i]["pipeline_seconds"] > 0.0, i % 2 == 0);
        if (scene == b_) {
            EXPECT_EQ(lines[i]["image_hash"], lines[i - 1]["image_hash"]);
            continue;
        }
        const ProcessResult alone =
            quickly({"render", scene, "--size", "8x8", "--spp", "1", "--camera", camera, "-o",
                     file("alone.exr"), "--report", file("alone.json")});
        EXPECT_EQ(alone.exit_code, 0) << alone.err;
        const Json report = Json::parse(read_file(file("alone.json")));
        EXPECT_EQ(lines[i]["image_hash"], report["image_hash"]);
        EXPECT_EQ(lines[i]["primitives"], report["primitives"]);
        const Image image = read_exr(file(output)), single = read_exr(file("alone.exr"));
        EXPECT_EQ(image.attributes.at("candela.identity"), single.attributes.at("candela.identity"));
        for (const Channel& channel : image.channels)
            EXPECT_EQ(channel.values, single.find(channel.name)->values) << channel.name;
    }
}

TEST_F(Batch, ScenesThatDifferInOneNumberHaveDifferentIdentities) {
    std::string other = read_file(square_);
    other.replace(other.find("[1, 2, 3]"), 9, "[1, 2, 4]");
    write("a.json", other);
    ASSERT_EQ(quickly(render_all({square_, a_}, "out/{stem}.exr")).exit_code, 0);
    EXPECT_NE(read_exr(file("out/square.exr")).attributes.at("candela.identity"),
              read_exr(file("out/a.exr")).attributes.at("candela.identity"));
}

TEST_F(Batch, GoesOnAfterAnError) {
    const Words scenes{a_, bad_, file("none.json"), square_};
    const ProcessResult result =
        quickly(render_all(scenes) + Words{"--estimator", "bsdf", "--report", report_});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_CONTAINS(result.err, "candela: error: " + bad_ + ":1:");
    EXPECT_CONTAINS(result.err, "candela: error: cannot read \"" + file("none.json") + "\": ");
    EXPECT_CONTAINS(result.err, "candela: warning: \"" + square_ + "\": the estimator bsdf cannot find ");
    EXPECT_CONTAINS(result.err, "2 done, 0 skipped, 2 failed\n");
    EXPECT_EQ(states_of(lines()), (Words{"done", "failed", "failed", "done"}));
    EXPECT_EQ(lines()[2]["error"],
              "cannot read \"" + file("none.json") + "\": the file does not exist; check the name");
    EXPECT_TRUE(exists("out/a.png"));
    EXPECT_TRUE(exists("out/square.png"));

    const ProcessResult stopped = quickly(render_all({bad_, b_}) + Words{"--stop-on-error"});
    EXPECT_EQ(stopped.exit_code, 1);
    EXPECT_CONTAINS(stopped.err, "0 done, 0 skipped, 1 failed\n");
    EXPECT_FALSE(exists("out/b.png"));
}

TEST_F(Batch, OfErrorsWithOneCodeHasThisCode) {
    // A camera that only one of the scenes has.
    const ProcessResult result = quickly(render_all({square_, a_}, "out/{stem}-{camera}.png") +
                                         Words{"--camera", "main", "--camera", "front"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_CONTAINS(result.err, "candela: error: \"" + square_ + "\": --camera: unknown camera \"main\" ");
    EXPECT_CONTAINS(result.err, "2 done, 0 skipped, 2 failed\n");
    EXPECT_TRUE(exists("out/square-front.png"));
    EXPECT_TRUE(exists("out/a-main.png"));
}

TEST_F(Batch, GoesOnAfterAPictureThatDoesNotFit) {
    std::string small = read_file(square_), large = small;
    write("a.json", small.insert(1, R"("film": {"size": [8, 8]},)"));
    write("large.json", large.insert(1, R"("film": {"size": [30000, 30000]},)"));
    const ProcessResult result = quickly({"render", file("large.json"), a_, "--spp", "1", "--memory-limit",
                                          "4GiB", "-o", file("out/{stem}.png")});
    EXPECT_EQ(result.exit_code, 5) << result.err;
    EXPECT_CONTAINS(result.err, "candela: error: \"" + file("large.json") + "\": rendering ");
    EXPECT_CONTAINS(result.err, "1 done, 0 skipped, 1 failed\n");
    EXPECT_TRUE(exists("out/a.png"));
    EXPECT_FALSE(exists("out/large.png"));
}

// Of 2048x1024 texels, run-length encoded: 127 or fewer of the same byte are two bytes.
std::string large_sky() {
    constexpr int WIDTH = 2048, HEIGHT = 1024;
    std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1024 +X 2048\n";
    for (int y = 0; y < HEIGHT; ++y) {
        bytes += {2, 2, WIDTH >> 8, WIDTH & 255};
        for (int component = 0; component < 4; ++component) {
            for (int left = WIDTH; left > 0; left -= 127)
                bytes += {char(128 + std::min(left, 127)), char(128 + y % 16)};
        }
    }
    return bytes;
}

// Each of the two takes 150 to 180 MB, and about half of that remains while it is rendered.
TEST_F(Batch, TriesAgainAloneWhatDoesNotFitBesideAnother) {
    write("sky.hdr", large_sky());
    std::string text = read_file(square_);
    text.insert(1, R"("environment": {"file": "sky.hdr"},)");
    write("a.json", text);
    write("b.json", text);
    const ProcessResult result = quickly(render_all({a_, b_}) + Words{"--memory-limit", "200M"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(Batch, GoesOnAfterALostDevice) {
    const ProcessResult result = candela(render_all({a_, b_}), failing_device(1, 0, DEVICE_LOST));
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_CONTAINS(result.err, "candela: error: \"" + a_ + "\": vkQueueSubmit(");
    EXPECT_CONTAINS(result.err, "1 done, 0 skipped, 1 failed\n");
    EXPECT_FALSE(exists("out/a.png"));
    EXPECT_TRUE(exists("out/b.png"));
}

// The device is lost in the picture by the first camera, which goes on, and not in the second.
TEST_F(Batch, CountsTheFailuresOfEachPicture) {
    const Words both = render_all({square_}, "out/{view}.png") +
                       Words{"--size", "16x16", "--cameras", "all", "--report", report_};
    const ProcessResult result = candela(
        both, failing_device(1, 0, DEVICE_LOST) + std::map<std::string, std::string>{{"FAULT_WORK", "1"}});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_CONTAINS(result.err, "candela: warning: " + file("out/0.png") + ": vkQueueSubmit(");
    ASSERT_EQ(lines().size(), 2u);
    EXPECT_EQ(lines()[0]["device_failures"], 1);
    EXPECT_EQ(lines()[1]["device_failures"], 0);
}

TEST_F(Batch, SkipsWhatIsThere) {
    const std::string old = write("out/bad.png", "old");
    const ProcessResult result =
        quickly(render_all({bad_, a_}) + Words{"--skip-existing", "--report", report_});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_CONTAINS(result.err, "1 done, 1 skipped, 0 failed\n");
    EXPECT_EQ(states_of(lines()), (Words{"skipped", "done"}));
    EXPECT_EQ(read_file(old), "old");
    // A picture is there if all of its files are; names by cameras are known when the scene is read.
    write("out/square-front.png", "old");
    const ProcessResult second =
        quickly(render_all({square_}, "out/{stem}-{camera}.png") +
                Words{"--skip-existing", "--cameras", "all", "-o", file("out/{stem}-{camera}.exr")});
    EXPECT_CONTAINS(second.err, "2 done, 0 skipped, 0 failed\n");
    const ProcessResult third =
        quickly(render_all({square_}, "out/{stem}-{camera}.png") + Words{"--skip-existing"});
    EXPECT_EQ(third.err, "0 done, 1 skipped, 0 failed\n");
}

// A picture of fewer samples would be skipped when the batch goes on.
TEST_F(Batch, InterruptedLeavesWholePicturesOnly) {
    Process process(
        call(render_all({a_, b_}) + Words{"--spp", "16777216", "--progress", "json", "--report", report_}),
        options({{"CANDELA_VALIDATION", "0"}}));
    ASSERT_TRUE(process.wait_for_err("\"picture\":\"" + file("out/a.png") + '"'));
    process.send(SIGINT);
    const ProcessResult result = process.finish();
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_EQ(states_of(lines()), Words{"interrupted"});
    EXPECT_FALSE(exists("out/a.png"));
    EXPECT_FALSE(exists("out/b.png"));
}

TEST_F(Batch, ReadsAListFromStandardInput) {
    const ProcessResult result = run_process(
        Words{"/bin/sh", "-c", "printf '%s\\n' '" + a_ + "' | exec \"$0\" \"$@\""} + call(render_all({"-"})),
        options({{"CANDELA_VALIDATION", "0"}}));
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_CONTAINS(result.err, "1 done, 0 skipped, 0 failed\n");
    EXPECT_TRUE(exists("out/a.png"));
}

TEST_F(Batch, IsRefusedBeforeAnythingIsRead) {
    const auto refused = [&](const Words& arguments, const std::string& message, int code = 2) {
        const ProcessResult result = candela(Words{"render"} + arguments, NO_DRIVER);
        EXPECT_EQ(result.exit_code, code) << message;
        EXPECT_EQ(result.err, "candela: error: " + message + '\n');
    };
    const std::string png = file("out/{stem}.png"), one = ": cannot be used for several pictures; ";
    const auto twice = [&](const std::string& name, const std::string& a, const std::string& b) {
        return "-o: \"" + file(name) + "\" would be two pictures, of \"" + a + "\" and of \"" + b +
               "\"; tell them apart by fields in the name, such as {stem}, {folder}, {camera} or {view}";
    };
    refused({a_, b_, "-o", file("x.png")}, twice("x.png", a_, b_));
    refused({a_, a_, "-o", png}, twice("out/a.png", a_, a_));
    refused({a_, b_, "-o", file("{camera}.png")}, twice("{camera}.png", a_, b_));
    refused({a_, "--camera", "a/b", "--camera", "a_b", "-o", file("{camera}.png")},
            twice("a_b.png", a_, a_ + "\" by the camera \"a_b"));
    refused({a_, "--cameras", "all", "-o", png},
            "-o: \"" + png + "\" would be the picture of each camera; add the field {camera} or {view}");
    refused({a_, "-o", file("{a}.png")},
            "-o: \"" + file("{a}.png") +
                "\" has the unknown field {a}; the fields are {stem}, {name}, {folder}, {camera}, {view}, "
                "{frame}, {scene}, {variant}");
    refused({a_, b_, "-o", png, "--checkpoint", file("c.exr")},
            "--checkpoint" + one + "--skip-existing goes on with an interrupted batch");
    refused({a_, b_, "-o", png, "--write-every", "1s"},
            "--write-every" + one + "leave it out: each picture is written when it is done");
    refused({a_, b_, "-o", png, "--report", "-", "--reference", file("r.exr")},
            "--reference" + one + "render the picture that it belongs to alone");
    refused({a_, b_, "-o", png, "--report", file("r.json")},
            "--report: several pictures need a line each; give a name that ends in .jsonl instead of " +
                candela::quoted(file("r.json")));
    refused({a_, b_, "-o", file("none/{stem}.png")},
            "cannot write \"" + file("none/a.png") + "\": the directory \"" + file("none") +
                "\" does not exist; create it first",
            1);
    refused({a_, b_, "-o", file("{stem}.png"), "--report", file("a.jsonl"), "--cameras", "one"},
            "--cameras: cannot use \"one\"; expected all");
    refused({a_, "-o", file("bad.json/{stem}/x.png")},
            "cannot make the folder \"" + file("bad.json/a") + "\": Not a directory; choose another place",
            1);
    EXPECT_TRUE(fs::is_empty(file("out")));
}

// What only the scene says.
TEST_F(Batch, NoCameraHasTheFileOfAnother) {
    const std::string text = R"({"position": [0, 0, 3], "look_at": [0, 0, 0], "vertical_fov": 40})";
    const std::string scene =
        write("c.json", R"({"shapes": [], "cameras": {"a/b": )" + text + R"(, "a_b": )" + text + "}}");
    const ProcessResult result =
        candela({"render", scene, "--cameras", "all", "-o", file("{camera}.png")}, NO_DRIVER);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_CONTAINS(result.err, "candela: error: -o: \"" + file("a_b.png") +
                                    "\" would be two pictures, of \"" + scene + "\" and of \"" + scene +
                                    "\" by the camera \"a_b\"; tell them ");
    EXPECT_FALSE(exists("a_b.png"));
}

#ifdef CANDELA_FILE_FAULT
// The disk is full for the first line.
TEST_F(Batch, SaysOnceThatItsReportIsIncomplete) {
    const std::string reports = file("reports"), report = file("reports/report.jsonl"), log = file("log");
    fs::create_directory(reports);
    const ProcessResult result =
        run_process(call(render_all({a_, b_}) + Words{"--report", report}),
                    options({{"LD_PRELOAD", CANDELA_FILE_FAULT},
                             {"FILE_FAULT_FOLDER", reports},
                             {"FILE_FAULT_LOG", log},
                             {"FILE_FAULT_AT", "4"},  // After three that try the place.
                             {"FILE_FAULT_ERRNO", std::to_string(ENOSPC)}}));
    EXPECT_CONTAINS(read_file(log), "\n4 write " + report + '\n');
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_CONTAINS(result.err, "candela: error: \"" + a_ + "\": cannot write \"" + report +
                                    "\": a line of the report is lost; check the disk\n");
    EXPECT_CONTAINS(result.err, "1 done, 0 skipped, 1 failed\n");
    EXPECT_TRUE(exists("out/a.png"));
    EXPECT_TRUE(exists("out/b.png"));
}
#endif

// Also of pictures that are not rendered: standard output is full.
TEST_F(Batch, GoesOnWithoutItsReport) {
    const ProcessResult result = run_process(Words{"/bin/sh", "-c", "exec \"$0\" \"$@\" > /dev/full"} +
                                                 call(render_all({bad_, a_}) + Words{"--report", "-"}),
                                             options({{"CANDELA_VALIDATION", "0"}}));
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_CONTAINS(result.err, "candela: error: cannot write to standard output; check where it goes\n");
    EXPECT_TRUE(exists("out/a.png"));
}

}  // namespace
}  // namespace candela
