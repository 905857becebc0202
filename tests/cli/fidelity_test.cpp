// `candela fidelity`: scenarios of Khronos' generator become the options of `candela render` that say the
// same.
#include <cmath>

#include <nlohmann/json.hpp>

#include "cli/cli_fixture.h"
#include "image/image_io.h"

namespace candela {
namespace {

class Fidelity : public CliTest {
  protected:
    void SetUp() override {
        write("m.gltf", R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{
            "attributes": {"POSITION": 0}}]}], "accessors": [{"bufferView": 0, "componentType": 5126,
            "type": "VEC3", "count": 3}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri":
            "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
        write("scene.json", R"({"cameras": {"c": {"position": [0, 0, 3], "look_at": [0, 0, 0],
            "vertical_fov": 40}}, "environment": {"radiance": 1}, "shapes": [], "film": {"size": [8, 4]}})");
        EXPECT_EQ(candela({"render", file("scene.json"), "-o", file("sky.exr"), "--spp", "1"}).exit_code, 0);
    }

    std::string scenario(const std::string& keys) const {
        return write("scenario.json",
                     R"({"name": "triangle", "model": "m.gltf", "lighting": "sky.exr")" + keys + "}");
    }

    ProcessResult fidelity(const Words& arguments) const {
        return candela(Words{"fidelity"} + arguments + Words{"-o", file("out.exr"), "--spp", "1", "-q"});
    }

    // What the picture's camera is, as --write-cameras has it.
    nlohmann::json camera_of(const std::string& keys) const {
        const ProcessResult result =
            fidelity({scenario(keys), "--write-cameras", file("cameras.json"), "--aov", "none"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return nlohmann::json::parse(read_file(file("cameras.json")));
    }
};

TEST_F(Fidelity, TheCameraOrbitsTheTarget) {
    const auto json = camera_of(R"(, "dimensions": {"width": 20, "height": 10}, "verticalFoV": 90,
        "target": {"x": 1, "y": 2, "z": 3}, "orbit": {"theta": 90, "phi": 30, "radius": 4})");
    EXPECT_EQ(json["w"], 40);
    EXPECT_EQ(json["h"], 20);
    EXPECT_NEAR(json["fl_y"].get<double>(), 10.0, 1e-5);  // Half of the height.
    const auto m = json["frames"][0]["transform_matrix"];
    // 30 degrees from above, over +X: the position, and the axis to it.
    const double across = 0.5, up = std::sqrt(0.75);
    const double position[]{1 + 4 * across, 2 + 4 * up, 3}, outwards[]{across, up, 0};
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(m[i][3].get<double>(), position[i], 1e-12) << i;
        EXPECT_NEAR(m[i][2].get<double>(), outwards[i], 1e-7) << i;
    }
    const Image header = read_exr_header(file("out.exr"));
    EXPECT_EQ(header.full, uvec2(40, 20));
}

TEST_F(Fidelity, FromStraightAboveWhatIsBehindIsUp) {
    const auto m = camera_of(
        R"(, "orbit": {"phi": 0, "radius": 2}, "dimensions": {"width": 8, "height": 8})")["frames"][0]
                                                                                         ["transform_matrix"];
    EXPECT_NEAR(m[1][3].get<double>(), 2.0, 1e-12);
    EXPECT_NEAR(m[2][1].get<double>(), -1.0, 1e-7);
}

TEST_F(Fidelity, OptionsReplaceWhatTheScenarioSays) {
    const std::string small = scenario(R"(, "dimensions": {"width": 8, "height": 8}, "renderSkybox": true)");
    EXPECT_EQ(fidelity({small, "--size", "16x4"}).exit_code, 0);
    EXPECT_EQ(read_exr_header(file("out.exr")).full, uvec2(16, 4));
    EXPECT_CONTAINS(fidelity({small, "--sizes", "16x4"}).err, "--sizes");
}

TEST_F(Fidelity, AScenarioIsChosenByItsName) {
    const std::string list = write("list.json", R"({"scenarios": [{"name": "a", "model": "m.gltf",
        "lighting": "sky.exr", "dimensions": {"width": 4, "height": 4}}, {"name": "b", "model": "none.glb"}]})");
    EXPECT_EQ(fidelity({list, "--scenario", "a"}).exit_code, 0);
    EXPECT_CONTAINS(fidelity({list}).err,
                    "list.json:1:15: the file has several scenarios; choose one by --scenario NAME");
    EXPECT_CONTAINS(fidelity({list, "--scenario", "c"}).err, "unknown scenario \"c\" (known: a, b)");
    EXPECT_CONTAINS(fidelity({list, "--scenario", "b", "--root", file("elsewhere")}).err,
                    "elsewhere/none.glb");
    const std::string nothing = write("nothing.json", "{}");
    EXPECT_CONTAINS(fidelity({nothing}).err, "the key \"model\" is missing here; add it");
}

}  // namespace
}  // namespace candela
