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

// A quarter of the width to the right, an eighth of it upwards: what was there moves into the middle.
TEST_F(Cameras, AShiftMovesThePicture) {
    const std::string cameras =
        write("opencv.json", R"({"cameras": [{"name": "front", "width": 48, "height": 32,
        "K": [[60, 0, 23.5], [0, 60, 15.5], [0, 0, 1]], "R": [[1, 0, 0], [0, -1, 0], [0, 0, -1]],
        "t": [-1, 2, 7]}]})");
    const PixelRect plain = seen(image_of({"--camera-file", cameras}));
    EXPECT_EQ(plain, (PixelRect{16, 8, 32, 24}));
    EXPECT_EQ(seen(image_of({"--camera-file", cameras, "--shift", "0.25,0.125"})),
              (PixelRect{4, 14, 20, 30}));
    EXPECT_EQ(seen(image_of({"--camera-file", cameras, "--shift", "-0.25,-0.125"})),
              (PixelRect{28, 2, 44, 18}));
    // In a higher picture, the longer side is the height.
    EXPECT_EQ(seen(image_of({"--camera-file", cameras, "--size", "32x48", "--shift", "0,0"})),
              (PixelRect{5, 13, 27, 35}));
    EXPECT_EQ(seen(image_of({"--camera-file", cameras, "--size", "32x48", "--shift", "-0.0625,0.25"})),
              (PixelRect{8, 25, 30, 47}));
}

// The camera is at (0, 0, 9) and looks along -Z; the middle of the sphere is at (1, 2, 3).
TEST_F(Cameras, AProjectionReplacesTheCamerasOwn) {
    const double distance = std::sqrt(1 + 4 + 36);
    const auto expect_middle = [&](const std::string& projection, double x, double y) {
        const Image image = image_of({"--projection", projection, "--size", "256x128"});
        const auto [x0, y0, x1, y1] = seen(image);
        EXPECT_NEAR(0.5 * (x0 + x1), x, 1.0) << projection;
        EXPECT_NEAR(0.5 * (y0 + y1), y, 1.0) << projection;
        const float nearest = *std::ranges::min_element(image.find("Z")->values);
        EXPECT_NEAR(nearest, distance - 0.5, 0.02) << projection;  // Along the ray.
        EXPECT_FALSE(image.attributes.contains("worldToNDC"));
        EXPECT_TRUE(image.attributes.contains("worldToCamera"));
    };
    const double longitude = std::atan2(1.0, 6.0), latitude = std::asin(2.0 / distance);
    expect_middle("equirectangular", 128 + 256 * longitude / (2 * M_PI), 64 - 128 * latitude / M_PI);
    const double angle = std::acos(6.0 / distance), right = 1 / std::sqrt(5.0), up = 2 / std::sqrt(5.0);
    const double even = 64 * angle / (M_PI / 2), equisolid = 64 * std::sin(angle / 2) / std::sin(M_PI / 4);
    expect_middle("fisheye", 128 + right * even, 64 - up * even);
    expect_middle("fisheye,90", 128 + 2 * right * even, 64 - 2 * up * even);
    expect_middle("equisolid", 128 + right * equisolid, 64 - up * equisolid);
}

TEST_F(Cameras, ProjectionsThatCannotBeAreRefused) {
    const auto error = [&](const Words& arguments, const std::string& message) {
        const ProcessResult result = refused(arguments);
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_CONTAINS(result.err, message);
    };
    for (const char* text : {"fisheye,400", "fisheye,0", "fisheye,nan", "fisheye,", "fisheye,90,1",
                             "equirectangular,180", "cubic", ""}) {
        error({"--projection", text},
              "--projection: cannot use \"" + std::string(text) +
                  "\"; expected equirectangular, fisheye or equisolid; the last two also "
                  "with a comma and the full angle, from 1 to 360 degrees");
    }
    for (const char* text : {"1", "1,nan", "1,2,3"}) {
        error({"--shift", text},
              "--shift: cannot use \"" + std::string(text) + "\"; expected two numbers X,Y, such as 0,0.1");
    }
    error({"--shift", "0,1001"},
          "--shift: the shift is more than 1000 heights of the picture; it is in its longer "
          "sides, such as 0.1");
    const std::string placed =
        ": cameras around the scene are placed for a view in perspective without a shift; "
        "leave out --view, --turntable and --dome";
    error({"--projection", "fisheye", "--view", "0,0"}, "--projection" + placed);
    error({"--shift", "0,0", "--dome", "1"}, "--shift" + placed);
    error({"--shift", "0,0", "--projection", "equirectangular"},
          "--shift: the camera \"main\" is equirectangular; turn it instead");
    error({"--projection", "fisheye", "--write-cameras", file("f.json")},
          "cannot hold the fisheye camera \"main\"; give it a field of view, or choose another camera");
    const ProcessResult parallel = candela({"render", CANDELA_SCENES "/../tests/references/orthographic.json",
                                            "-o", file("a.exr"), "--shift", "0,0"},
                                           NO_DRIVER);
    EXPECT_EQ(parallel.exit_code, 2);
    EXPECT_CONTAINS(parallel.err, "is orthographic; move it instead");
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
