// A device that is lost, or out of memory, in the middle of a rendering. A Vulkan layer makes it fail
// (tests/faults/device_fault.cpp); the program itself knows nothing of tests.
#include <csignal>
#include <regex>

#include "cli/cli_fixture.h"

namespace candela {
namespace {

class DeviceFailure : public CliTest {
  protected:
    // 64x64 pixels take a dozen submissions. Before them come those of uploads and positions: up to 11,
    // depending on the device's memory, and 8 more for the layers of a state.
    Words picture_ = {"--size", "64x64", "--spp", "128"};

    Process start_on_failing(int devices, int submissions, int result, const Words& arguments = {},
                             int openings = 0) const {
        return Process(call(Words{"render", CORNELL_BOX, "-o", file("a.exr"), "--report", file("a.json")} +
                            picture_ + arguments),
                       options(failing_device(devices, submissions, result, openings)));
    }
    ProcessResult render_on_failing(int devices, int submissions, int result, const Words& arguments = {},
                                    int openings = 0) const {
        return start_on_failing(devices, submissions, result, arguments, openings).finish();
    }
    nlohmann::json report() const { return nlohmann::json::parse(read_file(file("a.json"))); }
    // The hash of the image from a device that does not fail.
    std::string undisturbed() const { return report_of(picture_)["image_hash"]; }
    // What the warnings say: samples kept, and milliseconds of a submission from then on.
    static std::vector<std::pair<int, double>> recoveries(const std::string& err) {
        const std::regex pattern("continuing from (\\d+) samples per pixel in submissions of ([0-9.]+) ms\n");
        std::vector<std::pair<int, double>> result;
        for (std::sregex_iterator match(err.begin(), err.end(), pattern), end; match != end; ++match)
            result.emplace_back(std::stoi((*match)[1]), std::stod((*match)[2]));
        return result;
    }
};

TEST_F(DeviceFailure, ALostDeviceIsOpenedAgainAndTheImageHasTheSameBits) {
    const ProcessResult result = render_on_failing(2, 12, DEVICE_LOST);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_CONTAINS(result.err, "candela: warning: vkQueueSubmit(");
    EXPECT_CONTAINS(result.err, "VK_ERROR_DEVICE_LOST (-4)");
    const auto warned = recoveries(result.err);
    ASSERT_EQ(warned.size(), 2u) << result.err;
    EXPECT_NEAR(warned[1].second, warned[0].second / 2, 0.001);  // Printed with three digits.
    EXPECT_EQ(report()["device_failures"], 2);
    EXPECT_EQ(report()["image_hash"], undisturbed());
}

// The state is copied as often as possible: each device gets a little further than the previous one, so that
// more than five may fail. This needs a picture of one work group, however few samples a submission takes:
// with a larger one, a slow device would begin with the same group each time. How far they get depends on
// their speed: the seventh renders until it is told to stop, and then to the next whole number of samples.
// (Copies are submissions, too: four for the layers of a state.)
TEST_F(DeviceFailure, WhatTheHostHoldsIsNotRenderedAgain) {
    const Words checkpoint = {"--aov", "none", "--checkpoint", file("state.exr")};
    picture_ = {"--size", "8x8"};
    Process process = start_on_failing(
        6, 28, DEVICE_LOST, checkpoint + Words{"--checkpoint-every", "1e-9s", "--spp", "16777216"});
    ASSERT_TRUE(process.wait_for_err("continuing from ", 6)) << process.err();
    process.send(SIGINT);
    const ProcessResult result = process.finish();
    EXPECT_EQ(result.exit_code, 130);
    const auto warned = recoveries(result.err);
    ASSERT_EQ(warned.size(), 6u) << result.err;
    EXPECT_GT(warned.front().first, 0);
    EXPECT_GT(warned.back().first, warned.front().first);

    // Nothing is lost, or counted twice.
    const std::string samples = report()["samples"];  // 0..N
    const Words whole = picture_ + Words{"--spp", samples.substr(3)};
    const nlohmann::json resumed = report_of(whole + checkpoint + Words{"--resume"});
    const nlohmann::json undisturbed = report_of(whole);
    EXPECT_EQ(resumed["image_hash"], undisturbed["image_hash"]);
    // Samples of a pixel are traced again where a driver ends a long submission early: a few in thousands.
    EXPECT_NEAR(resumed["rays_per_sample"], undisturbed["rays_per_sample"], 0.01);
}

// While a device fails that renders one of the four states of an adaptive rendering, the other three are
// held. Changing from one to another takes 16 submissions and more.
TEST_F(DeviceFailure, AnAdaptiveRenderingGoesOnInEveryState) {
    picture_ = {"--size", "48x48", "--spp", "64", "--adaptive"};
    const ProcessResult result = render_on_failing(2, 40, DEVICE_LOST);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(recoveries(result.err).size(), 2u);
    EXPECT_EQ(report()["image_hash"], undisturbed());
}

// The last state is written, which is what a checkpoint held. Each device fails at the first submission that
// renders, so that a slow one makes no progress either.
TEST_F(DeviceFailure, AfterFiveFailuresWithoutProgressTheErrorStands) {
    const Words checkpoint = {"--checkpoint", file("state.exr"), "--resume", "--aov", "none"};
    ASSERT_EQ(candela(Words{"render", CORNELL_BOX, "-o", file("b.exr"), "--size", "64x64", "--spp", "3"} +
                      checkpoint)
                  .exit_code,
              0);
    const ProcessResult result =
        candela(Words{"render", CORNELL_BOX, "-o", file("a.exr")} + picture_ + checkpoint,
                failing_device(1000, 0, OUT_OF_DEVICE_MEMORY) +
                    std::map<std::string, std::string>{{"FAULT_WORK", "1"}});
    EXPECT_EQ(result.exit_code, 5);
    EXPECT_EQ(recoveries(result.err).size(), 4u);
    EXPECT_CONTAINS(result.err, "VK_ERROR_OUT_OF_DEVICE_MEMORY (-2)");
    EXPECT_CONTAINS(result.err, "continuing from 3 samples per pixel");
    EXPECT_CONTAINS(result.err, "rendered 3 of 128 spp");
    EXPECT_CONTAINS(result.err, "candela: error: vkQueueSubmit(");
    const Image image = read_exr(file("a.exr"));
    EXPECT_EQ(image.find("R")->values, read_exr(file("b.exr")).find("R")->values);
}

// A driver that resets its device cannot open it at once.
TEST_F(DeviceFailure, OpeningAgainIsTriedSeveralTimes) {
    const ProcessResult result = render_on_failing(1, 12, DEVICE_LOST, {}, 2);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_CONTAINS(result.err, "VK_ERROR_INITIALIZATION_FAILED (-3)");
    EXPECT_EQ(report()["device_failures"], 3);
    const ProcessResult hopeless = render_on_failing(1, 12, DEVICE_LOST, {}, 4);
    EXPECT_EQ(hopeless.exit_code, 4);
    EXPECT_CONTAINS(hopeless.err, "candela: error: vkQueueSubmit(");
}

TEST_F(DeviceFailure, OtherErrorsAreNotTriedAgain) {
    const ProcessResult result = render_on_failing(1, 12, INITIALIZATION_FAILED);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(recoveries(result.err).size(), 0u);
    EXPECT_CONTAINS(result.err, "VK_ERROR_INITIALIZATION_FAILED (-3)");
    EXPECT_FALSE(std::filesystem::exists(file("a.exr")));
}

}  // namespace
}  // namespace candela
