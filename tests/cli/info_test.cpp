// `candela info` and `candela devices`, and computers without a device.
#include "cli/cli_fixture.h"

namespace candela {
namespace {

class Info : public CliTest {};

TEST_F(Info, TellsWhatASceneHoldsWithoutADevice) {
    const ProcessResult result = candela({"info", CORNELL_BOX, "--json"}, NO_DRIVER);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto info = nlohmann::json::parse(result.out);
    EXPECT_EQ(info["scene"], CORNELL_BOX);
    EXPECT_EQ(info["primitives"], 32);
    EXPECT_EQ(info["lights"], 1);
    EXPECT_EQ(info["environment"], nullptr);
    EXPECT_EQ(info["cameras"], (std::vector<std::string>{"main"}));
    EXPECT_EQ(info["bounds"][0], (std::vector<double>{0, 0, 0}));
    EXPECT_NEAR(info["bounds"][1][2], 0.5592, 1e-6);
    EXPECT_GE(info["materials"], 3);
    EXPECT_GT(info["bvh_nodes"], 0);
    EXPECT_GT(info["bvh_depth"], 0);
    EXPECT_GT(info["bvh_sah_cost"], 0.0);
    EXPECT_GT(info["bvh_seconds"], 0.0);
    EXPECT_EQ(info["warnings"], nlohmann::json::array());
}

TEST_F(Info, BytesAreThoseOfTheReport) {
    for (const char* const crop : {"0,0,40,24", "8,8,40,24"}) {
        const Words picture = {"--size", "40x24", "--crop", crop};
        const ProcessResult result = candela(Words{"info", MESH, "--json"} + picture);
        const auto info = nlohmann::json::parse(result.out);
        uint64_t sum = 0;
        for (const auto& [part, bytes] : info["device_bytes_by_part"].items()) {
            if (part != "picture_without_aovs") sum += bytes.get<uint64_t>();
        }
        EXPECT_EQ(info["device_bytes"], sum);
        const auto report = report_of(picture + Words{"--spp", "1", "-o", file("a.exr")}, MESH);
        EXPECT_EQ(info["device_bytes"], report["device_bytes"]);
        EXPECT_EQ(info["primitives"], report["primitives"]);
        EXPECT_EQ(info["lights"], report["lights"]);
    }
}

TEST_F(Info, TextNamesTheSameFacts) {
    const ProcessResult result = candela({"info", MESH, "--size", "40x24"});
    EXPECT_EQ(result.exit_code, 0);
    for (const char* fact :
         {"main, close", "SAH cost", "depth", "40x24 pixels", "device memory", "without AOVs"}) {
        EXPECT_CONTAINS(result.out, fact);
    }
}

TEST_F(Info, TellsTheSizeOfTheSky) {
    Image sky{.full = {8, 4}, .data = {0, 0, 8, 4}, .channels = {}, .attributes = {}};
    for (const char* const channel : {"R", "G", "B"})
        sky.add(channel, 1.0f).values[0] = 2.0f;  // An even one would not be a light.
    write_exr(file("sky.exr"), sky);
    const std::string scene = write("sky.json", R"({
        "cameras": { "main": { "position": [0, 0, 3], "look_at": [0, 0, 0], "vertical_fov": 40 } },
        "materials": { "grey": { "type": "diffuse", "reflectance": 0.5 } },
        "shapes": [ { "type": "sphere", "radius": 1, "material": "grey" } ],
        "environment": { "file": "sky.exr" } })");
    const ProcessResult result = candela({"info", scene, "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto info = nlohmann::json::parse(result.out);
    EXPECT_EQ(info["environment"], (std::vector<int>{8, 4}));
    EXPECT_EQ(info["primitives"], 1);
    EXPECT_EQ(info["lights"], 1);
    EXPECT_CONTAINS(candela({"info", scene}).out, "environment   8x4 texels");
    EXPECT_CONTAINS(candela({"info", CORNELL_BOX}).out, "environment   none");
}

TEST_F(Info, NamesTheLightsThatNoSurfaceShows) {
    const std::string scene = CANDELA_SCENES "/../tests/references/punctual-lights.json";
    const auto info = nlohmann::json::parse(candela({"info", scene, "--json"}).out);
    EXPECT_EQ(info["lights"], 4);
    EXPECT_EQ(
        info["punctual_lights"],
        nlohmann::json::parse(R"([{"name": "point 1", "type": "point"}, {"name": "spot 2", "type": "spot"},
                                        {"name": "directional 3", "type": "directional"}])"));
    EXPECT_CONTAINS(candela({"info", scene}).out,
                    "lights        4: point 1 (point), spot 2 (spot), directional 3 (directional)");
    EXPECT_CONTAINS(candela({"info", CORNELL_BOX}).out, "lights        1\n");
}

TEST_F(Info, TellsWhatTexturesTakeAndMakesThemSmaller) {
    const std::string scene = CANDELA_SCENES "/../tests/references/textured-diffuse.json";
    const auto whole = nlohmann::json::parse(candela({"info", scene, "--json"}).out);
    const auto small = nlohmann::json::parse(candela({"info", scene, "--json", "--texture-limit", "4"}).out);
    for (const auto& image : small["images"]) {
        EXPECT_LE(image["width"], 4);
        EXPECT_LE(image["height"], 4);
    }
    EXPECT_GT(whole["images"][0]["width"], 4);
    EXPECT_LT(small["device_bytes_by_part"]["texels"], whole["device_bytes_by_part"]["texels"]);
    EXPECT_CONTAINS(candela({"info", scene}).out, "images        ");
    const ProcessResult wrong = candela({"info", scene, "--texture-limit", "0"});
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_CONTAINS(wrong.err, "--texture-limit: cannot use \"0\"; expected a whole number from 1 to 65535");
}

TEST_F(Info, AStudioLightsAFileAsIsAskedFor) {
    const std::string scene = write("node.gltf", R"({"asset": {"version": "2.0"}, "nodes": [{}]})");
    const auto environment = [&](const Words& options) {
        const ProcessResult result = candela(Words{"info", scene, "--json"} + options);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return nlohmann::json::parse(result.out)["environment"];
    };
    EXPECT_EQ(environment({}), (std::vector<int>{128, 64}));
    EXPECT_EQ(environment({"--studio", "default"}), (std::vector<int>{128, 64}));
    EXPECT_EQ(environment({"--studio", "off"}), nullptr);
    const ProcessResult wrong = candela({"info", scene, "--studio", "night"});
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_CONTAINS(
        wrong.err, "--studio: cannot use \"night\"; expected auto|off|default|softbox|white|overcast|sunset");
}

TEST_F(Info, MissingImagesAreAnErrorOnRequest) {
    write("m.mtl", "newmtl a\nmap_Kd no.png\n");
    const std::string scene = write("m.obj",
                                    "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\n"
                                    "f 1/1 2/1 3/1\n");
    const ProcessResult white = candela({"info", scene});
    EXPECT_EQ(white.exit_code, 0);
    EXPECT_CONTAINS(white.err, "no.png\" does not exist; white is used instead\n");
    const ProcessResult strict = candela({"info", scene, "--missing-images", "error"});
    EXPECT_EQ(strict.exit_code, 1);
    EXPECT_CONTAINS(strict.err, "no.png\": the file does not exist; check the name");
    EXPECT_CONTAINS(candela({"info", scene, "--missing-images", "x"}).err, "expected white|error");
}

TEST_F(Info, WarningsGoToStderrAndIntoTheJson) {
    const std::string scene = write("empty.json", R"({
        "cameras": { "main": { "position": [0, 0, 1], "look_at": [0, 0, 0], "vertical_fov": 40 } }, "shapes": [] })");
    const ProcessResult result = candela({"info", scene, "--json"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_CONTAINS(result.err, "candela: warning: ");
    const auto info = nlohmann::json::parse(result.out);
    EXPECT_EQ(info["warnings"].size(), 1u);
    EXPECT_EQ(info["bounds"], nullptr);
    EXPECT_CONTAINS(candela({"info", scene}).out, "bounds        none");
}

TEST_F(Info, ErrorsAreThoseOfRender) {
    EXPECT_EQ(candela({"info", file("missing.json")}).exit_code, 1);
    EXPECT_EQ(candela({"info", CORNELL_BOX, "--size", "64"}).exit_code, 2);
    EXPECT_EQ(candela({"info", CORNELL_BOX, "--crop", "0,0,513,1"}).exit_code, 2);
}

class Devices : public CliTest {};

TEST_F(Devices, OneIsTheDefaultAndDoesWhatItSays) {
    const ProcessResult result = candela({"devices", "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto devices = nlohmann::json::parse(result.out);
    size_t defaults = 0;
    for (const auto& device : devices) {
        EXPECT_EQ(device["usable"], device["reason"] == "");
        if (!device["default"]) continue;
        ++defaults;
        EXPECT_EQ(device["usable"], true);
        EXPECT_GE(device["limits"]["maxTexelBufferElements"], 65536);
        EXPECT_GE(device["limits"]["maxStorageBufferRange"], 1 << 27);
        EXPECT_GE(device["limits"]["maxImageDimension2D"], 4096);
        EXPECT_GE(device["limits"]["maxMemoryAllocationSize"], 1 << 30);
        EXPECT_GT(device["subgroup_size"], 0);
        const std::string name = device["name"];
        EXPECT_EQ(report_of({"--size", "8x8", "--spp", "1"})["device"], name);
        EXPECT_EQ(report_of({"--size", "8x8", "--spp", "1", "--device", name})["device"], name);
        EXPECT_EQ(report_of({"--size", "8x8", "--spp", "1", "--device", device["index"].dump()})["device"],
                  name);
        const std::string text = candela({"devices"}).out;
        EXPECT_CONTAINS(text, device["index"].dump() + ": " + name);
        EXPECT_CONTAINS(text, "used by default");
        EXPECT_CONTAINS(text, "maxTexelBufferElements");
    }
    EXPECT_EQ(defaults, 1u);
}

TEST_F(Devices, AnUnknownNameListsTheDevices) {
    const ProcessResult result = render({"-o", file("a.png"), "--device", "abacus"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_CONTAINS(result.err,
                    "no device matches \"abacus\"; give the index or a part of the name of one of: 0: \"");
}

TEST_F(Devices, NoDriverIsAnErrorWithARemedy) {
    for (const Words& arguments :
         std::vector<Words>{{"devices"}, {"render", CORNELL_BOX, "-o", file("a.png")}}) {
        const ProcessResult result = candela(arguments, NO_DRIVER);
        EXPECT_EQ(result.exit_code, 3);
        EXPECT_EQ(result.out, "");
        EXPECT_CONTAINS(result.err, "mesa-vulkan-drivers");
    }
}

// This happens where drivers are installed, and the hardware is not.
TEST_F(Devices, DriversWithoutADeviceAreAnErrorWithARemedy) {
    const ProcessResult result =
        candela({"devices"}, FAULT_LAYER + std::map<std::string, std::string>{
                                               {"FAULT_ENUMERATION", std::to_string(INITIALIZATION_FAILED)}});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_CONTAINS(result.err, "Vulkan finds no device; install the driver of your GPU");
}

// This happens where a driver compiles for hardware that is not there.
TEST_F(Devices, OneWithoutMemoryWillNotDo) {
    const ProcessResult result =
        candela({"devices"}, FAULT_LAYER + std::map<std::string, std::string>{{"FAULT_MEMORY", "1"}});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_CONTAINS(result.out, "no: it has no memory (its device-local heaps have 0 bytes)");
}

}  // namespace
}  // namespace candela
