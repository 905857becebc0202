// A rendering in progress: images that are current, progress for programs, and an error to stop at.
#include <cmath>
#include <csignal>
#include <sstream>

#include "cli/cli_fixture.h"
#include "support/wait.h"

namespace candela {
namespace {

using Json = nlohmann::json;

class Progressive : public CliTest {
  protected:
    // Each line must be an object.
    static std::vector<Json> lines_of(const std::string& err) {
        std::vector<Json> lines;
        std::istringstream stream(err);
        for (std::string line; std::getline(stream, line);)
            lines.push_back(Json::parse(line));
        return lines;
    }
    static void wait_for(const std::string& path) {
        wait_until(path + " is there", [&] { return std::filesystem::exists(path); });
    }
    // For a rendering without an end: lines before the last come twice a second at most.
    static void expect_progress(const std::vector<Json>& lines) {
        double previous = 0.0;
        for (const Json& line : lines) {
            const bool last = &line == &lines.back();
            EXPECT_EQ(line["state"] == "rendering", !last);
            EXPECT_EQ(line["target_spp"], 16777216);
            EXPECT_GT(line["spp"], 0);
            const double seconds = line["seconds"];
            EXPECT_GE(seconds - previous, last ? 0.0 : 0.5);
            previous = seconds;
            EXPECT_NEAR(double(line["samples_per_second"]) * seconds, double(line["spp"]) * 64 * 64,
                        64.0 * 64);  // Reported in whole samples per pixel.
            EXPECT_TRUE(line["estimated_error"].is_null());
        }
    }
    static float min_samples(const std::string& path) {
        return std::ranges::min(read_exr(path).find("SampleCount.V")->values);
    }
    // The first submission gives every pixel a sample.
    const Words endless_ = {"render", CORNELL_BOX, "--size", "64x64", "--spp", "16777216"};
};

// Read as often as possible while it is being replaced, the image is always whole, and never goes back; and
// it is there after the program was killed.
TEST_F(Progressive, OutputsAreValidImagesAllTheTime) {
    Process process(
        call(endless_ + Words{"-o", file("a.exr"), "-o", file("a.png"), "--write-every", "0.01s"}),
        options());
    wait_for(file("a.exr"));
    float samples = 0.0f;
    int advances = 0;
    for (int reads = 0; reads < 100 || advances < 3; ++reads) {
        const float now = min_samples(file("a.exr"));
        ASSERT_GE(now, samples);
        advances += now > samples ? 1 : 0;
        samples = now;
    }
    process.send(SIGKILL);
    EXPECT_EQ(process.finish().signal, SIGKILL);
    const Image image = read_exr(file("a.exr"));
    EXPECT_EQ(image.full, uvec2(64, 64));
    EXPECT_EQ(std::get<float>(image.attributes.at("samplesPerPixel")), min_samples(file("a.exr")));
    EXPECT_GT(std::get<float>(image.attributes.at("renderTimeSeconds")), 0.0f);
    EXPECT_TRUE(std::filesystem::exists(file("a.png")));
}

// There is a pause between two writings, and the program itself says when they begin: by its own clock, with
// the 24 bits of a float.
TEST_F(Progressive, OutputsAreWrittenNoMoreOftenThanAskedFor) {
    Process process(call(endless_ + Words{"-o", file("a.exr"), "--write-every", "0.3s"}), options());
    wait_for(file("a.exr"));
    const auto written = [&] {
        return double(std::get<float>(read_exr(file("a.exr")).attributes.at("renderTimeSeconds")));
    };
    double last = written();
    EXPECT_GE(last, 0.3 * (1 - 1e-6));
    for (int i = 0; i < 3; ++i) {
        double now = last;
        wait_until("it is written again", [&] { return (now = written()) != last; });
        EXPECT_GE(now - last, 0.3 - 1e-6 * now);
        last = now;
    }
}

TEST_F(Progressive, WritingOnTheWayChangesNoBitOfTheImage) {
    EXPECT_EQ(hash_of({"--spp", "40", "--write-every", "0.001s"}), hash_of({"--spp", "40"}));
}

// The folder of one output vanishes: a warning, the other output goes on, and both are there at the end.
TEST_F(Progressive, AnImageThatCannotBeWrittenIsAWarning) {
    std::filesystem::create_directory(file("gone"));
    Process process(
        call(endless_ + Words{"-o", file("gone/a.png"), "-o", file("b.exr"), "--write-every", "0.05s"}),
        options());
    wait_for(file("gone/a.png"));
    wait_for(file("b.exr"));
    std::filesystem::rename(file("gone"), file("elsewhere"));
    ASSERT_TRUE(process.wait_for_err("rendering continues without this image"));
    const float samples = min_samples(file("b.exr"));
    wait_until("the other goes on", [&] { return min_samples(file("b.exr")) > samples; });
    std::filesystem::create_directory(file("gone"));
    wait_for(file("gone/a.png"));
    process.send(SIGINT);
    const ProcessResult result = process.finish();
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_CONTAINS(result.err, "candela: warning: cannot write \"" + file("gone/a.png") +
                                    "\": the directory \"" + file("gone") +
                                    "\" does not exist; create it first; rendering continues without this "
                                    "image");
    EXPECT_TRUE(std::filesystem::exists(file("gone/a.png")));
    EXPECT_GT(min_samples(file("b.exr")), samples);
}

TEST_F(Progressive, JsonTellsHowItStandsAndHowItEnded) {
    const std::vector<Json> lines = lines_of(
        candela(endless_ + Words{"-o", file("a.exr"), "--progress", "json", "--time-limit", "1.3s"}).err);
    ASSERT_GE(lines.size(), 1u);
    expect_progress(lines);
    EXPECT_EQ(lines.back()["state"], "time limit");
    for (const Json& line : lines)
        EXPECT_NEAR(double(line["seconds_left"]), std::max(0.0, 1.3 - double(line["seconds"])), 1e-9);
    double samples = 0.0;
    const Image image = read_exr(file("a.exr"));
    for (const float count : image.find("SampleCount.V")->values)
        samples += count;
    EXPECT_EQ(lines.back()["spp"], std::floor(samples / (64 * 64)));

    const auto last = lines_of(render({"-o", file("b.png"), "--progress", "json"}).err);
    ASSERT_GE(last.size(), 1u);
    EXPECT_EQ(last.back()["state"], "done");
    EXPECT_EQ(last.back()["spp"], 4);
    EXPECT_EQ(last.back()["seconds_left"], 0.0);
}

TEST_F(Progressive, JsonTellsOfAnInterruption) {
    Process process(call(endless_ + Words{"-o", file("a.png"), "--progress", "json"}), options());
    ASSERT_TRUE(process.wait_for_err("rendering", 2));
    process.send(SIGINT);
    const ProcessResult result = process.finish();
    EXPECT_EQ(result.exit_code, 130);
    const std::vector<Json> lines = lines_of(result.err);
    ASSERT_GE(lines.size(), 3u);
    expect_progress(lines);
    EXPECT_EQ(lines.back()["state"], "interrupted");
    for (const Json& line : lines) {
        const double rate = line["samples_per_second"];
        const double left = 16777216.0 * 64 * 64 / rate - double(line["seconds"]);
        EXPECT_NEAR(double(line["seconds_left"]), left, 1e-9 * left);
    }
}

TEST_F(Progressive, NoProgressStillLeavesTheSummary) {
    ProcessOptions terminal = options();
    terminal.terminal = true;
    const std::string err =
        run_process(call(endless_ + Words{"-o", file("a.png"), "--progress", "none", "--time-limit", "0.4s"}),
                    terminal)
            .err;
    EXPECT_EQ(err.rfind("rendered ", 0), 0u) << err;
}

// The estimate falls below the target at some power of two, which is the same however the work is cut.
TEST_F(Progressive, ATargetErrorEndsTheRendering) {
    const Words arguments = {"--size", "32x32", "--spp", "100000", "--target-error", "0.2"};
    const Json report = report_of(arguments);
    const uint32_t spp = report["spp"];
    EXPECT_GE(spp, 16u);
    EXPECT_LE(spp, 1024u);
    EXPECT_EQ(spp & (spp - 1), 0u);
    EXPECT_EQ(report["complete"], true);
    EXPECT_EQ(report["target_error"], 0.2);
    EXPECT_LE(report["estimated_error"], 0.2);
    const Json& points = report["convergence"];
    ASSERT_GE(points.size(), 2u);
    EXPECT_EQ(points.back()["estimated_error"], report["estimated_error"]);
    const Json& before = points[points.size() - 2];
    EXPECT_EQ(2 * uint32_t(before["spp"]), spp);
    EXPECT_TRUE(before["estimated_error"].is_null() ? spp == 16 : before["estimated_error"] > 0.2);
    EXPECT_EQ(report["image_hash"], hash_of({"--spp", std::to_string(spp)}));

    const Json again = report_of(arguments + Words{"--write-every", "0.001s"});
    EXPECT_EQ(again["spp"], report["spp"]);
    EXPECT_EQ(again["estimated_error"], report["estimated_error"]);
}

TEST_F(Progressive, ATargetErrorThatIsNotReachedIsAWarning) {
    const ProcessResult result =
        render({"-o", file("a.png"), "--spp", "40", "--target-error", "0.001", "--report", file("r.json")});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_CONTAINS(result.err,
                    "candela: warning: the target error was not reached with 40 samples per "
                    "pixel; allow more (--spp)\n");
    EXPECT_CONTAINS(result.err, ", estimated error 0.");
    EXPECT_CONTAINS(result.err, " (target 0.0010)\n");
    const Json report = Json::parse(read_file(file("r.json")));
    EXPECT_EQ(report["spp"], 40);
    EXPECT_GT(report["estimated_error"], 0.001);

    const ProcessResult few = render({"-o", file("a.png"), "--target-error", "1"});  // Of four samples.
    EXPECT_CONTAINS(few.err, "the target error was not reached with 4 samples");
    EXPECT_CONTAINS(few.err, ", estimated error unknown (target 1.0000)\n");
}

// A resumed rendering ends in the same way, with the same bits as a rendering of as many samples.
TEST_F(Progressive, ATargetErrorCanBeResumedAndLowered) {
    const Words checkpoint = {"--size",       "32x32",       "--spp",   "100000",
                              "--checkpoint", file("s.exr"), "--resume"};
    const uint32_t first = report_of(checkpoint + Words{"--target-error", "0.3"})["spp"];
    const Json second = report_of(checkpoint + Words{"--target-error", "0.15"});
    EXPECT_GT(second["spp"], first);
    EXPECT_LE(second["estimated_error"], 0.15);
    EXPECT_EQ(second["image_hash"], hash_of({"--spp", std::to_string(uint32_t(second["spp"]))}));
}

// What the report says of the last point is what the files themselves show.
TEST_F(Progressive, AReferenceGivesErrorAgainstTime) {
    ASSERT_EQ(render({"-o", file("reference.exr"), "--spp", "64", "--seed", "5"}).exit_code, 0);
    const ProcessResult result = render({"-o", file("a.exr"), "--spp", "20", "--reference",
                                         file("reference.exr"), "--report", file("r.json")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const Json report = Json::parse(read_file(file("r.json")));
    EXPECT_EQ(report["reference"], file("reference.exr"));
    const Json& points = report["convergence"];
    const std::vector<int> expected = {1, 2, 4, 8, 16, 20};
    ASSERT_EQ(points.size(), expected.size());
    double seconds = 0.0;
    for (size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(points[i]["spp"], expected[i]);
        EXPECT_GT(points[i]["seconds"], seconds);
        seconds = points[i]["seconds"];
    }
    EXPECT_LT(points[4]["relmse"], points[0]["relmse"]);
    const Image image = read_exr(file("a.exr")), reference = read_exr(file("reference.exr"));
    double mean = 0.0, sum = 0.0;
    for (const char* name : {"R", "G", "B"}) {
        for (const float r : reference.find(name)->values)
            mean += r / (3.0 * 32 * 32);
    }
    for (const char* name : {"R", "G", "B"}) {
        for (size_t i = 0; i < image.pixel_count(); ++i) {
            const double r = reference.find(name)->values[i], x = image.find(name)->values[i];
            sum += (x - r) * (x - r) / (r * r + mean * mean / 100);
        }
    }
    EXPECT_NEAR(points[5]["relmse"], sum / (3.0 * 32 * 32), 1e-9);
}

TEST_F(Progressive, WhatMakesNoSenseIsRefused) {
    const auto expect_refused = [&](const Words& arguments, int exit_code, const std::string& message) {
        const ProcessResult result = render(Words{"-o", file("a.png")} + arguments);
        EXPECT_EQ(result.exit_code, exit_code);
        EXPECT_CONTAINS(result.err, message);
    };
    for (const std::string error : {"0", "-1", "inf", "2 %"}) {
        expect_refused(
            {"--target-error", error}, 2,
            "--target-error: cannot use \"" + error + "\"; expected a number above 0, such as 0.02");
    }
    expect_refused({"--write-every", "0"}, 2,
                   "--write-every: cannot use \"0\"; expected a duration such as 90, 90s, 1.5m or 2h");
    expect_refused({"--progress", "xml"}, 2, "--progress: cannot use \"xml\"; expected auto|json|none");
    expect_refused({"--progress", "json", "--quiet"}, 2, "--quiet");
    expect_refused({"--reference", file("r.exr")}, 2, "--reference requires --report");

    const Words report = {"--report", file("r.json"), "--reference"};
    expect_refused(report + Words{file("none.exr")}, 1, "none.exr\": the file does not exist");
    Image image{.full = {32, 32}, .data = {0, 0, 32, 16}, .channels = {}, .attributes = {}};
    image.add("A");
    const std::string reference = file("r.exr");
    const std::string refusal = "candela: error: --reference: \"" + reference + "\" ";
    write_exr(reference, image);
    expect_refused(report + Words{reference}, 1,
                   refusal +
                       "has 32x32 pixels, crop 0,0,32,16, and this rendering has 32x32 pixels, crop "
                       "0,0,32,32; give both the same --size and --crop");
    image = {.full = {32, 32}, .data = {0, 0, 32, 32}, .channels = {}, .attributes = {}};
    image.add("A");
    for (const char* name : {"R", "G", "B"}) {
        write_exr(reference, image);
        expect_refused(report + Words{reference}, 1,
                       refusal + "lacks a channel R, G or B; give an image by candela render");
        image.add(name);
    }
    write_exr(reference, image);
    expect_refused(report + Words{reference}, 1, refusal + "is black, so no error can be relative to it");
    image.channels[1].values[7] = INFINITY;
    write_exr(reference, image);
    expect_refused(report + Words{reference}, 1, refusal + "holds a value that is not finite");
}

}  // namespace
}  // namespace candela
