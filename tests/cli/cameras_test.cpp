// Cameras around a scene and from files, from the command line to the pixels.
#include <algorithm>
#include <cmath>

#include "cli/cli_fixture.h"

namespace candela {
namespace {

class Cameras : public CliTest {
  protected:
    // A sphere of radius 0.5 around (1, 2, 3).
    std::string sphere() const {
        return write("sphere.json", R"({
            "cameras": {"main": {"position": [0, 0, 9], "look_at": [0, 0, 0], "vertical_fov": 40}},
            "film": {"size": [48, 32]}, "materials": {"white": {"type": "diffuse", "reflectance": 0.5}},
            "shapes": [{"type": "sphere", "center": [1, 2, 3], "radius": 0.5, "material": "white"}],
            "environment": {"radiance": 1, "visible": false}})");
    }
    Image image_of(const Words& arguments) const {
        const ProcessResult result =
            candela(Words{"render", sphere(), "-o", file("a.exr"), "--spp", "1"} + arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return read_exr(file("a.exr"));
    }
    ProcessResult refused(const Words& arguments) const {
        return candela(Words{"render", sphere(), "-o", file("a.exr")} + arguments, NO_DRIVER);
    }
};

// Rows and columns with a pixel whose centre shows a surface: the first, and the one after the last.
PixelRect seen(const Image& image) {
    const std::vector<float>& depth = image.find("Z")->values;
    PixelRect rect{image.full.x, image.full.y, 0, 0};
    for (uint32_t i = 0; i < depth.size(); ++i) {
        if (std::isinf(depth[i])) continue;
        const uint32_t x = i % image.full.x, y = i / image.full.x;
        rect = {std::min(rect.x0, x), std::min(rect.y0, y), std::max(rect.x1, x + 1),
                std::max(rect.y1, y + 1)};
    }
    return rect;
}

TEST_F(Cameras, AViewFillsTheFrameUpToTheMargin) {
    // A circle touches a line at a point, so that the outermost row of centres, half a pixel off, may miss
    // it.
    EXPECT_EQ(seen(image_of({"--view", "-30,-20", "--margin", "0.25", "--lens", "90"})),
              (PixelRect{16, 8, 32, 24}));
    EXPECT_EQ(seen(image_of({"--turntable", "4,0", "--camera", "turntable_001", "--margin", "0"})),
              (PixelRect{8, 0, 40, 32}));
    EXPECT_EQ(seen(image_of({"--dome", "9", "--camera", "dome_008", "--margin", "0", "--size", "32x64"})),
              (PixelRect{0, 16, 32, 48}));
}

// Azimuth 90 looks at the side of +X: the middle of the sphere's picture is at x = 1.5.
TEST_F(Cameras, AViewComesFromItsAzimuth) {
    const Image image = image_of({"--view", "90,0"});
    const size_t middle = 16 * 48 + 24;
    EXPECT_NEAR(image.find("P.X")->values[middle], 1.5, 1e-2);
    EXPECT_NEAR(image.find("P.Y")->values[middle], 2.0, 5e-2);
    EXPECT_NEAR(image.find("P.Z")->values[middle], 3.0, 5e-2);
}

// K (R X + t) of the file, for all positions of the picture.
TEST_F(Cameras, TheFileProjectsEachPositionToItsPixel) {
    write("opencv.json",
          R"({"width": 60, "height": 40, "cameras": [{"name": "far", "K": [[70, 0, 20], [0, 90, 25],
        [0, 0, 1]], "R": [[0, 0, -1], [0, -1, 0], [-1, 0, 0]], "t": [3, 2, 5]}, {"name": "near", "K": [[70, 0, 20],
        [0, 90, 25], [0, 0, 1]], "R": [[0.8, 0, -0.6], [0, -1, 0], [-0.6, 0, -0.8]], "t": [1, 1.9, 5]}]})");
    const Image image = image_of({"--camera-file", file("opencv.json"), "--camera", "near"});
    ASSERT_EQ(image.full, uvec2(60, 40));
    size_t hits = 0;
    for (uint32_t i = 0; i < 60 * 40; ++i) {
        const double depth = image.find("Z")->values[i];
        if (std::isinf(depth)) continue;
        ++hits;
        const double x = image.find("P.X")->values[i], y = image.find("P.Y")->values[i],
                     z = image.find("P.Z")->values[i];
        const double forwards = -0.6 * x - 0.8 * z + 5.0;
        EXPECT_NEAR(70.0 * (0.8 * x - 0.6 * z + 1.0) / forwards + 20.0, i % 60, 1e-3);
        EXPECT_NEAR(90.0 * (-y + 1.9) / forwards + 25.0, i / 60, 1e-3);
        EXPECT_NEAR(forwards, depth, 1e-5);
    }
    EXPECT_GT(hits, 100u);
}

TEST_F(Cameras, AWrittenFileGivesTheSamePicture) {
    const Image first =
        image_of({"--view", "20,30,40", "--size", "40x20", "--write-cameras", file("transforms.json")});
    const Image again = image_of({"--camera-file", file("transforms.json"), "--camera", "a"});
    EXPECT_EQ(first.full, again.full);
    // Bits may differ, since the field of view is rounded once more.
    for (size_t i = 0; i < first.pixel_count(); ++i) {
        const float was = first.find("Z")->values[i], is = again.find("Z")->values[i];
        if (!std::isinf(was) && !std::isinf(is)) {
            EXPECT_NEAR(was, is, 1e-3);
        }
    }
    EXPECT_EQ(seen(first), seen(again));
}

TEST_F(Cameras, EveryViewHasAPicture) {
    const Image alone = image_of({"--turntable", "3", "--camera", "turntable_002"});
    const ProcessResult result =
        candela({"render", sphere(), "--spp", "1", "--turntable", "3", "-o", file("{camera}.exr"), "--quiet",
                 "--write-cameras", file("transforms.json")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(read_exr(file("turntable_002.exr")).find("Z")->values, alone.find("Z")->values);
    const auto written = nlohmann::json::parse(read_file(file("transforms.json")));
    ASSERT_EQ(written.at("frames").size(), 3u);
    EXPECT_EQ(written.at("frames").at(1).at("file_path"), "turntable_001.exr");
}

TEST_F(Cameras, WhatCannotBeIsRefused) {
    const auto error = [&](const Words& arguments, const std::string& message) {
        const ProcessResult result = refused(arguments);
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_CONTAINS(result.err, message);
    };
    error({"--lens", "40"},
          "--lens: only cameras around the scene have it; also give --view, --turntable or --dome");
    error({"--margin", "0"}, "--margin: only cameras around the scene have it");
    error({"--turntable", "3"}, "would be the picture of each camera; add the field {camera} or {view}");
    error({"--write-cameras", file("{cam}.json")},
          "--write-cameras: \"" + file("{cam}.json") + "\" has the unknown field {cam}; the fields are ");
    error({"--write-cameras", file("{camera}.json")},
          "is one file for all pictures of a scene; leave {camera} and {view} out");
    error({"--view", "1,2", "--view", "3,4", "--camera", "main"},
          "--camera: unknown camera \"main\" (defined: 1,2, 3,4)");
    error({"--view", "1,2", "--camera-file", "f.json"}, "--camera-file");
    error({"--camera-file", file("a.exr")}, "is the same file as -o");
    const ProcessResult lost = refused({"--write-cameras", file("none/f.json")});
    EXPECT_EQ(lost.exit_code, 1);
    EXPECT_CONTAINS(lost.err, "none\" does not exist");
    const ProcessResult bad = refused({"--camera-file", write("bad.json", "{\"frames\": [NaN]}")});
    EXPECT_EQ(bad.exit_code, 1);
    EXPECT_CONTAINS(bad.err, "bad.json:1:13: ");
}

}  // namespace
}  // namespace candela
