// `candela render --adaptive`: the same bits regardless of what happens on the way, and the options that
// exclude it.
#include <algorithm>
#include <bit>
#include <csignal>
#include <filesystem>
#include <numeric>

#include "cli/cli_fixture.h"
#include "film/checkpoint.h"

namespace candela {
namespace {

class AdaptiveCli : public CliTest {
  protected:
    const Words picture_ = {"--size", "48x48", "--spp", "100", "--adaptive"};

    ProcessResult render_adaptively(const Words& arguments, const Words& more = {}) const {
        return candela(Words{"render", CORNELL_BOX} + picture_ + arguments + more);
    }
};

TEST_F(AdaptiveCli, SamplesPerPixelAreTheMean) {
    const ProcessResult result = render_adaptively({"-o", file("a.exr"), "--report", file("a.json")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_CONTAINS(result.err, "rendered 100 spp in ");
    const Image image = read_exr(file("a.exr"));
    const std::vector<float>& counts = image.find("SampleCount.V")->values;
    EXPECT_NEAR(std::accumulate(counts.begin(), counts.end(), 0.0) / double(counts.size()), 100.0, 0.5);
    EXPECT_LT(std::ranges::min(counts), 60.0f);
    EXPECT_GT(std::ranges::max(counts), 150.0f);
    EXPECT_EQ(std::get<std::string>(image.attributes.at("candela.adaptive")), "yes");
    const auto report = nlohmann::json::parse(read_file(file("a.json")));
    EXPECT_EQ(report["adaptive"], true);
    EXPECT_EQ(report["complete"], true);
    EXPECT_NEAR(report["rays_per_sample"], report_of({"--size", "48x48", "--spp", "8"})["rays_per_sample"],
                0.5);
    EXPECT_EQ(report_of({"--size", "48x48", "--spp", "8"})["adaptive"], false);
}

// Interrupted in some pass, a rendering goes on to the end of a pass as if nothing had happened.
TEST_F(AdaptiveCli, AResumedRenderingHasTheSameBits) {
    const Words endless = {"render", CORNELL_BOX, "-o", file("a.exr"), "--size", "32x32", "--adaptive"};
    const Words checkpoint = {"--checkpoint", file("state.exr"), "--resume"};
    ProcessOptions terminal = options();
    terminal.terminal = true;
    Process process(call(endless + checkpoint + Words{"--spp", "16777216"}), terminal);
    ASSERT_TRUE(process.wait_for_err("Msamples/s"));
    process.send(SIGINT);
    EXPECT_EQ(process.finish().exit_code, 130);
    const Checkpoint held = load_checkpoint(file("state.exr"));
    ASSERT_EQ(held.states.size(), 4u);
    const uint32_t samples = std::max({held.header.planned, samples_per_pixel(held.states), 32u});
    const Words whole = {"--spp", std::to_string(std::bit_ceil(samples))};
    EXPECT_EQ(candela(endless + checkpoint + whole).exit_code, 0);
    EXPECT_EQ(candela(endless + whole + Words{"-o", file("whole.exr")}).exit_code, 0);
    for (const char* channel : {"R", "G", "B", "A", "Albedo.G", "N.Y", "Variance.R", "SampleCount.V"}) {
        EXPECT_EQ(read_exr(file("a.exr")).find(channel)->values,
                  read_exr(file("whole.exr")).find(channel)->values)
            << channel;
    }
    // There are more samples than 16 now.
    const ProcessResult fewer = candela(endless + checkpoint + Words{"--spp", "16"});
    EXPECT_EQ(fewer.exit_code, 1);
    EXPECT_CONTAINS(fewer.err, " samples per pixel, but 16 are asked for; ask for at least as many");
}

TEST_F(AdaptiveCli, ACheckpointIsOfOneKind) {
    const Words small = {"render",    CORNELL_BOX, "-o",           file("a.exr"),     "--size",  "16x16",
                         "--sampler", "sobol",     "--checkpoint", file("state.exr"), "--resume"};
    ASSERT_EQ(candela(small + Words{"--spp", "4"}).exit_code, 0);
    const ProcessResult adaptive = candela(small + Words{"--spp", "64", "--adaptive"});
    EXPECT_EQ(adaptive.exit_code, 1);
    EXPECT_CONTAINS(
        adaptive.err,
        "it was made without --adaptive; render the same scene with the same options, or give another");
    std::filesystem::remove(file("state.exr"));
    ASSERT_EQ(candela(small + Words{"--spp", "64", "--adaptive"}).exit_code, 0);
    const ProcessResult uniform = candela(small + Words{"--spp", "128"});
    EXPECT_EQ(uniform.exit_code, 1);
    EXPECT_CONTAINS(
        uniform.err,
        "it was made with --adaptive; render the same scene with the same options, or give another");
}

TEST_F(AdaptiveCli, ATargetErrorEndsIt) {
    const ProcessResult result = render_adaptively({"-o", file("a.exr"), "--report", file("a.json")},
                                                   {"--spp", "65536", "--target-error", "0.2"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const auto report = nlohmann::json::parse(read_file(file("a.json")));
    EXPECT_EQ(report["complete"], true);
    EXPECT_LE(report["estimated_error"], 0.2);
    EXPECT_LT(report["spp"], 65536);
    const auto& points = report["convergence"];
    for (size_t i = 0; i + 1 < points.size(); ++i)
        EXPECT_GT(points[i]["estimated_error"], 0.2);
}

TEST_F(AdaptiveCli, WhatDoesNotGoWithItIsRefused) {
    const auto expect_refused = [&](const Words& arguments, int exit_code, const std::string& message) {
        const ProcessResult result = candela(arguments);
        EXPECT_EQ(result.exit_code, exit_code);
        EXPECT_CONTAINS(result.err, message);
    };
    const Words some = {"render", CORNELL_BOX, "-o", file("a.exr"), "--size", "16x16", "--adaptive"};
    expect_refused(some + Words{"--spp", "7"}, 2,
                   "--adaptive renders two halves: give an even number of samples per pixel (--spp), not 7");
    expect_refused(some + Words{"--samples", "0..64"}, 2, "--samples excludes --adaptive");
    ASSERT_EQ(candela(some + Words{"--spp", "8"}).exit_code, 0);
    expect_refused(
        {"merge", file("a.exr"), "-o", file("b.exr")}, 1,
        "it was rendered with --adaptive: its sample counts depend on the samples themselves; render "
        "parts with --samples");
}

}  // namespace
}  // namespace candela
