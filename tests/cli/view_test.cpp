// `candela view`, driven like a user would, and looked at.
#include <csignal>
#include <cstring>

#include "base/tonemap.h"
#include "cli/view_fixture.h"
#include "render/accumulation.h"

namespace candela {

size_t ViewTest::wrong_codes(const std::vector<uint32_t>& screen, const Image& image) {
    const std::vector<uint8_t> codes = develop(image, Tonemap::linear, 0.0f);
    const uint32_t width = image.data.width();
    size_t wrong = 0;
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        const uint32_t shown = screen[i / width * SCREEN.x + i % width];
        for (size_t c = 0; c < 3; ++c)
            wrong += std::abs(int(shown >> (16 - 8 * c) & 255u) - int(codes[3 * i + c])) > 1;
    }
    return wrong;
}

namespace {

// The same pictures, bit for bit.
void expect_same_rgb(const Image& a, const Image& b) {
    EXPECT_EQ(a.full, b.full);
    EXPECT_EQ(image_hash(a), image_hash(b));
}

class View : public ViewTest {
  protected:
    // What `candela render` makes of the scene.
    Image rendered(const Words& arguments, const std::string& scene = CORNELL_BOX) const {
        const ProcessResult result = candela(
            Words{"render", scene, "-q", "-o", file("rendered.exr"), "-o", file("rendered.png")} + arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return read_exr(file("rendered.exr"));
    }
};

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
    EXPECT_EQ(read_file(file("a.png")), read_file(file("rendered.png")));
}

// The panel hides a part of the picture; Tab takes it away.
TEST_F(View, TheScreenShowsWhatTheFileHolds) {
    view({"--size", "320x240", "--spp", "2"});
    const Image image = picture_at_rest("cornell-box", {320, 240}, 2);
    expect_same_rgb(image, rendered({"--size", "320x240", "--spp", "2"}));
    wait_until("the panel is on the screen", [&] { return wrong_codes(screen(), image) > 1000; });
    xdotool({"key", "Tab"});
    wait_until("the screen shows the picture alone", [&] { return wrong_codes(screen(), image) == 0; });
    xdotool({"key", "p"});
    wait_until("there is a PNG", [&] { return std::filesystem::exists(file("cornell-box-1.png")); });
    EXPECT_EQ(read_file(file("cornell-box-1.png")), read_file(file("rendered.png")));
    expect_clean_end();
}

// The saved camera, put into the scene, gives `candela render` the very picture that the window showed.
TEST_F(View, ADragTurnsTheCameraAndTheSavedCameraGivesTheSamePicture) {
    view({"--size", "320x240", "--spp", "4"});
    const Image before = picture_at_rest("cornell-box", {320, 240}, 4);
    xdotool({"mousemove", "310", "200", "mousedown", "1"});
    bool moved = false;
    for (int i = 0; i < 10; ++i) {
        xdotool({"mousemove_relative", "--", "-4", "2"});
        moved |= title().find(", moving") != std::string::npos;
    }
    xdotool({"mouseup", "1"});
    EXPECT_TRUE(moved);
    xdotool({"mousemove", "310", "200", "click", "4", "keydown", "shift", "mousedown", "1"});
    xdotool({"mousemove_relative", "--", "-9", "9"});
    xdotool({"mousemove_relative", "--", "-9", "9"});
    xdotool({"mouseup", "1", "keyup", "shift"});
    xdotool({"keydown", "w", "keydown", "d", "sleep", "0.2", "keyup", "w", "keyup", "d"});
    const Image after = picture_at_rest("cornell-box", {320, 240}, 4);
    EXPECT_NE(image_hash(before), image_hash(after));

    xdotool({"key", "c"});
    const std::string camera = file("cornell-box-1-camera.json");
    wait_until("the camera is there", [&] { return std::filesystem::exists(camera); });
    auto scene = nlohmann::json::parse(read_file(CORNELL_BOX), nullptr, true, true);
    scene["cameras"] = nlohmann::json::parse(read_file(camera))["cameras"];
    const Image again = rendered({"--size", "320x240", "--spp", "4"}, write("scene.json", scene.dump()));
    expect_same_rgb(after, again);

    xdotool({"key", "Home"});
    expect_same_rgb(before, picture_at_rest("cornell-box", {320, 240}, 4));
    expect_clean_end();
}

// Sliders at their left ends: no bounces, as --max-depth 0; the sky turned by -180 degrees and at a hundredth
// of its brightness, as scenes with such skies; and another camera.
TEST_F(View, ThePanelChangesThePicture) {
    const uvec2 size(310, 380);
    const auto slide_left = [&](const std::string& name, const char* y) {
        wait_for_title(name + ": 1 samples per pixel");
        xdotool({"mousemove", "20", y, "mousedown", "1", "sleep", "0.3", "mouseup", "1"});
        return picture_at_rest(name, size, 1);
    };
    view({"--size", "310x380", "--spp", "1"});
    expect_same_rgb(slide_left("cornell-box", "322"),
                    rendered({"--size", "310x380", "--spp", "1", "--max-depth", "0"}));
    expect_clean_end();

    auto scene = nlohmann::json::parse(read_file(std::string(CANDELA_SCENES) + "/depth-of-field.json"),
                                       nullptr, true, true);
    scene["environment"]["file"] = std::string(CANDELA_SCENES) + "/dusk.hdr";
    view({"--size", "310x380", "--spp", "1"}, write("dusk.json", scene.dump()));
    // The panel alone changes nothing.
    expect_same_rgb(picture_at_rest("dusk", size, 1),
                    rendered({"--size", "310x380", "--spp", "1"}, file("dusk.json")));
    scene["environment"]["rotation"] = -180;
    expect_same_rgb(slide_left("dusk", "345"),
                    rendered({"--size", "310x380", "--spp", "1"}, write("turned.json", scene.dump())));
    // The second entry of "camera".
    for (const auto& [x, y] : {std::pair("150", "207"), std::pair("60", "248")}) {
        xdotool({"mousemove", x, y, "sleep", "0.3", "mousedown", "1", "sleep", "0.3", "mouseup", "1", "sleep",
                 "0.3"});
    }
    expect_same_rgb(
        picture_at_rest("dusk", size, 1),
        rendered({"--size", "310x380", "--spp", "1", "--camera", "pinhole"}, file("turned.json")));
    expect_clean_end();

    scene["environment"] = {{"radiance", {1, 1, 1}}};
    view({"--size", "310x380", "--spp", "1"}, write("even.json", scene.dump()));
    scene["environment"] = {{"radiance", {0.01, 0.01, 0.01}}};
    expect_same_rgb(slide_left("even", "368"),
                    rendered({"--size", "310x380", "--spp", "1"}, write("dark.json", scene.dump())));
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

TEST_F(View, SpacePausesAndGoesOn) {
    view({"--size", "64x64"});
    wait_until("there is a sample",
               [&] { return title() > "cornell-box: 1" && title() != "cornell-box: 0"; });
    xdotool({"key", "space"});
    wait_until("it is paused", [&] { return title().find(", paused") != std::string::npos; });
    const std::string paused = title();
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    EXPECT_EQ(title(), paused);
    xdotool({"key", "space"});
    wait_until("it goes on",
               [&] { return title() != paused && title().find(", paused") == std::string::npos; });
    // R begins anew while it is paused, too.
    xdotool({"key", "space", "key", "r"});
    wait_until("it begins anew", [&] {
        const std::string now = title();
        return now.find("cornell-box: 1 ") == 0 || now.find("cornell-box: 8 ") == 0;
    });
    expect_clean_end();
}

TEST_F(View, ThePictureTakesTheWindowsSize) {
    view({"--size", "200x150", "--spp", "2"});
    wait_for_title("cornell-box: 2 samples per pixel");
    xdotool({"key", "Tab"});
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

// A window that is taken from the screen and put back goes on, and shows its picture again.
TEST_F(View, GoesOnWhileItIsNotOnTheScreen) {
    view({"--size", "200x150", "--spp", "40"});
    wait_until("there is a window", [&] { return !title().empty(); });
    xdotool({"key", "Tab"});
    xdotool({"search", "--name", " samples per pixel", "windowunmap"});
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    xdotool({"search", "--name", " samples per pixel", "windowmap", "windowfocus"});
    const Image image = picture_at_rest("cornell-box", {200, 150}, 40);
    wait_until("the screen shows it", [&] { return wrong_codes(screen(), image) == 0; });
    expect_clean_end();
}

TEST_F(View, ClosesCleanlyAtAnyMoment) {
    for (int i = 0; i < 6; ++i) {
        view({"--size", "300x300"});
        wait_until("there is a window", [&] { return !title().empty(); });
        std::this_thread::sleep_for(std::chrono::milliseconds(70 * i));
        if (i % 2 == 1)
            xdotool({"mousemove", "310", "150", "mousedown", "1", "mousemove_relative", "9", "9"});
        expect_clean_end();
        xdotool({"mouseup", "1"});
    }
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
    EXPECT_CONTAINS(result.err,
                    "the window was closed before it had shown 16777216 frames; no screenshot was written");
}

// What is promised for two cores and this size. Every change of the picture beside the panel counts, while
// the mouse drags for two seconds.
TEST_F(View, AMovingPictureIsUpdatedTenTimesPerSecond) {
    view({"--size", "640x360"});
    wait_until("there is a picture", [&] { return title() > "cornell-box: 2"; });
    xdotool({"mousemove", "400", "150", "mousedown", "1"});
    Words moves;
    for (int i = 0; i < 125; ++i)
        moves = moves + Words{"mousemove_relative", "--", i / 25 % 2 == 0 ? "4" : "-4", "1", "sleep", "0.02"};
    std::thread hand([&] { xdotool(moves); });
    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    size_t updates = 0;
    std::vector<uint32_t> before;
    while (seconds() < 2.0) {
        std::vector<uint32_t> row = screen();
        row = {row.begin() + 180 * SCREEN.x + 320, row.begin() + 180 * SCREEN.x + 640};
        updates += row != before;
        before = std::move(row);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    RecordProperty("updates_per_second", std::to_string(double(updates) / seconds()));
    EXPECT_GE(double(updates) / seconds(), 10.0);
    hand.join();
    xdotool({"mouseup", "1"});
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
    expect_error({}, 2, "SCENE is required; see candela view --help");
    expect_error({CORNELL_BOX, "--frames", "0"}, 2,
                 "--frames: cannot use \"0\"; expected a whole number from 1 to");
    expect_error({CORNELL_BOX, "--crop", "0,0,8,8"}, 2,
                 "--crop: a window shows the whole picture; leave it out, or use candela render");
    expect_error({CORNELL_BOX, "--frames", "2", "--spp", "2"}, 2,
                 "--frames and --spp both say how many samples there shall be; give one");
    expect_error({CORNELL_BOX, "--screenshot", "a.png"}, 2,
                 "--screenshot: give --frames N too, which says when; P and X write pictures at any time");
    expect_error({CORNELL_BOX, "--frames", "2", "--screenshot", "a.jpg"}, 2, "a.jpg");
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
        "view: this program was built without a window, which takes GLFW and Dear ImGui; install "
        "libglfw3-dev and libimgui-dev and build it with cmake -DCANDELA_VIEW=ON, or use candela render");
}

#endif

}  // namespace
}  // namespace candela
