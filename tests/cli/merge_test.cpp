// `candela merge` as a user sees it: parts of a real rendering become what one uninterrupted run gives.
#include <algorithm>
#include <cmath>

#include "cli/cli_fixture.h"

namespace candela {
namespace {

class MergeTest : public CliTest {
  protected:
    // Renders samples of 32x32 pixels of the Cornell box.
    std::string part(const std::string& name, const std::string& samples, const Words& arguments = {}) const {
        const ProcessResult result = candela(Words{"render", CORNELL_BOX, "--size", "32x32", "--samples",
                                                   samples, "-o", file(name), "--quiet"} +
                                             arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return file(name);
    }
};

double value(const Image& image, const std::string& channel, size_t i) {
    return double(image.find(channel)->values[i]);
}

// The bounds of film/part_sum.h, and one rounding more for the whole image: u = 2^-24. Normals and means have
// the bound of the mean of the parts' absolute values. The device rounds squares to floats before it sums
// them, alike for parts and whole. If that makes a sum of squared deviations negative, it becomes 0, which is
// off by at most u times the mean of the squares, divided by N - 1.
TEST_F(MergeTest, PartsAgreeWithOneRunWithinRounding) {
    constexpr double U = 0x1p-24, N = 20;
    const std::vector<std::pair<std::string, double>> names = {{"0..5", 5}, {"5..6", 1}, {"6..20", 14}};
    std::vector<Image> parts;
    Words files;
    for (const auto& [samples, count] : names) {
        files.insert(files.begin(), part(samples + ".exr", samples, {"--crop", "3,5,29,30"}));
        parts.push_back(read_exr(files.front()));
        EXPECT_EQ(std::get<std::string>(parts.back().attributes.at("candela.samples")), samples);
    }
    const ProcessResult result =
        candela(Words{"merge"} + files + Words{"-o", file("a.exr"), "-o", file("a.png")});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(result.out, "merged 3 parts: samples 0..20\n");
    EXPECT_TRUE(std::filesystem::exists(file("a.png")));
    ASSERT_EQ(render({"--spp", "20", "-o", file("whole.exr"), "--crop", "3,5,29,30"}).exit_code, 0);

    const Image merged = read_exr(file("a.exr")), whole = read_exr(file("whole.exr"));
    EXPECT_EQ(merged.full, whole.full);
    EXPECT_EQ(merged.data, whole.data);
    ASSERT_EQ(merged.channels.size(), whole.channels.size());
    for (const Channel& channel : merged.channels) {
        for (size_t i = 0; i < merged.pixel_count(); ++i) {
            double absolute = 0.0, largest = 0.0;
            const bool variance = channel.name.starts_with("Variance");
            const std::string mean = variance ? channel.name.substr(9) : channel.name;
            for (size_t k = 0; k < parts.size(); ++k) {
                absolute += names[k].second / N * std::abs(value(parts[k], mean, i));
                largest = std::max(largest, std::abs(value(parts[k], mean, i)));
            }
            const double expected = value(whole, channel.name, i);
            double bound = 3.001 * U * absolute;
            if (variance) {
                const double squares = largest * largest + expected * (N - 1);
                bound = 4 * U * expected + 4 * U * largest * std::sqrt(expected / (N - 1)) +
                        4 * U * U * largest * largest / (N - 1) + U * squares / (N - 1);
            }
            if (channel.name[0] == 'P' || channel.name[0] == 'Z' || channel.name == "SampleCount.V")
                bound = 0;
            if (std::isinf(expected)) {
                EXPECT_EQ(double(channel.values[i]), expected);
            } else {
                EXPECT_NEAR(double(channel.values[i]), expected, bound) << channel.name << ' ' << i;
            }
        }
    }
    EXPECT_EQ(std::get<std::string>(merged.attributes.at("candela.samples")), "0..20");
    EXPECT_EQ(std::get<float>(merged.attributes.at("samplesPerPixel")), 20.0f);
    EXPECT_CONTAINS(std::get<std::string>(merged.attributes.at("candela.commandLine")), " merge ");
    EXPECT_EQ(merged.attributes.at("candela.identity"), whole.attributes.at("candela.identity"));
}

// The first submission adds a sample to each of 4096 pixels, a quarter of the picture, and uses up the time.
// No part holds that sample of the other pixels; but that of the 4096 counts, and the next samples may join
// it.
TEST_F(MergeTest, AnInterruptedPartCountsWhereItHasSamples) {
    const Words size = {"--size", "128x128", "--aov", "samples"};
    const std::string stopped = part("stopped.exr", "3..9", size + Words{"--time-limit", "1e-9s"});
    const std::string next = part("next.exr", "4..6", size), before = part("before.exr", "0..3", size);
    const Image some = read_exr(stopped);
    EXPECT_EQ(std::get<std::string>(some.attributes.at("candela.samples")), "3..4");
    EXPECT_EQ(std::get<float>(some.attributes.at("samplesPerPixel")), 0.0f);
    const ProcessResult result = candela({"merge", next, stopped, before, "-o", file("a.exr")});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "candela: warning: " + stopped +
                              " was interrupted: of the samples 3..4 some pixels hold only 0\n");
    EXPECT_EQ(result.out, "merged 3 parts: samples 0..6\n");
    const std::vector<float> counts = read_exr(file("a.exr")).find("SampleCount.V")->values;
    EXPECT_EQ(std::ranges::count(counts, 6.0f), 4096);
    EXPECT_EQ(std::ranges::count(counts, 5.0f), 3 * 4096);
    EXPECT_EQ(candela({"merge", part("whole.exr", "3..4", size), stopped, "-o", file("b.exr")}).exit_code, 1);
}

TEST_F(MergeTest, RefusalsAndWarningsReachTheUser) {
    const std::string a = part("a.exr", "0..2"), b = part("b.exr", "1..3"), c = part("c.exr", "4..5");
    const std::string seed = part("seed.exr", "2..3", {"--seed", "9"});
    const auto merge = [&](const Words& files) {
        return candela(Words{"merge"} + files + Words{"-o", file("m.exr")});
    };
    const ProcessResult overlap = merge({a, b});
    EXPECT_EQ(overlap.exit_code, 1);
    EXPECT_EQ(overlap.err, "candela: error: " + b + ": it holds samples 1..2 as " + a +
                               " does; leave one of them out, or render other samples (--samples)\n");
    EXPECT_EQ(merge({a, seed}).err, "candela: error: " + seed + ": it does not belong with " + a +
                                        ": its seed is 9, not 0; merge parts of one rendering\n");
    EXPECT_FALSE(std::filesystem::exists(file("m.exr")));
    const ProcessResult gap = merge({c, a});
    EXPECT_EQ(gap.exit_code, 0);
    EXPECT_EQ(gap.err, "candela: warning: the samples 2..4 are missing: no part holds them\n");
    EXPECT_EQ(gap.out, "merged 2 parts: samples 0..2,4..5\n");

    const ProcessResult checkpoint = candela({"render", CORNELL_BOX, "--size", "32x32", "--spp", "1", "-o",
                                              file("d.png"), "--checkpoint", file("state.exr")});
    EXPECT_EQ(checkpoint.exit_code, 0);
    EXPECT_CONTAINS(merge({a, file("state.exr")}).err,
                    "it has no channel R; give images (-o), not checkpoints or other files");
    EXPECT_EQ(candela({"merge", a}).exit_code, 2);
    EXPECT_EQ(candela({"merge", "-o", file("m.exr")}).exit_code, 2);
    EXPECT_CONTAINS(candela({"merge", a, "-o", file("none/m.exr")}).err, "none\" does not exist");
}

TEST_F(MergeTest, MissingPrintsWhatIsToBeRendered) {
    const std::string a = part("a.exr", "0..4"), b = part("b.exr", "8..12");
    ProcessResult result = candela({"merge", "--missing", "0..16", a, b});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, "4..8\n12..16\n");
    result = candela({"merge", "--missing", "0..4", a, b});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.out, "");
    std::filesystem::resize_file(b, std::filesystem::file_size(b) - 1);
    result = candela({"merge", "--missing", "0..16", a, b});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, "4..16\n");
    EXPECT_CONTAINS(result.err,
                    "candela: warning: a part is left out: cannot read \"" + b + "\": the file is damaged");
    result = candela({"merge", "--missing", "4..4", a});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_CONTAINS(result.err,
                    "--missing: cannot use \"4..4\"; expected A..B: samples A to B-1, with A < B, each at "
                    "most 16777216");
    result = candela({"merge", "--missing", "0..4", a, "-o", file("c.exr")});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_FALSE(std::filesystem::exists(file("c.exr")));
}

}  // namespace
}  // namespace candela
