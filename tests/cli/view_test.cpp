// `candela view`, driven as a user would, and its screen examined.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <thread>

#include "cli/view_fixture.h"

namespace candela {

namespace {

TEST_F(View, FramesThenScreenshotsAreWhatRenderMakes) {
    const Words settings{"--size", "100x60", "--seed", "3", "--max-depth", "4"};
    Process& process =
        view(settings + Words{"--frames", "20", "--screenshot", "a.exr", "--screenshot", "a.png"});
    const ProcessResult result = process.finish();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out + result.err, "");
    const Image image = read_exr(file("a.exr"));
    expect_same_rgb(image, rendered(settings + Words{"--spp", "20"}));
    for (const float count : image.find("SampleCount.V")->values)
        ASSERT_EQ(count, 20.0f);
    EXPECT_EQ(codes_of(file("a.png")), codes_of(file("rendered.png")));
}

// A .glb file of one triangle.
std::string glb() {
    const float points[9] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
    std::string json = R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}]})";
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const auto words = [](std::initializer_list<uint32_t> values) {
        return std::string(reinterpret_cast<const char*>(values.begin()), 4 * values.size());
    };
    return "glTF" + words({2, uint32_t(28 + json.size() + sizeof points), uint32_t(json.size())}) + "JSON" +
           json + words({sizeof points}) + std::string("BIN\0", 4) +
           std::string(reinterpret_cast<const char*>(points), sizeof points);
}

TEST_F(View, AGlbFileIsAScene) {
    const std::string scene = write("triangle.glb", glb());
    const Words settings{"--size", "80x60"};
    const ProcessResult result =
        view(settings + Words{"--frames", "4", "--screenshot", "a.exr"}, scene).finish();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const Image image = read_exr(file("a.exr"));
    expect_same_rgb(image, rendered(settings + Words{"--spp", "4"}, scene));
    const std::vector<float>& coverage = image.find("A")->values;
    EXPECT_EQ(coverage[30 * 80 + 40], 1.0f);
    EXPECT_EQ(coverage[0], 0.0f);
}

TEST_F(View, InstancesAreShown) {
    const std::string scene = std::string(CANDELA_SCENES) + "/../tests/bench/scenes/instances.json";
    const Words settings{"--size", "80x60", "--allow-folder", CANDELA_SCENES};
    const ProcessResult result =
        view(settings + Words{"--frames", "4", "--screenshot", "a.exr"}, scene).finish();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    expect_same_rgb(read_exr(file("a.exr")), rendered(settings + Words{"--spp", "4"}, scene));
}

// All channels and attributes, to the bit, except for those that cannot be the same.
TEST_F(View, AnExrIsTheOneThatRenderWritesAndCanBeMerged) {
    view({"--size", "60x40", "--spp", "4", "--camera", "pinhole", "--sampler", "stratified"}, DEPTH_OF_FIELD);
    const Image saved = picture_at_rest("depth-of-field", {60, 40}, 4);
    expect_clean_end();
    const Words settings{"--size", "60x40", "--camera", "pinhole", "--sampler", "stratified"};
    const Image made = rendered(settings + Words{"--spp", "4"}, DEPTH_OF_FIELD);
    ASSERT_EQ(saved.channels.size(), made.channels.size());
    for (size_t i = 0; i < made.channels.size(); ++i) {
        EXPECT_EQ(saved.channels[i].name, made.channels[i].name);
        EXPECT_EQ(saved.channels[i].values, made.channels[i].values) << made.channels[i].name;
    }
    ASSERT_EQ(saved.attributes.size(), made.attributes.size());
    for (const auto& [name, value] : made.attributes) {
        if (name == "renderTimeSeconds" || name == "candela.commandLine") continue;
        EXPECT_EQ(saved.attributes.at(name), value) << name;
    }
    EXPECT_GT(std::get<float>(saved.attributes.at("renderTimeSeconds")), 0.0f);
    EXPECT_CONTAINS(std::get<std::string>(saved.attributes.at("candela.commandLine")), "candela view ");

    write_exr(file("first.exr"), saved);
    rendered(settings + Words{"--samples", "4..8"}, DEPTH_OF_FIELD);
    const ProcessResult merged =
        candela({"merge", file("first.exr"), file("rendered.exr"), "-o", file("whole.exr")});
    EXPECT_EQ(merged.exit_code, 0) << merged.err;
    EXPECT_EQ(std::get<std::string>(read_exr(file("whole.exr")).attributes.at("candela.samples")), "0..8");
}

// The estimate is made at powers of two from 16 on, and stays until the next.
TEST_F(View, TheEstimatedErrorIsThatOfRender) {
    const Words settings{"--size", "64x48", "--spp", "40"};
    const nlohmann::json report = report_of(settings + Words{"--target-error", "1e-9"});
    char text[64];
    std::snprintf(text, sizeof text, "cornell-box: 40 samples per pixel, estimated error %.2f %%",
                  100.0 * report["estimated_error"].get<double>());
    view(settings);
    // Beside other work, a look at the picture may take so long that the next ones are left out: then the
    // picture begins anew.
    const auto wait_for_estimate = [&] {
        wait_until(std::string("the title is \"") + text + '"', [&] {
            const std::string now = title();
            if (now != text && now.find(": 40 samples") != std::string::npos) press("r");
            return now == text;
        });
    };
    wait_for_estimate();
    press("r");
    wait_for_estimate();
    expect_clean_end();
}

// N shows the picture denoised, and noisy again. What it shows is what P saves, and `candela denoise` makes
// of what X saves.
TEST_F(View, TheSwitchDenoises) {
    const Words settings{"--size", "320x240", "--denoise", "variance"};
    const ProcessResult result =
        view(settings + Words{"--frames", "2", "--screenshot", "a.png", "--screenshot", "a.exr"}).finish();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const Words denoise{"denoise", file("a.exr"), "-o",        file("b.png"),
                        "-o",      file("b.exr"), "--denoise", "variance"};
    const ProcessResult denoised = candela(denoise);
    ASSERT_EQ(denoised.exit_code, 0) << denoised.err;
    EXPECT_EQ(codes_of(file("a.png")), codes_of(file("b.png")));
    Image clean = read_exr(file("b.exr"));
    for (const char* const channel : {"R", "G", "B"}) {
        const std::vector<float> values = clean.find(std::string("Denoised.") + channel)->values;
        std::ranges::find(clean.channels, channel, &Channel::name)->values = values;
    }
    const Image noisy = read_exr(file("a.exr"));

    view({"--size", "320x240", "--spp", "2", "--denoise", "variance"});
    press("Tab");
    const Image* const shown[] = {&clean, &noisy, &clean};
    for (const Image* const image : shown) {
        wait_until("the screen shows it", [&] { return wrong_codes(screen(), *image) == 0; });
        press("n");
    }
    expect_clean_end();
}

// The panel hides a part of the picture; Tab hides the panel.
TEST_F(View, TheScreenShowsWhatTheFileHolds) {
    view({"--size", "320x240", "--spp", "2"});
    const Image image = picture_at_rest("cornell-box", {320, 240}, 2);
    expect_same_rgb(image, rendered({"--size", "320x240", "--spp", "2"}));
    wait_until("the panel is on the screen", [&] { return wrong_codes(screen(), image) > 1000; });
    press("Tab");
    wait_until("the screen shows the picture alone", [&] { return wrong_codes(screen(), image) == 0; });
    EXPECT_EQ(codes_of(saved_by("p", "cornell-box-1.png")), codes_of(file("rendered.png")));
    expect_clean_end();
}

// The distance is that of the EXR's channel Z, printed with four digits.
TEST_F(View, AClickSetsTheFocusDistance) {
    Process& process = view({"--size", "400x300", "--spp", "1"});
    wait_for_title("cornell-box: 1 samples per pixel");
    const float depth = rendered({"--size", "400x300", "--spp", "1"}).find("Z")->values[150 * 400 + 320];
    xdotool({"mousemove", "320", "150", "click", "1"});
    ASSERT_TRUE(process.wait_for_err(" m\n"));
    ASSERT_EQ(process.err().rfind("focus at ", 0), 0u) << process.err();
    EXPECT_NEAR(std::stof(process.err().substr(9)), depth, 1e-3f * depth);
    xdotool({"mousemove", "398", "150", "click", "1"});
    EXPECT_TRUE(process.wait_for_err("there is nothing to focus on\n"));
    expect_clean_end();
}

// Saving twice shows that it stands still: each takes a frame, and a frame comes after a submission.
TEST_F(View, SpacePausesAndGoesOn) {
    view({"--size", "64x64"});
    wait_until("there are samples", [&] { return samples() > 8; });
    press("space");
    wait_until("it is paused", [&] { return says("paused"); });
    const std::string paused = title();
    const Image once = read_exr(saved_by("x", "cornell-box-1.exr"));
    const Image twice = read_exr(saved_by("x", "cornell-box-2.exr"));
    expect_same_rgb(once, twice);
    EXPECT_EQ(once.find("SampleCount.V")->values, twice.find("SampleCount.V")->values);
    EXPECT_EQ(title(), paused);
    const int held = samples();
    press("space");
    wait_until("it goes on", [&] { return samples() > held && !says("paused"); });
    // R restarts it while it is paused, too, with at most as many samples as come before the first look.
    press("space");
    wait_until("it is paused", [&] { return says("paused"); });
    press("r");
    wait_until("it begins anew", [&] {
        const int now = samples();
        return now >= 1 && now <= 8;
    });
    EXPECT_TRUE(says("paused"));
    expect_clean_end();
}

TEST_F(View, ThePictureTakesTheWindowsSize) {
    view({"--size", "200x150", "--spp", "2"});
    wait_for_title("cornell-box: 2 samples per pixel");
    press("Tab");
    for (const uvec2 size : {uvec2(320, 240), uvec2(33, 57), uvec2(300, 100)}) {
        const std::string width = std::to_string(size.x);
        const std::string height = std::to_string(size.y);
        xdotool({"search", "--name", " samples per pixel", "windowsize", width, height});
        const Image image = picture_at_rest("cornell-box", size, 2);
        expect_same_rgb(image, rendered({"--size", width + "x" + height, "--spp", "2"}));
        wait_until("the screen shows it", [&] { return wrong_codes(screen(), image) == 0; });
    }
    expect_clean_end();
}

TEST_F(View, ASignalEndsItWithoutAScreenshot) {
    Process& process = view({"--size", "200x150", "--frames", "16777216", "--screenshot", "a.png"});
    wait_until("there is a window", [&] { return !title().empty(); });
    process.send(SIGTERM);
    EXPECT_EQ(process.finish().exit_code, 130);
    EXPECT_FALSE(std::filesystem::exists(file("a.png")));
}

TEST_F(View, AWindowClosedTooEarlyIsAnError) {
    Process& process = view({"--size", "200x150", "--frames", "16777216", "--screenshot", "a.png"});
    wait_until("there is a window", [&] { return !title().empty(); });
    xdotool({"key", "Escape"});
    const ProcessResult result = process.finish();
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_CONTAINS(
        result.err,
        "the window was closed before it had shown 16777216 frames, so no screenshot was written");
}

class MovingView : public View {
  protected:
    // Drags the mouse to and fro for as long as it lives.
    class Hand {
      public:
        explicit Hand(const MovingView& test) : test_(test) {
            test.xdotool({"mousemove", "400", "150", "mousedown", "1"});
            thread_ = std::jthread([&](const std::stop_token& stop) {
                while (!stop.stop_requested()) {
                    for (const char* x : {"4", "-4"}) {
                        Words moves;
                        for (int i = 0; i < 25; ++i)
                            moves = moves + Words{"mousemove_relative", "--", x, "1", "sleep", "0.02"};
                        test.xdotool(moves);
                    }
                }
            });
        }
        ~Hand() {
            thread_ = {};  // Waits for its end.
            test_.xdotool({"mouseup", "1"});
        }

      private:
        const MovingView& test_;
        std::jthread thread_;
    };

    // Waits until the picture beside the panel has changed that often; returns how long that took [s].
    double seconds_for(int updates) const {
        const auto start = std::chrono::steady_clock::now();
        std::vector<uint32_t> before;
        wait_until("the picture follows", [&] {
            std::vector<uint32_t> row = screen();
            row = {row.begin() + 180 * SCREEN.x + 320, row.begin() + 180 * SCREEN.x + 640};
            updates -= row != before;
            before = std::move(row);
            return updates < 0;  // The first one was there.
        });
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
};

TEST_F(MovingView, ThePictureFollowsAHandThatDoesNotRest) {
    view({"--size", "640x360"});
    wait_until("there is a picture", [&] { return samples() >= 2; });
    {
        const Hand hand(*this);
        std::printf("updates per second: %.1f\n", 20.0 / seconds_for(20));
    }
    expect_clean_end();
}

TEST_F(View, FilesDroppedOntoTheStartPageAreScenes) {
    view({"--size", "80x60", "--spp", "4", "--allow-folder", CANDELA_SCENES}, "");
    wait_for_samples("candela", 4);
    drop(write("broken.json", "{"));
    ASSERT_TRUE(viewer_->wait_for_err("broken.json:1", 1)) << viewer_->err();
    wait_for_samples("candela", 4);
    drop(DEPTH_OF_FIELD);
    wait_for_samples("depth-of-field", 4);
    const Image first = picture_at_rest("depth-of-field", {80, 60}, 4);
    expect_same_rgb(first, rendered({"--size", "80x60", "--spp", "4"}, DEPTH_OF_FIELD));
    drop(write("far.json", R"({"cameras": {"main": {"position": [0, 0, 4], "look_at": [0, 0, 0],
            "vertical_fov": 40}},
        "materials": {"clay": {"type": "diffuse", "reflectance": [0.7, 0.5, 0.4]}},
        "shapes": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "clay"}],
        "lights": [{"type": "point", "position": [1e30, 0, 0], "intensity": [1, 1, 1]}]})"));
    ASSERT_TRUE(viewer_->wait_for_err("too far from the scene", 1)) << viewer_->err();
    wait_for_samples("depth-of-field", 4);
    expect_same_rgb(picture_at_rest("depth-of-field", {80, 60}, 4), first);
    drop(write("triangle (1).glb",
               glb()));  // Onto a scene of the user's, by a name with letters that URIs escape.
    wait_for_samples("triangle (1)", 4);
    const Image second = picture_at_rest("triangle (1)", {80, 60}, 4);
    expect_same_rgb(second, rendered({"--size", "80x60", "--spp", "4"}, file("triangle (1).glb")));
    EXPECT_CONTAINS(std::get<std::string>(second.attributes.at("candela.commandLine")), "triangle (1).glb'");
    expect_clean_end();
}

class ViewUsage : public CliTest {
  protected:
    static void expect_error(const Words& arguments, int code, const std::string& message,
                             std::map<std::string, std::string> environment = {}) {
        const ProcessResult result = candela(Words{"view"} + arguments, std::move(environment));
        EXPECT_EQ(result.exit_code, code) << message;
        EXPECT_CONTAINS(result.err, message);
    }
};

TEST_F(ViewUsage, OptionsThatDoNotGoTogetherAreNamed) {
    expect_error({"--frames", "2"}, 2, "--frames: also name the SCENE that is shown");
    expect_error({CORNELL_BOX, "--frames", "0"}, 2,
                 "--frames: cannot use \"0\"; expected a whole number from 1 to");
    expect_error({CORNELL_BOX, "--crop", "0,0,8,8"}, 2,
                 "--crop: a window shows the whole picture; leave it out, or use candela render");
    expect_error({CORNELL_BOX, "--frames", "2", "--spp", "2"}, 2,
                 "--frames and --spp both set the number of samples; give only one");
    expect_error(
        {CORNELL_BOX, "--screenshot", "a.png"}, 2,
        "--screenshot: also give --frames N, after which it is taken; P and X save a picture at any time");
    expect_error({CORNELL_BOX, "--frames", "2", "--screenshot", "a.gif"}, 2, "a.gif");
    expect_error({CORNELL_BOX, "--frames", "2", "--screenshot", "/nonexistent/a.png"}, 1,
                 "/nonexistent/a.png");
}

#ifdef CANDELA_VIEW

TEST_F(ViewUsage, WithoutADisplayItSaysWhatToDo) {
    const std::map<std::string, std::string> no_display{{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}};
    const ProcessResult result = candela({"view", CORNELL_BOX}, no_display);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_CONTAINS(result.err, "candela: error: cannot open a window: ");
    EXPECT_CONTAINS(
        result.err,
        "; run it where there is a display (see DISPLAY or WAYLAND_DISPLAY), or use candela render");
}

TEST_F(View, WithoutADriverItSaysWhatToInstall) {
    std::map<std::string, std::string> surroundings = environment();
    surroundings.insert(NO_DRIVER.begin(), NO_DRIVER.end());
    const ProcessResult result = candela({"view", CORNELL_BOX, "--size", "64x64"}, surroundings);
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_CONTAINS(result.err, "mesa-vulkan-drivers");
}

#else

TEST_F(ViewUsage, AProgramBuiltWithoutAWindowSaysSo) {
    expect_error(
        {CORNELL_BOX}, 1,
        "view: this program was built without a window, which needs GLFW and Dear ImGui; install "
        "libglfw3-dev and libimgui-dev and build it with cmake -DCANDELA_VIEW=ON, or use candela render");
}

#endif

}  // namespace
}  // namespace candela
