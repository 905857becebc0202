// The layer of motion: where what pixels show was in the frame before.
#include <cmath>
#include <numbers>

#include "cli/cli_fixture.h"
#include "unit/load/gltf/moving_file.h"

namespace candela {
namespace {

using glm::dvec2;

constexpr double WIDTH = 48, HEIGHT = 32;
// Of the camera of eye_file(): half of its view, as the tangent of an angle, and of parallel rays [m].
constexpr double HALF = 0.75, HALF_PARALLEL = 2.5;

// A camera, where eye_file() has it at a time [s].
struct Eye {
    explicit Eye(double time)
        : position(0.5 * time, 0.25 * time, 4.0 - 0.5 * time), angle(glm::radians(30.0 * time)) {}

    // A direction of the world, in the axes of the camera; and back.
    dvec3 local(dvec3 d) const { return turned(d, -angle); }
    dvec3 world(dvec3 d) const { return turned(d, angle); }

    dvec3 position;
    double angle;  // About +y.

  private:
    static dvec3 turned(dvec3 d, double angle) {
        return {std::cos(angle) * d.x + std::sin(angle) * d.z, d.y,
                std::cos(angle) * d.z - std::sin(angle) * d.x};
    }
};

// A square of 6 m, which does not move, and a camera that does, from 0 s to 1 s.
GltfFile eye_file(bool is_parallel) {
    GltfFile file;
    file.show(
        {{"attributes", {{"POSITION", file.add<float>("VEC3", {-3, -3, 0, 3, -3, 0, 3, 3, 0, -3, 3, 0})}}},
         {"indices", file.add<uint16_t>("SCALAR", {0, 1, 2, 0, 2, 3})}});
    const Json parallel = {{"type", "orthographic"},
                           {"orthographic",
                            {{"xmag", HALF_PARALLEL * WIDTH / HEIGHT},
                             {"ymag", HALF_PARALLEL},
                             {"znear", 0.01},
                             {"zfar", 100}}}};
    const Json perspective = {{"type", "perspective"},
                              {"perspective", {{"yfov", 2.0 * std::atan(HALF)}, {"znear", 0.01}}}};
    file.push("cameras", is_parallel ? parallel : perspective);
    const size_t eye = file.push("nodes", {{"camera", 0}});
    file.push("scenes", {{"nodes", {0, eye}}});
    const size_t times = file.add<float>("SCALAR", {0, 1});
    const float half = float(glm::radians(15.0));
    const size_t places = file.add<float>("VEC3", {0, 0, 4, 0.5f, 0.25f, 3.5f});
    const size_t turns = file.add<float>("VEC4", {0, 0, 0, 1, 0, std::sin(half), 0, std::cos(half)});
    file.push("animations",
              {{"samplers", {{{"input", times}, {"output", places}}, {{"input", times}, {"output", turns}}}},
               {"channels",
                {{{"sampler", 0}, {"target", {{"node", eye}, {"path", "translation"}}}},
                 {{"sampler", 1}, {"target", {{"node", eye}, {"path", "rotation"}}}}}}});
    return file;
}

// Places, in pixels to the right of the picture's middle and below it, of a point in the axes of a camera.

dvec2 in_perspective(dvec3 p) {
    return HEIGHT / 2 / HALF / -p.z * dvec2(p.x, -p.y);
}

dvec2 in_parallel(dvec3 p) {
    return HEIGHT / 2 / HALF_PARALLEL * dvec2(p.x, -p.y);
}

dvec2 all_around(dvec3 p) {
    return {WIDTH * std::atan2(p.x, -p.z) / (2 * std::numbers::pi),
            -HEIGHT * std::asin(p.y / length(p)) / std::numbers::pi};
}

dvec2 in_circle(dvec3 p, double radius) {
    return HEIGHT / 2 * radius / std::hypot(p.x, p.y) * dvec2(p.x, -p.y);
}

double angle_to_axis(dvec3 p) {
    return std::acos(-p.z / length(p));
}

// Of an angle of 220 degrees.
dvec2 by_fisheye(dvec3 p) {
    return in_circle(p, angle_to_axis(p) / glm::radians(110.0));
}

dvec2 by_equisolid(dvec3 p) {
    return in_circle(p, std::sin(angle_to_axis(p) / 2) / std::sin(glm::radians(55.0)));
}

class MotionLayer : public CliTest {
  protected:
    // Renders m.glb at 4 frames a second.
    void render_file(const Words& arguments) const {
        const ProcessResult result = candela(Words{"render", file("m.glb"), "--size", "48x32", "--fps", "4",
                                                   "--quiet", "--aov", "p,z,motion"} +
                                                 arguments,
                                             {{"CANDELA_VALIDATION", "0"}});
        EXPECT_EQ(result.exit_code, 0) << result.err;
    }
    // The layers of such a picture.
    Image layers(const Words& arguments) const {
        render_file(Words{"-o", file("a.exr")} + arguments);
        return read_exr(file("a.exr"));
    }
};

struct ShownPixel {
    dvec2 centre;  // From the middle of the picture, to the right and down.
    dvec3 p;
    bool is_hit;
    dvec2 motion;
};

std::vector<ShownPixel> pixels_of(const Image& image) {
    const auto at = [&](const char* channel, size_t i) { return double(image.find(channel)->values[i]); };
    std::vector<ShownPixel> pixels;
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        pixels.push_back(
            {.centre = dvec2(double(i % 48) + 0.5 - WIDTH / 2, double(i / 48) + 0.5 - HEIGHT / 2),
             .p = {at("P.X", i), at("P.Y", i), at("P.Z", i)},
             .is_hit = std::isfinite(at("Z", i)),
             .motion = {at("Motion.X", i), at("Motion.Y", i)}});
    }
    return pixels;
}

// Positions of floats are off by 2^-22 m, and a metre has at most 10 pixels. A ray's direction has rounded a
// few times more, up to 40 pixels from the middle.
constexpr double TOLERANCE = 1e-5, RAY_TOLERANCE = 1e-4;

// A case: how the camera projects, and what the camera that has not been shifted shows in the middle.
struct CameraCase {
    const char* name;
    Words options;
    bool is_parallel;
    dvec2 (*place)(dvec3);
    dvec2 shift;  // Of the picture's contents [pixels].
};

class MotionOfACamera : public MotionLayer, public testing::WithParamInterface<CameraCase> {};

TEST_P(MotionOfACamera, IsItsDifferenceOfTwoProjections) {
    const CameraCase& c = GetParam();
    write("m.glb", eye_file(c.is_parallel).glb());
    const Image image = layers(Words{"--frames", "2"} + c.options);
    const Eye now(0.5), before(0.25);
    size_t hits = 0;
    for (const ShownPixel& pixel : pixels_of(image)) {
        if (!pixel.is_hit) continue;
        ++hits;
        // What the pixel shows is at its centre.
        const dvec2 to = c.place(now.local(pixel.p - now.position)) + c.shift;
        EXPECT_NEAR(length(to - pixel.centre), 0.0, RAY_TOLERANCE);
        const dvec2 from = c.place(before.local(pixel.p - before.position)) + c.shift;
        EXPECT_NEAR(length(to - from - pixel.motion), 0.0, TOLERANCE);
        EXPECT_GT(length(pixel.motion), 0.1);
    }
    EXPECT_GT(hits, 100u);
}

INSTANTIATE_TEST_SUITE_P(
    All, MotionOfACamera,
    testing::Values(
        CameraCase{"Perspective", {}, false, in_perspective, dvec2(0)},
        // In longer sides, to the right and upwards.
        CameraCase{"Shifted", {"--shift", "0.25,0.125"}, false, in_perspective, dvec2(-12, 6)},
        CameraCase{"Orthographic", {}, true, in_parallel, dvec2(0)},
        CameraCase{"Equirectangular", {"--projection", "equirectangular"}, false, all_around, dvec2(0)},
        CameraCase{"Fisheye", {"--projection", "fisheye,220"}, false, by_fisheye, dvec2(0)},
        CameraCase{"ShiftedFisheye",
                   {"--projection", "fisheye,220", "--shift", "0.25,0.125"},
                   false,
                   by_fisheye,
                   dvec2(-12, 6)},
        CameraCase{"Equisolid", {"--projection", "equisolid,220"}, false, by_equisolid, dvec2(0)}),
    [](const auto& each) { return each.param.name; });

// The camera turns by 7.5 degrees to the left, so all that is infinitely far moves to the right.
TEST_F(MotionLayer, OfTheSkyIsThatOfTheCamerasTurning) {
    write("m.glb", eye_file(false).glb());
    const Eye now(0.5), before(0.25);
    size_t misses = 0;
    for (const ShownPixel& pixel : pixels_of(layers({"--frames", "2", "--projection", "equirectangular"}))) {
        if (pixel.is_hit) continue;
        ++misses;
        EXPECT_NEAR(pixel.motion.x, WIDTH * 7.5 / 360.0, TOLERANCE);
        EXPECT_NEAR(pixel.motion.y, 0.0, TOLERANCE);
    }
    EXPECT_GT(misses, 500u) << "also behind the camera, where the picture's edges are";
    misses = 0;
    for (const ShownPixel& pixel : pixels_of(layers({"--frames", "2", "--shift", "1,0"}))) {
        if (pixel.is_hit) continue;
        ++misses;
        const dvec2 s = (pixel.centre + dvec2(48, 0)) * (HALF * 2 / HEIGHT);
        const dvec2 from = in_perspective(before.local(now.world({s.x, -s.y, -1.0}))) - dvec2(48, 0);
        EXPECT_NEAR(length(pixel.centre - from - pixel.motion), 0.0, TOLERANCE);
    }
    EXPECT_GT(misses, 100u);
    misses = 0;
    for (const ShownPixel& pixel : pixels_of(layers({"--frames", "2", "--projection", "fisheye,220"}))) {
        if (length(pixel.centre) <= HEIGHT / 2) continue;
        ++misses;
        EXPECT_EQ(pixel.motion, dvec2(0.0)) << "outside of the circle";
    }
    EXPECT_GT(misses, 100u);
    write("m.glb", eye_file(true).glb());
    misses = 0;
    for (const ShownPixel& pixel : pixels_of(layers({"--frames", "2"}))) {
        if (pixel.is_hit) continue;
        ++misses;
        EXPECT_EQ(pixel.motion, dvec2(0.0)) << "parallel rays see it everywhere";
    }
    EXPECT_GT(misses, 10u);
}

// What was behind the camera was nowhere in its picture.
TEST_F(MotionLayer, OfWhatWasBehindTheCameraIsInfinite) {
    GltfFile file = eye_file(false);
    file.root["animations"][0]["samplers"][0]["output"] = file.add<float>("VEC3", {0, 0, -1, 0, 0, 4});
    file.root["animations"][0]["samplers"][0]["interpolation"] = "STEP";
    file.root["animations"][0]["channels"].erase(1);  // It does not turn.
    write("m.glb", file.glb());
    size_t hits = 0;
    for (const ShownPixel& pixel : pixels_of(layers({"--frames", "4"}))) {
        if (pixel.is_hit) {
            ++hits;
            EXPECT_TRUE(std::isinf(pixel.motion.x) && std::isinf(pixel.motion.y));
        } else {
            EXPECT_TRUE(std::isfinite(pixel.motion.x) && std::isfinite(pixel.motion.y));
        }
    }
    EXPECT_GT(hits, 100u);
}

// The triangle follows a joint with one corner, which turns by 90 degrees in a second about (1, 0.5); nothing
// else is shown. Each point of the triangle keeps its barycentric coordinates.
TEST_F(MotionLayer, OfASkinnedTriangleFollowsItsCorners) {
    GltfFile file = moving_file();
    for (const char* other : {"still", "spin", "morph", "pop", ""}) {
        for (Json& node : file.root["nodes"]) {
            if (node.value("name", "") == other) node.erase("mesh");
        }
    }
    write("m.glb", file.glb());
    const auto tip_at = [](double time) {
        const double angle = glm::radians(90.0 * time);
        return dvec2(1.0 - std::sin(angle), 0.5 + std::cos(angle));
    };
    // The eye of the file moves by 1 m a second to the right, 5 m away.
    const auto place = [](dvec2 p, double time) {
        return HEIGHT / 2 / std::tan(0.4) / 5.0 * dvec2(p.x - time, -p.y);
    };
    size_t hits = 0;
    for (const ShownPixel& pixel : pixels_of(layers({"--frames", "2"}))) {
        if (!pixel.is_hit) continue;
        ++hits;
        // The corners are (1, 0), (2, 0) and the tip.
        const dvec2 now = tip_at(0.5), before = tip_at(0.25);
        const double y = pixel.p.y / now.y, x = pixel.p.x - 1.0 - y * (now.x - 1.0);
        const dvec2 from = dvec2(1, 0) + x * dvec2(1, 0) + y * (before - dvec2(1, 0));
        const dvec2 expected = place(dvec2(pixel.p), 0.5) - place(from, 0.25);
        EXPECT_NEAR(length(pixel.motion - expected), 0.0, TOLERANCE);
        EXPECT_GT(std::abs(pixel.motion.y) + std::abs(pixel.motion.x + 0.25 * 7.57), 1e-3);
    }
    EXPECT_GT(hits, 20u);
}

// Before the first key and after the last one nothing moves, though all that can is shown.
TEST_F(MotionLayer, OfWhatIsStillIsZero) {
    write("m.glb", moving_file().glb());
    for (const char* frame : {"0", "9"}) {
        size_t hits = 0;
        for (const ShownPixel& pixel : pixels_of(layers({"--frames", frame}))) {
            hits += pixel.is_hit;
            EXPECT_EQ(pixel.motion, dvec2(0.0));
        }
        EXPECT_GT(hits, 100u);
    }
}

void expect_equal(const Image& a, const Image& b) {
    for (const char* channel : {"Motion.X", "Motion.Y"})
        EXPECT_EQ(a.find(channel)->values, b.find(channel)->values) << channel;
}

TEST_F(MotionLayer, HasTheSameBitsAloneInARangeInACropAndInParts) {
    write("m.glb", moving_file().glb());
    render_file({"--frames", "3,0,2", "-o", file("{frame}.exr")});
    const Image image = read_exr(file("2.exr"));
    expect_equal(layers({"--frames", "2"}), image);
    const Image crop = layers({"--frames", "2", "--crop", "10,5,31,27"});
    for (const char* channel : {"Motion.X", "Motion.Y"}) {
        std::vector<float> part;
        for (size_t y = 5; y < 27; ++y) {
            const auto row = image.find(channel)->values.begin() + long(48 * y);
            part.insert(part.end(), row + 10, row + 31);
        }
        EXPECT_EQ(crop.find(channel)->values, part);
    }
    // Samples replace those of --spp.
    for (const auto& [samples, name] : {std::pair("0..1", "p0.exr"), std::pair("1..3", "p1.exr")})
        render_file({"--frames", "2", "--samples", samples, "-o", file(name)});
    const ProcessResult merged =
        candela({"merge", file("p1.exr"), file("p0.exr"), "-o", file("merged.exr")}, NO_DRIVER);
    EXPECT_EQ(merged.exit_code, 0) << merged.err;
    expect_equal(read_exr(file("merged.exr")), image);
}

TEST_F(MotionLayer, NeedsFrames) {
    write("m.glb", moving_file().glb());
    const ProcessResult result =
        candela({"render", file("m.glb"), "-o", file("a.exr"), "--aov", "motion"}, NO_DRIVER);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_CONTAINS(result.err,
                    "candela: error: --aov: motion is that since the frame before; also give --frames\n");
}

}  // namespace
}  // namespace candela
