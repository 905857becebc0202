// `candela compare`: figures, exit codes, heat maps and errors. The images are made here, not rendered.
#include "cli/cli_fixture.h"

namespace candela {
namespace {

class Compare : public CliTest {
  protected:
    // A grey image of 16x16 pixels; if `variance` is 0, without the channels Variance.
    std::string image(const std::string& name, float value, float variance) const {
        Image result{.full = {16, 16}, .data = {0, 0, 16, 16}, .channels = {}, .attributes = {}};
        for (const char* channel : {"R", "G", "B"})
            result.add(channel, value);
        if (variance > 0.0f) {
            for (const char* channel : {"Variance.R", "Variance.G", "Variance.B"})
                result.add(channel, variance);
        }
        write_exr(file(name), result);
        return file(name);
    }
};

TEST_F(Compare, NoiseAgrees) {
    const ProcessResult result =
        candela({"compare", image("a.exr", 1.0f, 1e-2f), image("b.exr", 1.001f, 1e-2f)}, NO_DRIVER);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    for (const char* figure : {"relMSE   9.88", "pixels   100.000 %", "blocks   worst z -",
                               "mean     worst z -", "the images agree\n"}) {
        EXPECT_CONTAINS(result.out, figure);
    }
}

TEST_F(Compare, ABiasThatNoPixelShowsIsADifference) {
    const ProcessResult result =
        candela({"compare", image("a.exr", 1.0f, 1e-2f), image("b.exr", 1.05f, 1e-2f)});
    EXPECT_EQ(result.exit_code, 6);
    EXPECT_EQ(result.err, "");
    EXPECT_CONTAINS(result.out, "(at least 99.75 %)");
    EXPECT_CONTAINS(result.out, "mean     worst z -5.66 in R of 0,0,16,16 (at most 2.93): FAIL");
    EXPECT_CONTAINS(result.out, "the images DIFFER\n");
}

TEST_F(Compare, WithoutVarianceRelmseDecides) {
    const std::string a = image("a.exr", 1.0f, 0.0f);
    const ProcessResult near = candela({"compare", a, image("b.exr", 1.03f, 1e-2f)});
    EXPECT_EQ(near.exit_code, 0);
    EXPECT_CONTAINS(near.out, "(at most 0.001): pass");
    EXPECT_CONTAINS(near.out, "not tested: the images do not both have Variance");
    EXPECT_EQ(candela({"compare", a, image("b.exr", 1.04f, 1e-2f)}).exit_code, 6);
}

TEST_F(Compare, LimitsCanBeSet) {
    const std::string a = image("a.exr", 1.0f, 1e-2f);
    const std::string b = image("b.exr", 1.05f, 1e-2f);
    EXPECT_EQ(candela({"compare", a, b, "--relmse", "1e-2"}).exit_code, 0);
    EXPECT_EQ(candela({"compare", a, b, "--relmse", "1e-3"}).exit_code, 6);
    EXPECT_EQ(candela({"compare", a, b, "--z", "1e-9"}).exit_code, 0);
    EXPECT_EQ(candela({"compare", a, b, "--z", "1e-3"}).exit_code, 6);
    EXPECT_EQ(candela({"compare", a, b, "--z", "1e-3", "--relmse", "1"}).exit_code, 2);

    const ProcessResult alpha = candela({"compare", a, b, "--z", "1"});
    EXPECT_EQ(alpha.exit_code, 2);
    EXPECT_CONTAINS(alpha.err, "--z: cannot use \"1\"; expected a probability between 0 and 1");
    const ProcessResult limit = candela({"compare", a, b, "--relmse", "-1"});
    EXPECT_EQ(limit.exit_code, 2);
    EXPECT_CONTAINS(limit.err, "--relmse: cannot use \"-1\"; expected a number, 0 or more");
    const ProcessResult none = candela({"compare", a, image("c.exr", 1.0f, 0.0f), "--z", "0.1"});
    EXPECT_EQ(none.exit_code, 1);
    EXPECT_CONTAINS(none.err, "--z: the images do not both have Variance");
}

TEST_F(Compare, HeatmapIsAPng) {
    const std::string a = image("a.exr", 1.0f, 1e-2f);
    const std::string b = image("b.exr", 1.05f, 1e-2f);
    EXPECT_EQ(candela({"compare", a, b, "--heatmap", file("map.png")}).exit_code, 6);
    EXPECT_EQ(read_file(file("map.png")).substr(1, 3), "PNG");

    const ProcessResult extension = candela({"compare", a, b, "--heatmap", file("map.exr")});
    EXPECT_EQ(extension.exit_code, 2);
    EXPECT_CONTAINS(extension.err, "expected a file name ending in .png");
    const ProcessResult folder = candela({"compare", a, b, "--heatmap", file("none/map.png")});
    EXPECT_EQ(folder.exit_code, 1);
    EXPECT_CONTAINS(folder.err, "does not exist; create it first");
}

TEST_F(Compare, ImagesThatCannotBeComparedAreErrors) {
    const std::string a = image("a.exr", 1.0f, 1e-2f);
    const ProcessResult missing = candela({"compare", a, file("none.exr")});
    EXPECT_EQ(missing.exit_code, 1);
    EXPECT_CONTAINS(missing.err, "none.exr\": the file does not exist");
    const ProcessResult text = candela({"compare", a, write("text.exr", "text")});
    EXPECT_EQ(text.exit_code, 1);
    EXPECT_CONTAINS(text.err, "it is not an OpenEXR file");

    Image small{.full = {8, 8}, .data = {0, 0, 8, 8}, .channels = {}, .attributes = {}};
    for (const char* channel : {"R", "G", "B"})
        small.add(channel);
    write_exr(file("small.exr"), small);
    const ProcessResult size = candela({"compare", a, file("small.exr")});
    EXPECT_EQ(size.exit_code, 1);
    EXPECT_CONTAINS(size.err, "image A has 16x16 pixels, image B 8x8");
}

}  // namespace
}  // namespace candela
