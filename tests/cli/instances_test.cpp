// Scenes of instances take every way that a picture can take: parts, crops, checkpoints, adaptive sampling.
#include <string>

#include "cli/cli_fixture.h"

namespace candela {
namespace {

const std::string INSTANCES = std::string(CANDELA_SCENES) + "/../tests/bench/scenes/instances.json";

class Instances : public CliTest {
  protected:
    // Renders 40x30 pixels to a file and reads it.
    Image rendered(const std::string& name, const Words& arguments) const {
        const ProcessResult result = candela(Words{"render", INSTANCES, "--allow-folder", CANDELA_SCENES,
                                                   "--size", "40x30", "--quiet", "-o", file(name)} +
                                             arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err, "");
        return read_exr(file(name));
    }
    static void expect_same_colours(const Image& a, const Image& b) {
        for (const char* channel : {"R", "G", "B", "A", "N.X", "P.Z", "SampleCount.V"})
            EXPECT_EQ(a.find(channel)->values, b.find(channel)->values) << channel;
    }
};

TEST_F(Instances, InfoTellsWhatTheyShare) {
    const ProcessResult info = candela({"info", INSTANCES, "--allow-folder", CANDELA_SCENES, "--json"});
    ASSERT_EQ(info.exit_code, 0) << info.err;
    const auto sharing = nlohmann::json::parse(info.out)["sharing"];
    EXPECT_EQ(sharing["instances"], 3);
    EXPECT_EQ(sharing["meshes"], 1);
    EXPECT_EQ(sharing["triangles_stored"], 30720);
    EXPECT_EQ(sharing["triangles_seen"], 3 * 30720);
    EXPECT_GT(sharing["bytes_saved"], 0);
    EXPECT_CONTAINS(candela({"info", INSTANCES, "--allow-any-folder"}).out, "3 of 1 meshes: ");
}

TEST_F(Instances, PartsMakeTheWhole) {
    rendered("whole.exr", {"--spp", "8"});
    rendered("first.exr", {"--samples", "0..3"});
    rendered("second.exr", {"--samples", "3..8"});
    ASSERT_EQ(candela({"merge", file("first.exr"), file("second.exr"), "-o", file("merged.exr")}).exit_code,
              0);
    // Every mean may be off by three roundings: part_sum.h.
    EXPECT_EQ(candela({"compare", file("merged.exr"), file("whole.exr"), "--relmse", "3.2e-14"}).exit_code,
              0);
}

TEST_F(Instances, ACropHasTheBitsOfTheWhole) {
    const Image whole = rendered("whole.exr", {"--spp", "4"});
    const Image crop = rendered("crop.exr", {"--spp", "4", "--crop", "11,7,31,26"});
    for (const char* channel : {"R", "G", "B", "A"}) {
        for (uint32_t y = 7; y < 26; ++y) {
            for (uint32_t x = 11; x < 31; ++x) {
                ASSERT_EQ(crop.find(channel)->values[(y - 7) * 20 + x - 11],
                          whole.find(channel)->values[y * 40 + x])
                    << channel << ' ' << x << ' ' << y;
            }
        }
    }
}

TEST_F(Instances, CheckpointsGoOnToTheSameBits) {
    const Image whole = rendered("whole.exr", {"--spp", "8"});
    const Words checkpoint = {"--checkpoint", file("state.exr"), "--resume"};
    rendered("a.exr", Words{"--spp", "3", "--checkpoint", file("state.exr")});
    expect_same_colours(rendered("a.exr", Words{"--spp", "8"} + checkpoint), whole);
}

TEST_F(Instances, AdaptiveSamplingGoesOnToTheSameBits) {
    const Image whole = rendered("whole.exr", {"--spp", "64", "--adaptive"});
    const Words checkpoint = {"--adaptive", "--checkpoint", file("state.exr")};
    rendered("a.exr", Words{"--spp", "32"} + checkpoint);
    expect_same_colours(rendered("a.exr", Words{"--spp", "64", "--resume"} + checkpoint), whole);
}

}  // namespace
}  // namespace candela
