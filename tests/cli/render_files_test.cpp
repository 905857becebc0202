// What `candela render` writes: images with attributes, reports, the cache; and what it never destroys.
#include <cmath>
#include <iomanip>
#include <sstream>
#include <variant>

#include "base/hash.h"
#include "cli/cli_fixture.h"

namespace candela {
namespace {

class RenderFiles : public CliTest {};

TEST_F(RenderFiles, AttributesTellHowTheImageWasMade) {
    const std::string output = file("two words.exr");
    ASSERT_EQ(render({"-o", output, "--seed", "7"}).exit_code, 0);
    const auto attributes = read_exr(output).attributes;
    const auto text = [&](const char* name) { return std::get<std::string>(attributes.at(name)); };
    EXPECT_EQ(std::get<float>(attributes.at("samplesPerPixel")), 4.0f);
    EXPECT_GT(std::get<float>(attributes.at("renderTimeSeconds")), 0.0f);
    EXPECT_EQ(text("candela.version"), "0.1.0");
    EXPECT_EQ(text("candela.seed"), "7");
    EXPECT_EQ(text("candela.samples"), "0..4");
    EXPECT_EQ(text("candela.sampler"), "sobol");
    EXPECT_EQ(text("candela.estimator"), "mis");
    EXPECT_EQ(text("candela.maxDepth"), "4096");
    EXPECT_EQ(text("candela.rrDepth"), "3");
    EXPECT_EQ(text("candela.camera").rfind("at 0.278 0.273 -0.8 ", 0), 0u) << text("candela.camera");
    EXPECT_EQ(text("candela.identity").size(), 16u);
    EXPECT_NE(text("candela.device"), "");
    EXPECT_NE(text("candela.driver"), "");
    EXPECT_EQ(text("candela.commandLine"), tested_program() + " render " + CORNELL_BOX +
                                               " --size 32x32 --spp 4 -o '" + output + "' --seed 7");
}

// The matrices in the image's attributes project its positions to their own pixels and depths. `point`: the
// principal point [pixels].
void expect_matrices_agree(const Image& image, vec2 point) {
    const mat4 camera = std::get<mat4>(image.attributes.at("worldToCamera"));
    const mat4 ndc = std::get<mat4>(image.attributes.at("worldToNDC"));
    size_t hits = 0;
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        const float depth = image.find("Z")->values[i];
        if (std::isinf(depth)) continue;
        ++hits;
        const vec4 p(image.find("P.X")->values[i], image.find("P.Y")->values[i], image.find("P.Z")->values[i],
                     1);
        const vec4 projected = ndc * p;
        EXPECT_NEAR(projected.x / projected.w, (float(i % 40) + 0.5f) / 40, 1e-4f);
        EXPECT_NEAR(projected.y / projected.w, (float(i / 40) + 0.5f) / 24, 1e-4f);
        EXPECT_NEAR((camera * p).z, depth, 1e-4f * depth);
        // Left-handed: x is positive to the right of the axis, y above it.
        EXPECT_EQ((camera * p).x > 0, float(i % 40) >= point.x);
        EXPECT_EQ((camera * p).y > 0, float(i / 40) < point.y);
    }
    EXPECT_GT(hits, 100u);
}

TEST_F(RenderFiles, CameraMatricesAgreeWithThePositions) {
    const std::string shifted = write("shifted.json", R"({
        "cameras": {"main": {"position": [0, 0, 4], "look_at": [0.1, 0, 0], "film_size": [400, 240],
                             "focal_length": [400, 300], "principal_point": [150, 130]}},
        "film": {"size": [40, 24]}, "materials": {"white": {"type": "diffuse", "reflectance": 0.5}},
        "shapes": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "white"}]})");
    const vec2 middle(20, 12);
    for (const auto& [scene, point] :
         {std::pair(MESH, middle),
          std::pair(std::string(CANDELA_SCENES "/../tests/references/orthographic.json"), middle),
          std::pair(shifted, vec2(15, 13))}) {
        SCOPED_TRACE(scene);
        ASSERT_EQ(candela({"render", scene, "-o", file("a.exr"), "--size", "40x24", "--spp", "1"}).exit_code,
                  0);
        expect_matrices_agree(read_exr(file("a.exr")), point);
    }
}

TEST_F(RenderFiles, ReportHasEveryField) {
    ASSERT_EQ(render({"-o", file("a.exr"), "--seed", "3", "--report", file("r.json")}).exit_code, 0);
    const auto report = nlohmann::json::parse(read_file(file("r.json")));
    EXPECT_EQ(report["version"], "0.1.0");
    EXPECT_EQ(report["scene"], CORNELL_BOX);
    EXPECT_NE(report["device"], "");
    EXPECT_NE(report["driver"], "");
    EXPECT_EQ(report["width"], 32);
    EXPECT_EQ(report["height"], 32);
    EXPECT_EQ(report["crop"], (std::vector<int>{0, 0, 32, 32}));
    EXPECT_EQ(report["spp"], 4);
    EXPECT_EQ(report["samples"], "0..4");
    EXPECT_EQ(report["rendered_samples"], 32 * 32 * 4);
    EXPECT_EQ(report["device_failures"], 0);
    EXPECT_EQ(report["complete"], true);
    EXPECT_EQ(report["seed"], 3);
    EXPECT_EQ(report["estimator"], "mis");
    EXPECT_EQ(report["sampler"], "sobol");
    EXPECT_EQ(report["light_sampler"], "power");  // A single light is not chosen.
    EXPECT_EQ(report["max_depth"], 4096);
    EXPECT_EQ(report["rr_depth"], 3);
    EXPECT_EQ(report["primitives"], 32);
    EXPECT_EQ(report["lights"], 1);
    for (const char* time :
         {"load_seconds", "bvh_seconds", "pipeline_seconds", "render_seconds", "cpu_seconds"}) {
        EXPECT_GT(report[time], 0.0) << time;
    }
    for (const char* part : {"scene", "kernels", "host", "develop", "encode"})
        EXPECT_GT(report["overhead_cpu_seconds"][part], 0.0) << part;
    const double rate = report["samples_per_second"];
    EXPECT_NEAR(rate * double(report["render_seconds"]), 32 * 32 * 4, 1e-6);
    EXPECT_GT(report["rays_per_sample"], 1.0);
    EXPECT_GT(report["device_bytes"], 32 * 32 * 16 * 8);
    EXPECT_EQ(report["nonfinite_samples"], 0);
    EXPECT_EQ(report["depth_limit_hits"], 0);
    EXPECT_EQ(report["validation_messages"], 0);
}

TEST_F(RenderFiles, ImageHashIsFnvOfTheMeans) {
    const ProcessResult result = render({"-o", file("a.exr"), "--report", "-", "--quiet"});
    ASSERT_EQ(result.exit_code, 0);
    const Image image = read_exr(file("a.exr"));
    const RgbPlanes rgb = *image.find_rgb();
    uint64_t hash = FNV1A64_BASIS;
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        for (const auto& plane : rgb)
            hash = fnv1a64(std::as_bytes(plane.subspan(i, 1)), hash);
    }
    std::ostringstream text;
    text << std::hex << std::setw(16) << std::setfill('0') << hash;
    EXPECT_EQ(nlohmann::json::parse(result.out)["image_hash"], text.str());
}

TEST_F(RenderFiles, SceneWithoutLightIsAWarning) {
    const std::string scene = write("dark.json", R"({
        "cameras": { "main": { "position": [0, 0, 1], "look_at": [0, 0, 0], "vertical_fov": 40 } },
        "materials": { "grey": { "type": "diffuse", "reflectance": 0.5 } },
        "shapes": [ { "type": "box", "min": [-1, -1, -1], "max": [1, 1, 0], "material": "grey" } ] })");
    const ProcessResult result =
        candela({"render", scene, "-o", file("a.exr"), "--size", "8x8", "--spp", "1", "--quiet"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err.rfind("candela: warning: " + scene + ":", 0), 0u) << result.err;
    EXPECT_CONTAINS(result.err, "the scene has no light");
    const Image image = read_exr(file("a.exr"));
    for (const float value : image.find("G")->values)
        ASSERT_EQ(value, 0.0f);
}

// The camera looks into a light whose square is beyond the largest float.
TEST_F(RenderFiles, SamplesThatAreNotFiniteAreAWarning) {
    const std::string scene = write("glare.json", R"({
        "cameras": { "main": { "position": [0, 0, 1], "look_at": [0, 0, 0], "vertical_fov": 40 } },
        "shapes": [ { "type": "quad", "vertices": [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]],
                      "emission": 1e30 } ] })");
    const ProcessResult result =
        candela({"render", scene, "-o", file("a.exr"), "--size", "8x8", "--spp", "2", "--quiet"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "candela: warning: 128 sample(s) were not finite; they are treated as black\n");
}

TEST_F(RenderFiles, FailedRunsLeaveOldFilesAlone) {
    for (const Words& cause :
         std::vector<Words>{{"--camera", "none"}, {"--device", "none"}, {"--size", "65536x65536"}}) {
        write("a.exr", "old");
        EXPECT_NE(candela(Words{"render", CORNELL_BOX, "-o", file("a.exr")} + cause).exit_code, 0);
        EXPECT_EQ(read_file(file("a.exr")), "old");
        EXPECT_EQ(directory_.size(), 1) << "a temporary file was left behind";
    }
}

TEST_F(RenderFiles, TooLargeAPictureSaysWhatItNeeds) {
    // 2^32 pixels of 8 layers and a position, at 16 bytes each.
    const ProcessResult result =
        candela({"render", CORNELL_BOX, "-o", file("a.exr"), "--size", "65536x65536"});
    EXPECT_EQ(result.exit_code, 5);
    EXPECT_CONTAINS(result.err, "576.00 GiB");
    EXPECT_CONTAINS(result.err, "use a smaller picture (--size, --crop) or scene");
}

TEST_F(RenderFiles, CompiledKernelsAreKeptWhereXdgSays) {
    const Words arguments = {"render", CORNELL_BOX, "--size", "8x8", "--spp", "1", "-o", file("a.png")};
    const auto files_in = [this](const char* folder) {
        return std::distance(std::filesystem::directory_iterator(file(folder)), {});
    };
    EXPECT_EQ(candela(arguments, {{"XDG_CACHE_HOME", file("no")}, {"CANDELA_NO_CACHE", "1"}}).exit_code, 0);
    EXPECT_FALSE(std::filesystem::exists(file("no/candela")));
    EXPECT_EQ(candela(arguments, {{"XDG_CACHE_HOME", file("xdg")}}).exit_code, 0);
    EXPECT_EQ(files_in("xdg/candela"), 1);
    EXPECT_EQ(candela(arguments, {{"XDG_CACHE_HOME", ""}, {"HOME", file("home")}}).exit_code, 0);
    EXPECT_EQ(files_in("home/.cache/candela"), 1);
}

}  // namespace
}  // namespace candela
