// Animations of glTF files: nodes between keys, and the choice of the animation.
// Ref: Khronos, "glTF 2.0 Specification", section 3.11 and appendix C.
#include <cmath>
#include <functional>
#include <limits>

#include "unit/load/gltf/gltf_fixture.h"

namespace candela {
namespace {

class GltfAnimation : public Gltf {
  protected:
    // A triangle in a node of which this key is animated.
    template <class T = float>
    static GltfFile animated(const char* path, const std::vector<float>& times, const char* interpolation,
                             const std::string& type, const std::vector<T>& values) {
        GltfFile file = corner_file();
        add_animation(file, path, times, interpolation, type, values);
        return file;
    }

    template <class T>
    static void add_animation(GltfFile& file, const char* path, const std::vector<float>& times,
                              const char* interpolation, const std::string& type,
                              const std::vector<T>& values, const Json& more = Json::object()) {
        const Json sampler = {{"input", file.add("SCALAR", times)},
                              {"output", file.add(type, values, {{"normalized", !std::is_same_v<T, float>}})},
                              {"interpolation", interpolation}};
        Json animation = {{"samplers", Json::array({sampler})},
                          {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}};
        animation.update(more);
        file.push("animations", animation);
    }

    std::vector<vec3> corners(const GltfFile& file, double time,
                              const std::optional<std::string>& animation = {}) {
        return world_mesh(load(file, {.animation = animation, .time = time})).positions;
    }

    // The first corner, which the node's translation moves from 0.
    void expect_place(const GltfFile& file, double time, dvec3 expected) {
        SCOPED_TRACE(time);
        // Keys are floats: times and values are off by a rounding, and the place is one.
        EXPECT_LE(distance(dvec3(corners(file, time)[0]), expected), 1e-6 * (1.0 + length(expected)));
    }
    // The second corner, which the node's rotation takes from +x to an angle about +z.
    void expect_angle(const GltfFile& file, double time, double degrees) {
        SCOPED_TRACE(time);
        const double angle = glm::radians(degrees);
        EXPECT_LE(distance(dvec3(corners(file, time)[1]), dvec3(std::cos(angle), std::sin(angle), 0.0)),
                  1e-6);
    }
};

TEST_F(GltfAnimation, StepsAndLinesBetweenKeys) {
    const std::vector<float> times{1, 2, 4}, places{1, 0, 0, 3, 10, 0, 7, 20, 4};
    const GltfFile step = animated("translation", times, "STEP", "VEC3", places);
    const GltfFile linear = animated("translation", times, "LINEAR", "VEC3", places);
    // Before the first key and after the last one, it stands still.
    for (const GltfFile& file : {step, linear}) {
        for (const double time : {-5.0, 0.0, 1.0})
            expect_place(file, time, dvec3(1, 0, 0));
        expect_place(file, 2.0, dvec3(3, 10, 0));
        for (const double time : {4.0, 4.5, 1e9})
            expect_place(file, time, dvec3(7, 20, 4));
    }
    expect_place(step, 1.75, dvec3(1, 0, 0));
    expect_place(step, 3.75, dvec3(3, 10, 0));
    expect_place(linear, 1.75, dvec3(2.5, 7.5, 0));
    expect_place(linear, 3.5, dvec3(6, 17.5, 3));
    // The moment of a key is that key's, though no float is 1/5: the nearest one is above it.
    expect_place(animated("translation", {0, 0.2f}, "STEP", "VEC3", std::vector<float>{1, 0, 0, 2, 0, 0}),
                 0.2, dvec3(2, 0, 0));
    // LINEAR unless it says otherwise; a single key holds for ever.
    GltfFile implied = linear;
    implied.root["animations"][0]["samplers"][0].erase("interpolation");
    expect_place(implied, 1.75, dvec3(2.5, 7.5, 0));
    for (const char* kind : {"STEP", "LINEAR"})
        expect_place(animated("translation", {3}, kind, "VEC3", std::vector<float>{1, 2, 3}), 2.0,
                     dvec3(1, 2, 3));
}

// A cubic Hermite spline is exact for cubic polynomials: one before the middle key and another one after it.
TEST_F(GltfAnimation, CubicSplinesFollowPolynomials) {
    struct Curve {
        std::function<dvec3(double)> value, slope;
    };
    const Curve first{
        [](double s) { return dvec3(2.0 - s + 3.0 * s * s - 0.5 * s * s * s, s * s * s, 1.0 - s); },
        [](double s) { return dvec3(-1.0 + 6.0 * s - 1.5 * s * s, 3.0 * s * s, -1.0); }};
    // (12.5, 27, -2) at 3, as the first, but with other slopes.
    const Curve second{[](double s) {
                           const double d = s - 3.0;
                           return dvec3(12.5 - 7.0 * d, 27.0 + d + 2.0 * d * d, -2.0 + 5.0 * d * d * d);
                       },
                       [](double s) {
                           const double d = s - 3.0;
                           return dvec3(-7.0, 1.0 + 4.0 * d, 15.0 * d * d);
                       }};
    std::vector<float> values;
    const auto add = [&](dvec3 v) { values.insert(values.end(), {float(v.x), float(v.y), float(v.z)}); };
    const dvec3 unused(1e6, -1e6, 1e6);  // Before the first key and after the last.
    for (const dvec3 v : {unused, first.value(1.0), first.slope(1.0), first.slope(3.0), first.value(3.0),
                          second.slope(3.0), second.slope(3.5), second.value(3.5), unused})
        add(v);
    const GltfFile file = animated("translation", {1, 3, 3.5f}, "CUBICSPLINE", "VEC3", values);
    for (double time = 1.0; time <= 3.5; time += 0.15625)
        expect_place(file, time, (time < 3.0 ? first : second).value(time));
    expect_place(file, 0.0, first.value(1.0));
    expect_place(file, 9.0, second.value(3.5));
}

TEST_F(GltfAnimation, RotationsTakeTheShorterArcAtConstantSpeed) {
    const auto about_z = [](double degrees, float sign = 1.0f) {
        const double half = glm::radians(degrees) / 2;
        return std::vector<float>{0, 0, sign * float(std::sin(half)), sign * float(std::cos(half))};
    };
    const auto both = [](std::vector<float> a, const std::vector<float>& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
    };
    for (const float sign : {1.0f, -1.0f}) {
        const GltfFile file =
            animated("rotation", {0, 3}, "LINEAR", "VEC4", both(about_z(0), about_z(120, sign)));
        expect_angle(file, 0.0, 0);
        expect_angle(file, 0.75, 30);
        expect_angle(file, 2.0, 80);
        expect_angle(file, 3.0, 120);
    }
    const GltfFile long_way = animated("rotation", {0, 1}, "LINEAR", "VEC4", both(about_z(10), about_z(350)));
    expect_angle(long_way, 0.25, 5);
    expect_angle(long_way, 0.75, -5);
    // Normalised integers; their lengths differ, their directions count.
    const GltfFile bytes =
        animated("rotation", {0, 1}, "LINEAR", "VEC4", std::vector<int8_t>{0, 0, 0, 127, 0, 0, 127, 127});
    expect_angle(bytes, 0.5, 45);
    expect_angle(bytes, 1.0, 90);
    // The components of a spline are not of unit length; with tangents of 0, the middle is the mean.
    std::vector<float> keys(24, 0.0f);
    std::ranges::copy(about_z(0), keys.begin() + 4);
    std::ranges::copy(about_z(120), keys.begin() + 16);
    const GltfFile spline = animated("rotation", {0, 1}, "CUBICSPLINE", "VEC4", keys);
    expect_angle(spline, 0.5, 60);
    // t = 1/4: weights 27/32 and 5/32 of quaternions with half angles of 0 and 60 degrees.
    const double x = 27.0 / 32.0 + 5.0 / 32.0 * 0.5, y = 5.0 / 32.0 * std::sqrt(0.75);
    expect_angle(spline, 0.25, 2.0 * glm::degrees(std::atan2(y, x)));
}

TEST_F(GltfAnimation, ScalesAndLeavesTheRestAsItIs) {
    GltfFile file = animated("scale", {0, 1}, "LINEAR", "VEC3", std::vector<float>{1, 1, 1, 3, 1, 1});
    file.root["nodes"][0]["translation"] = {0, 7, 0};
    EXPECT_EQ(corners(file, 0.5), (std::vector<vec3>{vec3(0, 7, 0), vec3(2, 7, 0), vec3(0, 8, 0)}));
    // Without a time, nodes are as they stand.
    EXPECT_EQ(world_mesh(load(file)).positions,
              (std::vector<vec3>{vec3(0, 7, 0), vec3(1, 7, 0), vec3(0, 8, 0)}));
}

TEST_F(GltfAnimation, PosesByTheAnimationsThatAreAskedFor) {
    GltfFile file = corner_file();
    add_animation(file, "translation", {0}, "STEP", "VEC3", std::vector<float>{5, 0, 0}, {{"name", "walk"}});
    add_animation(file, "scale", {0}, "STEP", "VEC3", std::vector<float>{2, 2, 2});
    EXPECT_EQ(corners(file, 0.0, "walk")[1], vec3(6, 0, 0));
    EXPECT_EQ(corners(file, 0.0, "0")[1], vec3(6, 0, 0));
    EXPECT_EQ(corners(file, 0.0, "1")[1], vec3(2, 0, 0));
    EXPECT_EQ(corners(file, 0.0, "all")[1], vec3(7, 0, 0));
    const Scene first = expect_warning(
        file, ": posed by the first animation, \"walk\", of 2; choose by --animation NAME, or all",
        {.time = 0.0});
    EXPECT_EQ(world_mesh(first).positions[1], vec3(6, 0, 0));
    expect_text_error(file.gltf(),
                      "--animation: m.gltf has nothing called \"run\" among its animations (known: walk, 1)",
                      "m.gltf", {.animation = "run", .time = 0.0});
    const std::string none = ": the file has no animations: --time has no effect";
    expect_warning(corner_file(), none, {.time = 1.0});
    expect_warning(corner_file(), none, {.animation = "all", .time = 1.0});
    expect_text_error(corner_file().gltf(),
                      "--animation: m.gltf has nothing called \"run\" among its animations (it has none)",
                      "m.gltf", {.animation = "run", .time = 1.0});
}

TEST_F(GltfAnimation, WhatItCannotAnimateIsNoted) {
    GltfFile file = animated("translation", {0}, "STEP", "VEC3", std::vector<float>{5, 0, 0});
    file.root["nodes"][0]["matrix"] = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1};
    const Scene scene = expect_warning(file,
                                       "#/animations/0/channels/0: the node has a matrix, which cannot be "
                                       "animated; the animation replaces it",
                                       {.time = 0.0});
    EXPECT_EQ(world_mesh(scene).positions[1], vec3(6, 0, 0));
    file = animated("pointer", {0}, "STEP", "VEC3", std::vector<float>{5, 0, 0});
    expect_warning(file, "#/animations/0/channels/0/target/path: ignored the unknown path \"pointer\"",
                   {.time = 0.0});
    file.root["animations"][0]["channels"][0]["target"].erase("node");
    EXPECT_TRUE(load(file, {.time = 0.0}).warnings.empty());
    file.root["animations"][0]["channels"][0]["target"]["extensions"]["KHR_animation_pointer"] = {
        {"pointer", "/materials/0/emissiveFactor"}};
    expect_warning(
        file,
        "#/animations/0/channels/0/target: ignored the targets of KHR_animation_pointer: only nodes and "
        "weights are animated",
        {.time = 0.0});
    EXPECT_TRUE(load(file).warnings.empty());
}

TEST_F(GltfAnimation, HidesAndShowsNodes) {
    const auto hiding = [](const char* interpolation, const std::string& pointer = "/nodes/0") {
        const std::vector<uint8_t> values = interpolation == std::string("CUBICSPLINE")
                                                ? std::vector<uint8_t>(9)
                                                : std::vector<uint8_t>{1, 0, 1};
        GltfFile file = animated("pointer", {0, 1, 2}, interpolation, "SCALAR", values);
        Json& target = file.root["animations"][0]["channels"][0]["target"];
        target.erase("node");
        target["extensions"]["KHR_animation_pointer"] = {
            {"pointer", pointer + "/extensions/KHR_node_visibility/visible"}};
        return file;
    };
    const auto shapes = [&](const GltfFile& file, double time) {
        return load(file, {.time = time}).shapes.size();
    };
    const GltfFile file = hiding("STEP");
    EXPECT_EQ(shapes(file, 0.9), 1u);
    EXPECT_EQ(shapes(file, 1.0), 0u);
    EXPECT_EQ(shapes(file, 1.9), 0u);
    EXPECT_EQ(shapes(file, 2.0), 1u);
    EXPECT_TRUE(load(file, {.time = 0.0}).warnings.empty());
    const std::string only = "a node is either visible or not, so the interpolation must be STEP";
    const Scene scene =
        expect_warning(hiding("LINEAR"), "#/animations/0/samplers/0: " + only + ", and is read as if it were",
                       {.time = 1.9});
    EXPECT_TRUE(scene.shapes.empty());
    expect_error(hiding("CUBICSPLINE"), "#/animations/0/samplers/0: " + only + "; export the file again",
                 {.time = 1.0});
    expect_error(
        hiding("STEP", "/nodes/1"),
        "#/animations/0/channels/0/target/extensions/KHR_animation_pointer/pointer: there are only 1 "
        "nodes; export the file again",
        {.time = 1.0});
    expect_warning(
        hiding("STEP", "/nodes/x"),
        "#/animations/0/channels/0/target: ignored the targets of KHR_animation_pointer: only nodes "
        "and weights are animated",
        {.time = 1.0});
}

TEST_F(GltfAnimation, NotesRotationsOfAnotherLength) {
    // The tangents of a spline may have any length.
    const std::vector<float> halves{9, 0, 0, 0, 0, 0, 0,    1,    0, 9, 0, 0,
                                    0, 0, 0, 0, 0, 0, 0.5f, 0.5f, 9, 9, 9, 9};
    const GltfFile file = animated("rotation", {0, 1}, "CUBICSPLINE", "VEC4", halves);
    const Scene scene = expect_warning(file,
                                       "#/animations/0/samplers/0/output: the rotation of key 1 is a "
                                       "quaternion whose length is not 1; all are normalised",
                                       {.time = 2.0});
    EXPECT_LE(distance(world_mesh(scene).positions[1], vec3(0, 1, 0)), 1e-6f);
    expect_warning(animated("rotation", {0}, "STEP", "VEC4", std::vector<float>{0, 0, 0, 0}),
                   "#/animations/0/samplers/0/output: the rotation of key 0 is a quaternion whose length is "
                   "not 1; all are normalised",
                   {.time = 0.0});
}

TEST_F(GltfAnimation, OfTwoChannelsWithOneTargetTheLastCounts) {
    GltfFile file = animated("translation", {0}, "STEP", "VEC3", std::vector<float>{5, 0, 0});
    Json& animation = file.root["animations"][0];
    const size_t times = file.add<float>("SCALAR", {0}), places = file.add<float>("VEC3", {7, 7, 7});
    animation["samplers"].push_back({{"input", times}, {"output", places}});
    animation["channels"].push_back({{"sampler", 1}, {"target", {{"node", 0}, {"path", "scale"}}}});
    EXPECT_TRUE(load(file, {.time = 0.0}).warnings.empty());
    animation["channels"][1]["target"]["path"] = "translation";
    const Scene scene = expect_warning(
        file, "#/animations/0/channels/0/target: channel 1 has the same target, and replaces this one",
        {.time = 0.0});
    EXPECT_EQ(world_mesh(scene).positions[0], vec3(7));
}

TEST_F(GltfAnimation, RefusesSamplersThatAreNoneOrDamaged) {
    const std::vector<float> places{1, 0, 0, 3, 10, 0};
    const auto expect = [&](const GltfFile& file, const std::string& message) {
        expect_error(file, "#/animations/0/" + message, {.time = 0.0});
    };
    const auto of_times = [&](const std::vector<float>& times) {
        return animated("translation", times, "STEP", "VEC3", places);
    };
    const std::string growing =
        "samplers/0/input: the times of an animation must grow, but that of key 1 does not";
    expect(of_times({1, 1}), growing);
    expect(of_times({1, 0.5f}), growing);
    expect(of_times({1, INFINITE}), growing);
    expect(of_times({1, std::numeric_limits<float>::quiet_NaN()}), growing);
    expect(of_times({1, 2, 3}), "samplers/0/output: there are 6 numbers for 3 keys; is the file damaged?");
    expect(animated("translation", {0, 1}, "CUBICSPLINE", "VEC3", places),
           "samplers/0/output: there are 6 numbers for 2 keys; is the file damaged?");
    expect(animated("weights", {0, 1, 2}, "STEP", "SCALAR", std::vector<float>{1, 2}),
           "samplers/0/output: there are 2 numbers for 3 keys; is the file damaged?");
    expect(animated("translation", {0, 1}, "STEP", "VEC3", std::vector<float>{1, 2, 3, INFINITE, 0, 0}),
           "samplers/0/output: a value of the animation is not finite; export it again");
    expect(animated("scale", {0, 1}, "SPLINE", "VEC3", places),
           "samplers/0/interpolation: unknown interpolation \"SPLINE\" (known: LINEAR, STEP, CUBICSPLINE)");
    GltfFile file = animated("rotation", {0, 1}, "STEP", "VEC3", places);
    expect_error(file, "#/accessors/2/type: \"type\": expected \"VEC4\" for what it is used, found \"VEC3\"",
                 {.time = 0.0});
    file = of_times({0, 1});
    Json& channel = file.root["animations"][0]["channels"][0];
    channel["sampler"] = 1;
    expect(file, "channels/0/sampler: the animation has only 1 samplers");
    channel["target"]["node"] = 1;
    expect(file,
           "channels/0/target/node: \"nodes\" has no element 1, only 0 to 0; name one that the file has");
    channel.erase("target");
    expect(file, "channels/0: the key \"target\" is missing here; add it");
    file.root["animations"][0].erase("channels");
    expect_error(file, "#/animations/0: the key \"channels\" is missing here; add it", {.time = 0.0});
}

}  // namespace
}  // namespace candela
