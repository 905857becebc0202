// A scene that stays: after any change, the picture has the bits of a fresh load of that state.
#include "session/session.h"

#include <array>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/png_writer.h"
#include "unit/base/base_fixture.h"
#include "unit/load/gltf/gltf_fixture.h"

namespace candela {
namespace {

constexpr uint32_t SESSION_SPP = 64;  // In more than one submission.

using Layers = std::vector<std::vector<float>>;

const std::string CAMERA = R"({"position": [0, 1, 4], "look_at": [0, 0.5, 0], "vertical_fov": 40})";
const std::string FLOOR = R"({"type": "diffuse", "reflectance": [0.6, 0.5, 0.4]})";
const std::string LAMP = R"({"type": "mirror"})";
const std::string SKY = R"({"radiance": [0.2, 0.3, 0.4]})";

// A mesh on a floor, under a lamp that emits what its material does, and a sky. Beside the lamp are two of
// its material that state an emission: one none, the other what the material of some changes has.
std::string scene_text(const std::string& camera, const std::string& floor, const std::string& lamp,
                       const std::string& sky) {
    return R"({"cameras": {"main": )" + camera + R"(}, "film": {"size": [24, 16]}, "materials": {"floor": )" +
           floor + R"(, "lamp": )" + lamp + R"(}, "environment": )" + sky + R"(, "shapes": [
        {"type": "quad", "material": "floor", "vertices": [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]]},
        {"type": "mesh", "material": "floor", "positions": [[-1, 0, 0], [1, 0, 0], [0, 1, 0]],
         "triangles": [[0, 1, 2]], "uvs": [[0, 0], [1, 0], [0.5, 1]]},
        {"type": "quad", "material": "lamp", "vertices": [[-1, 2, -1], [1, 2, -1], [1, 2, 1], [-1, 2, 1]]},
        {"type": "sphere", "material": "lamp", "center": [-1, 1, 0], "radius": 0.2, "emission": 0},
        {"type": "sphere", "material": "lamp", "center": [1, 1, 0], "radius": 0.2, "emission": [1, 2, 3]}]})";
}

class SessionTest : public testing::Test {
  protected:
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
    }
    SceneFile file(const std::string& text) const {
        write("scene.json", text);
        return {.path = folder_ / "scene.json"};
    }
    // A file whose triangle, of the material "paint", turns about z, and is half as large at 1 s.
    void write_turning(const std::string& name) const {
        GltfFile file;
        file.root["materials"] = {{{"name", "paint"}}};
        file.show({{"attributes", {{"POSITION", file.add_corner()}}}, {"material", 0}});
        const size_t times = file.add<float>("SCALAR", {0, 1});
        const size_t turns = file.add<float>("VEC4", {0, 0, 0, 1, 0, 0, 1, 0});
        const size_t sizes = file.add<float>("VEC3", {1, 1, 1, 0.5f, 0.5f, 0.5f});
        const auto channel = [](int sampler, const char* path) {
            return Json{{"sampler", sampler}, {"target", {{"node", 0}, {"path", path}}}};
        };
        file.push(
            "animations",
            {{"samplers", {{{"input", times}, {"output", turns}}, {{"input", times}, {"output", sizes}}}},
             {"channels", {channel(0, "rotation"), channel(1, "scale")}}});
        write(name, file.gltf());
    }
    static SessionOptions options() {
        return {.warn = [](const std::string& what) { ADD_FAILURE() << what; }, .validation = true};
    }
    static Layers layers(const Session& session) {
        Layers values;
        for (const PictureLayer& layer : session.layers())
            values.push_back(layer.values);
        return values;
    }
    // The picture of a session that loads the text.
    Layers fresh(const std::string& text, const PictureRequest& picture) const {
        Session session(options());
        session.load(file(text));
        session.choose(picture);
        EXPECT_TRUE(session.render(SESSION_SPP));
        return layers(session);
    }

    TemporaryDirectory folder_;
};

TEST_F(SessionTest, AfterEachChangeThePictureIsThatOfAFreshLoad) {
    std::ofstream(folder_ / "floor.png", std::ios::binary)
        << encode_png({.size = {2, 1}, .bits = 8, .color = png_rgb, .samples = {250, 90, 20, 30, 60, 240}});
    const std::string camera = R"({"position": [1, 2, 3], "look_at": [0, 0.2, 0], "vertical_fov": 50,
                                   "lens": {"radius": 0.1, "focal_distance": 3}})";
    const std::string sky = R"({"radiance": [0.2, 0.3, 0.4], "intensity": 2.5})";
    const std::string floor = R"({"type": "diffuse", "reflectance": {"image": "floor.png"}})";
    const std::string lamp = R"({"type": "principled", "base_color": 0.2, "emission": [1, 2, 3]})";
    struct Step {
        std::string change, state;
    };
    const std::string paint = R"({"type": "diffuse", "reflectance": [0.2, 0.5, 0.7]})";
    const Step steps[] = {
        {R"({"cameras": {"main": )" + camera + "}}", scene_text(camera, FLOOR, LAMP, SKY)},
        {R"({"environment": )" + sky + "}", scene_text(camera, FLOOR, LAMP, sky)},
        {R"({"materials": {"floor": )" + paint + "}}", scene_text(camera, paint, LAMP, sky)},
        {R"({"materials": {"floor": )" + floor + R"(, "lamp": )" + lamp + "}}",
         scene_text(camera, floor, lamp, sky)}};
    std::vector<Layers> pictures;
    {
        Session session(options());
        session.load(file(scene_text(CAMERA, FLOOR, LAMP, SKY)));
        const auto render = [&] {
            EXPECT_TRUE(session.render(SESSION_SPP));
            pictures.push_back(layers(session));
        };
        session.choose({.all_layers = true});
        render();
        for (const Step& step : steps) {
            session.change(step.change);
            render();
        }
        session.change(R"({"cameras": {"main": )" + CAMERA + R"(}, "materials": {"floor": )" + FLOOR +
                       R"(, "lamp": )" + LAMP + R"(}, "environment": )" + SKY + "}");
        render();
    }
    for (size_t i = 0; i < std::size(steps); ++i) {
        EXPECT_NE(pictures[i + 1], pictures[i]) << steps[i].change;
        EXPECT_TRUE(pictures[i + 1] == fresh(steps[i].state, {.all_layers = true})) << steps[i].change;
    }
    EXPECT_TRUE(pictures.back() == pictures.front());
    EXPECT_EQ(pictures.front().size(), 18u);  // R G B A, and those of docs/files.md.
}

// A triangle of a glTF file turns and shrinks.
TEST_F(SessionTest, AfterEachPoseThePictureIsThatOfAFreshLoad) {
    const auto text = [](const std::string& paint) {
        return R"({"scene": "m.gltf", "cameras": {"main": )" + CAMERA +
               R"(}, "film": {"size": [24, 16]}, "materials": {"paint": )" + paint + R"(}, "environment": )" +
               SKY + "}";
    };
    const std::string blue = R"({"type": "diffuse", "reflectance": [0.1, 0.2, 0.9]})";
    write_turning("m.gltf");
    std::array<Layers, 4> layers_at;
    {
        Session session(options());
        EXPECT_EQ(error_of([&] { session.pose(0.5); }), "no scene has been loaded yet; call load() first");
        session.load(file(text(FLOOR)));
        const auto render = [&](Layers& picture) {
            EXPECT_TRUE(session.render(SESSION_SPP));
            picture = layers(session);
        };
        render(layers_at[0]);
        session.pose(0.5);
        render(layers_at[1]);
        session.change(R"({"materials": {"paint": )" + blue + "}}");
        session.pose(1.0);
        render(layers_at[2]);
        session.pose({});
        session.change(R"({"materials": {"paint": )" + FLOOR + "}}");
        render(layers_at[3]);
    }
    EXPECT_NE(layers_at[1], layers_at[0]);
    EXPECT_NE(layers_at[2], layers_at[1]);
    EXPECT_TRUE(layers_at[3] == layers_at[0]);
    for (const bool last : {false, true}) {
        Session session(options());
        SceneFile posed = file(text(last ? blue : FLOOR));
        posed.time = last ? 1.0 : 0.5;
        session.load(posed);
        EXPECT_TRUE(session.render(SESSION_SPP));
        EXPECT_TRUE(layers_at[last ? 2 : 1] == layers(session));
    }
}

TEST_F(SessionTest, RendersOnAndWithOtherPicturesToTheSameBits) {
    const std::string text = scene_text(CAMERA, FLOOR, LAMP, SKY);
    const PictureRequest wide{.width = 40, .height = 12, .seed = 7};
    Layers on, wider, again;
    {
        Session session(options());
        session.load(file(text));
        EXPECT_TRUE(session.render(1));
        EXPECT_FALSE(session.render(SESSION_SPP, [](double) { return false; }));
        EXPECT_TRUE(session.render(SESSION_SPP));
        on = layers(session);
        session.choose(wide);
        EXPECT_TRUE(session.render(SESSION_SPP));
        EXPECT_EQ(session.width(), 40u);
        EXPECT_EQ(session.height(), 12u);
        wider = layers(session);
        session.load(file(text));
        EXPECT_TRUE(session.render(SESSION_SPP));
        again = layers(session);
    }
    EXPECT_TRUE(again == on);
    EXPECT_TRUE(wider == fresh(text, wide));
    EXPECT_TRUE(on == fresh(text, {}));
}

TEST_F(SessionTest, APictureDependsOnNothingBeforeIt) {
    const std::string text = scene_text(CAMERA, FLOOR, LAMP, SKY);
    Layers fewer, all;
    {
        Session session(options());
        session.load(file(text));
        EXPECT_TRUE(session.render(SESSION_SPP));
        EXPECT_TRUE(session.render(1));  // Fewer than there are.
        fewer = layers(session);
        session.choose({.all_layers = true});  // What pixels show first has not been looked up yet.
        EXPECT_TRUE(session.render(SESSION_SPP));
        all = layers(session);
    }
    EXPECT_TRUE(all == fresh(text, {.all_layers = true}));
    Session session(options());
    session.load(file(text));
    EXPECT_TRUE(session.render(1));
    EXPECT_TRUE(fewer == layers(session));
}

TEST_F(SessionTest, AFailureLeavesSceneAndPicture) {
    Session session(options());
    EXPECT_EQ(error_of([&] { session.render(1); }), "no scene has been loaded yet; call load() first");
    session.load(file(scene_text(CAMERA, FLOOR, LAMP, SKY)));
    EXPECT_EQ(error_of([&] { session.layers(); }), "nothing has been rendered yet; call render() first");
    EXPECT_TRUE(session.render(SESSION_SPP));
    const Layers before = layers(session);
    const auto expect_refused = [&](const std::string& change, const std::string& message) {
        EXPECT_EQ(error_of([&] { session.change(change); }).substr(0, message.size()), message);
    };
    const std::string other = R"("floor": {"type": "mirror"})";
    expect_refused(R"({"shapes": []})", R"(change:1:2: unknown key "shapes")");
    expect_refused(R"({"materials": {)" + other + R"(, "roof": {"type": "mirror"}}})",
                   R"(change:1:53: unknown material "roof")");
    expect_refused(R"({"materials": {)" + other +
                       R"(, "lamp": {"type": "diffuse", "reflectance": {"image": "none.png"}}}})",
                   "change:1:");
    expect_refused(R"({"cameras": {"main": {}}, "materials": {}})", "change:1:");
    expect_refused(R"({"materials": {)" + other + R"(}, "environment": {"file": "none.exr"}})", "change:1:");
    expect_refused(
        R"({"materials": {"floor": {"type": "principled", "anisotropy": 0.5}}})",
        R"(change:1:25: the meshes of the material "floor" were read for its normal map, its anisotropy or the )"
        "lack of them, or for the heights of their file; change the scene's file, and load it again");
    EXPECT_EQ(error_of([&] { session.choose({.camera = "left"}); }),
              R"(unknown camera "left" (defined: main))");
    EXPECT_EQ(error_of([&] { session.choose({.width = 0}); }),
              "a picture without width or height cannot be rendered; give at least 1 for each");
    EXPECT_EQ(error_of([&] { session.render(0); }), "cannot render 0 samples per pixel; give 1 to 16777216");
    EXPECT_TRUE(layers(session) == before);
    session.choose({});  // Begins the picture anew.
    EXPECT_TRUE(session.render(SESSION_SPP));
    EXPECT_TRUE(layers(session) == before);
}

}  // namespace
}  // namespace candela
