// What `candela view` must survive: a window that comes, goes and closes at any moment, and a lost device.
#include <csignal>
#include <numeric>

#include "cli/view_fixture.h"

namespace candela {
namespace {

// A window that is removed from the screen and put back goes on, and shows its picture again.
TEST_F(View, GoesOnWhileItIsNotOnTheScreen) {
    view({"--size", "200x150"});
    wait_until("there is a window", [&] { return !title().empty(); });
    press("Tab");
    xdotool({"search", "--name", " samples per pixel", "windowunmap"});
    wait_until("the screen is empty", [&] { return shows_nothing({200, 150}); });
    const int held = samples();
    wait_until("it goes on", [&] { return samples() > held + 40; });
    EXPECT_TRUE(shows_nothing({200, 150}));
    xdotool({"search", "--name", " samples per pixel", "windowmap", "windowfocus"});
    press("space");
    wait_until("it is paused", [&] { return says("paused"); });
    const Image image = read_exr(saved_by("x", "cornell-box-1.exr"));
    EXPECT_EQ(image.full, uvec2(200, 150));
    const std::vector<float>& counts = image.find("SampleCount.V")->values;
    EXPECT_GT(std::accumulate(counts.begin(), counts.end(), 0.0) / double(counts.size()), held);
    wait_until("the screen shows it", [&] { return wrong_codes(screen(), image) == 0; });
    expect_clean_end();
}

// A window manager, Openbox, puts the window into the upper left corner, without a frame.
class ManagedView : public View {
  protected:
    void SetUp() override {
        View::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        if (run_process({"/usr/bin/env", "sh", "-c", "command -v openbox"}).exit_code != 0)
            GTEST_SKIP() << "openbox is not here: install it";
        const std::string rules = write("rc.xml", R"(<openbox_config xmlns="http://openbox.org/3.4/rc">
            <theme><keepBorder>no</keepBorder></theme>
            <keyboard><keybind key="A-F4"><action name="Close"/></keybind></keyboard>
            <applications><application name="*">
                <decor>no</decor><focus>yes</focus><position force="yes"><x>0</x><y>0</y></position>
            </application></applications>
        </openbox_config>)");
        // Windows that want to be shown while it starts may be forgotten; this it does when it has.
        const std::string started = file("started");
        manager_.emplace(
            Words{"/usr/bin/env", "openbox", "--config-file", rules, "--startup", "touch " + started},
            ProcessOptions{.environment = environment()});
        wait_until("openbox manages windows", [&] { return std::filesystem::exists(started); });
    }
    // Starts `candela view` and waits until the manager has made the window active.
    void view_managed(const Words& arguments) {
        view(arguments);
        wait_until("the window is active", [&] {
            return xdotool({"getactivewindow", "getwindowname"}).rfind("cornell-box", 0) == 0;
        });
    }

    std::optional<Process> manager_;
};

TEST_F(ManagedView, MinimisedItGoesOnAndComesBackWithItsPicture) {
    const Words settings{"--size", "200x150", "--spp", "40"};
    view_managed(settings);
    wait_until("there is a picture", [&] { return samples() >= 1; });
    press("Tab");
    xdotool({"search", "--name", " samples per pixel", "windowminimize"});
    wait_until("the screen is empty", [&] { return shows_nothing({200, 150}); });
    wait_until("it has all samples", [&] { return samples() == 40; });
    EXPECT_TRUE(shows_nothing({200, 150}));
    xdotool({"search", "--name", " samples per pixel", "windowmap"});
    const Image image = rendered(settings);
    wait_until("the screen shows it", [&] { return wrong_codes(screen(), image) == 0; });
    expect_same_rgb(picture_at_rest("cornell-box", {200, 150}, 40), image);
    expect_clean_end();
}

TEST_F(ManagedView, WaitsForNoManager) {
    manager_->send(SIGSTOP);
    view({"--size", "200x150"});
    wait_until("there is a picture", [&] { return samples() >= 1; });
    EXPECT_TRUE(shows_nothing({200, 150}));
    manager_->send(SIGCONT);
    wait_until("the window is there", [&] { return !shows_nothing({200, 150}); });
    expect_clean_end();
}

// As soon as there is a window, while the kernel is being compiled; after a change that takes another kernel;
// while the picture moves; while it is paused; when it is complete.
TEST_F(ManagedView, ItsManagerClosesItCleanlyAtAnyMoment) {
    const auto wait_for_picture = [&] { wait_until("there is a picture", [&] { return samples() >= 1; }); };
    const std::pair<const char*, std::function<void()>> moments[] = {
        {"at once", [] {}},
        {"after a change of the estimator",
         [&] {
             wait_for_picture();
             xdotool({"mousemove", "150", "299", "click", "1", "mousemove", "60", "323", "click", "1"});
         }},
        {"moving",
         [&] {
             wait_for_picture();
             xdotool({"mousemove", "350", "150", "mousedown", "1", "mousemove_relative", "--", "-9", "9"});
         }},
        {"paused",
         [&] {
             wait_for_picture();
             press("space");
             wait_until("it is paused", [&] { return says("paused"); });
         }},
        {"complete", [&] { wait_until("it is complete", [&] { return samples() == 10; }); }},
    };
    for (const auto& [name, wait_for_moment] : moments) {
        view_managed({"--size", "400x400", "--spp", "10"});
        wait_for_moment();
        xdotool({"key", "alt+F4"});
        const ProcessResult result = viewer_->finish();
        EXPECT_EQ(result.exit_code, 0) << name << ": " << result.err;
        xdotool({"mouseup", "1"});
    }
}

// The window stays, and the picture goes on from the last copy, of eight samples at least, to the same bits.
// (The first device fails, and then cannot be opened at once. Whether the second one lives to fail depends on
// how often the viewer looks at the picture, which it does more rarely on a slow machine.)
TEST_F(View, ALostDeviceIsOpenedAgain) {
    const Words size{"--size", "16x16"};
    Process& process = view(size + Words{"--frames", "256", "--screenshot", "a.exr", "--screenshot", "a.png"},
                            CORNELL_BOX, failing_device(2, 30, DEVICE_LOST, 1));
    const ProcessResult result = process.finish();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_CONTAINS(result.err, "VK_ERROR_DEVICE_LOST (-4)");
    EXPECT_CONTAINS(result.err, "VK_ERROR_INITIALIZATION_FAILED (-3)");
    std::vector<int> kept;
    const std::string words = "; reopening the device and continuing from ";
    for (size_t at = 0; (at = result.err.find(words, at)) != std::string::npos; ++at)
        kept.push_back(std::stoi(result.err.substr(at + words.size())));
    ASSERT_GE(kept.size(), 2u) << result.err;
    EXPECT_GE(kept.back(), 8);
    expect_same_rgb(read_exr(file("a.exr")), rendered(size + Words{"--spp", "256"}));
    EXPECT_EQ(codes_of(file("a.png")), codes_of(file("rendered.png")));
}

TEST_F(View, AfterFiveFailuresWithoutProgressItWritesWhatThereIs) {
    const Words size{"--size", "16x16"};
    Process& process = view(size, CORNELL_BOX, failing_device(1000, 25, OUT_OF_DEVICE_MEMORY));
    const ProcessResult result = process.finish();
    EXPECT_EQ(result.exit_code, 5);
    EXPECT_CONTAINS(result.err, "wrote cornell-box-1.exr\ncandela: error: vkQueueSubmit(");
    EXPECT_CONTAINS(result.err, "VK_ERROR_OUT_OF_DEVICE_MEMORY (-2)");
    const Image image = read_exr(file("cornell-box-1.exr"));
    const auto spp = uint32_t(std::get<float>(image.attributes.at("samplesPerPixel")));
    ASSERT_GE(spp, 8u);
    EXPECT_CONTAINS(result.err, "continuing from " + std::to_string(spp) + " samples per pixel");
    // A device that is slow because of other work is stopped between two submissions, when some pixels have
    // more samples.
    const std::vector<float>& counts = image.find("SampleCount.V")->values;
    EXPECT_EQ(std::ranges::min(counts), float(spp));
    if (std::ranges::max(counts) == float(spp))
        expect_same_rgb(image, rendered(size + Words{"--spp", std::to_string(spp)}));
}

TEST_F(View, OtherErrorsAreNotTriedAgain) {
    Process& process = view({"--size", "16x16"}, CORNELL_BOX, failing_device(1, 12, INITIALIZATION_FAILED));
    const ProcessResult result = process.finish();
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.err.find("reopening the device"), std::string::npos);
    EXPECT_CONTAINS(result.err, "VK_ERROR_INITIALIZATION_FAILED (-3)");
}

}  // namespace
}  // namespace candela
