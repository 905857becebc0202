// The panel of `candela view`, the mouse and the keys: whether each does what it says.
#include <csignal>

#include "cli/view_fixture.h"
#include "scene/scene.h"

namespace candela {
namespace {

// With the saved camera in the scene, `candela render` gives the very picture that the window showed.
TEST_F(View, ADragTurnsTheCameraAndTheSavedCameraGivesTheSamePicture) {
    const Process& process = view({"--size", "320x240", "--spp", "4"});
    const Image before = picture_at_rest("cornell-box", {320, 240}, 4);
    xdotool({"mousemove", "310", "200", "mousedown", "1"});
    // A moving picture is coarser. The program gets motion and key at once; where it stalls in between until
    // the camera counts as resting, the next motion tells.
    wait_until("a moving picture is saved", [&] {
        process.send(SIGSTOP);
        xdotool({"mousemove_relative", "--", "-4", "2", "key", "x"});
        process.send(SIGCONT);
        const std::string path = file("cornell-box-1.exr");
        wait_until("it is saved", [&] { return std::filesystem::exists(path); });
        const uvec2 size = read_exr(path).full;
        std::filesystem::remove(path);
        return size.x < 320 && size.x * 240 == size.y * 320;
    });
    for (int i = 0; i < 10; ++i)
        xdotool({"mousemove_relative", "--", "-4", "2"});
    xdotool({"mouseup", "1"});
    xdotool({"mousemove", "310", "200", "click", "4", "keydown", "shift", "mousedown", "1"});
    xdotool({"mousemove_relative", "--", "-9", "9"});
    xdotool({"mousemove_relative", "--", "-9", "9"});
    xdotool({"mouseup", "1", "keyup", "shift"});
    xdotool({"keydown", "w", "keydown", "d", "sleep", "0.2", "keyup", "w", "keyup", "d"});
    const Image after = picture_at_rest("cornell-box", {320, 240}, 4);
    EXPECT_NE(image_hash(before), image_hash(after));

    const std::string camera = saved_by("c", "cornell-box-1-camera.json");
    auto scene = nlohmann::json::parse(read_file(CORNELL_BOX), nullptr, true, true);
    scene["cameras"] = nlohmann::json::parse(read_file(camera))["cameras"];
    const Image again = rendered({"--size", "320x240", "--spp", "4"}, write("scene.json", scene.dump()));
    expect_same_rgb(after, again);

    press("Home");
    expect_same_rgb(before, picture_at_rest("cornell-box", {320, 240}, 4));
    expect_clean_end();
}

// Sliders at their left ends: no bounces, as --max-depth 0; the sky turned by -180 degrees and at a hundredth
// of its brightness, as scenes with such skies; and another camera.
TEST_F(View, ThePanelChangesThePicture) {
    const uvec2 size(310, 380);
    const auto slide_left = [&](const std::string& name, const char* y) {
        wait_for_title(name + ": 1 samples per pixel");
        xdotool({"mousemove", "20", y, "click", "1"});
        return picture_at_rest(name, size, 1);
    };
    view({"--size", "310x380", "--spp", "1"});
    expect_same_rgb(slide_left("cornell-box", "322"),
                    rendered({"--size", "310x380", "--spp", "1", "--max-depth", "0"}));
    expect_clean_end();

    auto scene = nlohmann::json::parse(read_file(DEPTH_OF_FIELD), nullptr, true, true);
    scene["environment"]["file"] = std::string(CANDELA_SCENES) + "/dusk.hdr";
    const Words allowed{"--size", "310x380", "--spp", "1", "--allow-folder", CANDELA_SCENES};
    view(allowed, write("dusk.json", scene.dump()));
    // The panel alone changes nothing.
    expect_same_rgb(picture_at_rest("dusk", size, 1), rendered(allowed, file("dusk.json")));
    scene["environment"]["rotation"] = -180;
    expect_same_rgb(slide_left("dusk", "345"), rendered(allowed, write("turned.json", scene.dump())));
    // The second entry of "camera".
    xdotool({"mousemove", "150", "207", "click", "1", "mousemove", "60", "248", "click", "1"});
    expect_same_rgb(picture_at_rest("dusk", size, 1),
                    rendered(allowed + Words{"--camera", "pinhole"}, file("turned.json")));
    expect_clean_end();

    scene["environment"] = {{"radiance", {1, 1, 1}}};
    view({"--size", "310x380", "--spp", "1"}, write("even.json", scene.dump()));
    scene["environment"] = {{"radiance", {0.01, 0.01, 0.01}}};
    expect_same_rgb(slide_left("even", "368"), rendered(allowed, write("dark.json", scene.dump())));
    expect_clean_end();
}

class ViewControls : public View {
  protected:
    static Words click_at(const char* x, const char* y) { return {"mousemove", x, y, "click", "1"}; }
    // Types a number into the slider at that height; `next` begins before Return is released.
    void type(const char* y, const std::string& number, const Words& next = {}) const {
        xdotool(Words{"keydown", "ctrl"} + click_at("100", y) + Words{"keyup", "ctrl"});
        xdotool({"type", number});
        xdotool(Words{"keydown", "Return"} + next + Words{"keyup", "Return"});
    }
    // Chooses entry n, counted from 0, of the list at that height.
    void choose(int y, int n) const {
        xdotool(click_at("100", std::to_string(y).c_str()) +
                click_at("60", std::to_string(y + 24 + 17 * n).c_str()));
    }
    // Clicks at that place for the next file of the name, and waits until it is there.
    std::string saved_at(const char* x, const char* y, const std::string& name) const {
        xdotool(click_at(x, y));
        wait_until(name + " is there", [&] { return std::filesystem::exists(file(name)); });
        return file(name);
    }
    Camera saved_camera() const {
        const std::string path = saved_by("c", "cornell-box-1-camera.json");
        const nlohmann::json saved = nlohmann::json::parse(read_file(path))["cameras"]["view"];
        std::filesystem::remove(path);
        const auto vector = [&](const char* key) {
            return dvec3(saved[key][0].get<double>(), saved[key][1].get<double>(),
                         saved[key][2].get<double>());
        };
        Camera camera;
        camera.position = vector("position");
        camera.look_at = vector("look_at");
        camera.up = vec3(vector("up"));
        return camera;
    }
};

// What is typed goes to the slider and moves nothing, although it contains E and 2.
TEST_F(ViewControls, WhatIsSetInThePanelIsRendered) {
    const Words settings{"--size", "310x380", "--spp", "1", "--max-depth", "1"};
    view(settings);
    wait_for_title("cornell-box: 1 samples per pixel");
    type("157", "1000");
    const std::vector<std::byte> brightest = codes_of(saved_by("p", "cornell-box-1.png"));
    rendered(settings + Words{"--exposure", "10"});
    EXPECT_TRUE(brightest == codes_of(file("rendered.png")));

    type("157", "1.5");
    choose(180, 3);
    type("253", "2e-2");
    type("276", "0.7");
    choose(299, 1);
    const Image image = picture_at_rest("cornell-box", {310, 380}, 1);
    const std::vector<std::byte> shown = codes_of(saved_by("p", "cornell-box-2.png"));
    auto scene = nlohmann::json::parse(read_file(CORNELL_BOX), nullptr, true, true);
    scene["cameras"]["main"]["lens"] = {{"radius", 0.02}, {"focal_distance", 0.7}};
    const Words development{"--exposure", "1.5", "--tonemap", "agx", "--estimator", "light"};
    expect_same_rgb(image, rendered(settings + development, write("scene.json", scene.dump())));
    EXPECT_TRUE(shown == codes_of(file("rendered.png")));
    expect_clean_end();
}

// Everything that is done while the program is stalled reaches it at once, and acts as if it had waited for
// each.
TEST_F(ViewControls, WhatIsDoneDuringAStallIsDoneInItsOrder) {
    const Words settings{"--size", "310x380", "--spp", "1", "--max-depth", "1"};
    const Process& process = view(settings);
    wait_for_title("cornell-box: 1 samples per pixel");
    process.send(SIGSTOP);
    type("157", "1.5");
    choose(180, 3);
    type("253", "2e-2");
    type("276", "0.7", {"key", "c"});
    choose(299, 1);
    xdotool({"key", "x"});
    process.send(SIGCONT);
    const std::string saved = file("cornell-box-1.exr");
    wait_until("it is saved", [&] { return std::filesystem::exists(saved); });
    EXPECT_EQ(std::get<std::string>(read_exr(saved).attributes.at("candela.estimator")), "light");
    std::filesystem::remove(saved);
    EXPECT_TRUE(std::filesystem::exists(file("cornell-box-1-camera.json")));
    const Image image = picture_at_rest("cornell-box", {310, 380}, 1);
    auto scene = nlohmann::json::parse(read_file(CORNELL_BOX), nullptr, true, true);
    scene["cameras"]["main"]["lens"] = {{"radius", 0.02}, {"focal_distance", 0.7}};
    const Words development{"--exposure", "1.5", "--tonemap", "agx", "--estimator", "light"};
    expect_same_rgb(image, rendered(settings + development, write("scene.json", scene.dump())));

    // A key that went down and up meanwhile has been pressed.
    std::filesystem::remove(file("cornell-box-1-camera.json"));
    const dvec3 home = saved_camera().position;
    process.send(SIGSTOP);
    xdotool({"key", "w"});
    process.send(SIGCONT);
    EXPECT_NE(saved_camera().position, home);
    expect_clean_end();
}

TEST_F(ViewControls, TheButtonsDoWhatTheKeysDo) {
    view({"--size", "310x380"});
    wait_until("there are samples", [&] { return samples() > 8; });
    xdotool(click_at("30", "134"));
    wait_until("it is paused", [&] { return says("paused"); });
    const std::string paused = title();
    const int held = samples();
    EXPECT_EQ(read_exr(saved_at("236", "134", "cornell-box-1.exr")).full, uvec2(310, 380));
    const std::string png = read_file(saved_at("164", "134", "cornell-box-1.png"));
    EXPECT_EQ(png.substr(1, 3), "PNG");
    EXPECT_EQ(title(), paused);
    xdotool(click_at("95", "134"));
    wait_until("it begins anew", [&] {
        const int now = samples();
        return now >= 0 && now < held;
    });
    xdotool(click_at("30", "134"));
    wait_until("it goes on", [&] { return samples() >= 0 && !says("paused"); });

    const dvec3 home = saved_camera().position;
    xdotool({"mousemove", "305", "375", "click", "4"});
    EXPECT_NE(saved_camera().position, home);
    xdotool(click_at("58", "230"));
    EXPECT_EQ(saved_camera().position, home);
    saved_at("150", "230", "cornell-box-1-camera.json");
    expect_clean_end();
}

// In the frame of the camera: right, up, forwards. A turn and a step of the wheel leave the point that is
// looked at where it is; everything else moves it along with the camera.
TEST_F(ViewControls, MouseAndKeysMoveTheCameraTheirWay) {
    view({"--size", "200x200", "--spp", "1"});
    wait_for_title("cornell-box: 1 samples per pixel");
    press("Tab");
    // Drags in two steps, the first of which distinguishes a drag from a click.
    const auto drag = [](const char* button, const char* x, const char* y) {
        const Words step{"mousemove_relative", "--", x, y};
        return Words{"mousemove", "100", "100", "mousedown", button} + step + step;
    };
    struct Move {
        Words begin, end;
        dvec3 direction;
        bool about;  // The point that is looked at stays.
    };
    const Move moves[] = {
        {{"keydown", "w"}, {"keyup", "w"}, {0, 0, 1}, false},
        {{"keydown", "s"}, {"keyup", "s"}, {0, 0, -1}, false},
        {{"keydown", "d"}, {"keyup", "d"}, {1, 0, 0}, false},
        {{"keydown", "a"}, {"keyup", "a"}, {-1, 0, 0}, false},
        {{"keydown", "e"}, {"keyup", "e"}, {0, 1, 0}, false},
        {{"keydown", "q"}, {"keyup", "q"}, {0, -1, 0}, false},
        {drag("2", "9", "0"), {"mouseup", "2"}, {-1, 0, 0}, false},
        {drag("3", "0", "9"), {"mouseup", "3"}, {0, 1, 0}, false},
        {drag("1", "9", "0"), {"mouseup", "1"}, {-1, 0, 0}, true},
        {drag("1", "0", "9"), {"mouseup", "1"}, {0, 1, 0}, true},
        {{"click", "4"}, {}, {0, 0, 1}, true},
        {{"click", "5"}, {}, {0, 0, -1}, true},
    };
    for (const Move& move : moves) {
        const Camera before = saved_camera();
        xdotool(move.begin);
        Camera after;
        wait_until("the camera has moved",
                   [&] { return (after = saved_camera()).position != before.position; });
        if (!move.end.empty()) xdotool(move.end);
        const dvec3 forward = normalize(before.look_at - before.position);
        const dvec3 right = normalize(cross(forward, dvec3(before.up)));
        const dvec3 shift = after.position - before.position;
        const dvec3 seen(dot(shift, right), dot(shift, cross(right, forward)), dot(shift, forward));
        // The chord of a turn by up to half a radian is at an angle of up to a quarter to the direction in
        // which the turn begins.
        EXPECT_GT(dot(normalize(seen), move.direction), std::cos(0.25)) << move.begin.back();
        EXPECT_EQ(after.look_at == before.look_at, move.about) << move.begin.back();
    }
    expect_clean_end();
}

}  // namespace
}  // namespace candela
