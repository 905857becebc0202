// What the tests of windows share: an X server without a screen (Xvfb), its pixels, and control of its mouse
// and keys (xdotool). Where these are missing the tests are skipped, which CTest shows with the reason.
#pragma once

#include <algorithm>
#include <cstring>
#include <functional>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "cli/cli_fixture.h"
#include "film/accumulation.h"
#include "image/develop.h"
#include "image/texel_io.h"
#include "support/wait.h"

namespace candela {

class ViewTest : public CliTest {
  protected:
    static constexpr uvec2 SCREEN{800, 600};  // [pixels]

    void SetUp() override {
#ifndef CANDELA_VIEW
        GTEST_SKIP()
            << "this program was built without `candela view`: install libglfw3-dev and libimgui-dev";
#endif
        for (const char* program : {"Xvfb", "xdotool"}) {
            if (run_process({"/usr/bin/env", "sh", "-c", std::string("command -v ") + program}).exit_code !=
                0)
                GTEST_SKIP() << program << " is not here: install xvfb and xdotool";
        }
        server_.emplace(Words{"/usr/bin/env", "Xvfb", "-displayfd", "2", "-nolisten", "tcp", "-noreset",
                              "-screen", "0", "800x600x24", "-fbdir", file("")});
        // The display's number is a line; warnings may come before it.
        std::string line;
        for (int lines = 1; line.empty() || line.find_first_not_of("0123456789") != std::string::npos;
             ++lines) {
            ASSERT_TRUE(server_->wait_for_err("\n", lines)) << "Xvfb does not start: " << server_->err();
            std::istringstream said(server_->err());
            for (int i = 0; i < lines; ++i)
                std::getline(said, line);
        }
        display_ = ":" + line;
    }

    std::map<std::string, std::string> environment() const {
        // Windows belong to that display, regardless of the tests' own session.
        return {{"DISPLAY", display_},
                {"XDG_SESSION_TYPE", "x11"},
                {"CANDELA_VALIDATION", "1"},
                {"XDG_CACHE_HOME", CANDELA_CACHE}};
    }

    // Starts `candela view` of a scene, or without one if that is empty, in the test's folder, where it
    // writes its files. Without a window manager the window is at the top left of the screen.
    Process& view(const Words& arguments, const std::string& scene = CORNELL_BOX,
                  std::map<std::string, std::string> variables = {}) {
        variables.merge(environment());
        const Words scenes = scene.empty() ? Words{} : Words{scene};
        viewer_.emplace(Words{"/usr/bin/env", "-C", file(""), tested_program(), "view"} + scenes + arguments,
                        ProcessOptions{.environment = std::move(variables)});
        return *viewer_;
    }

    // Waits until the condition holds; throws std::runtime_error if the viewer ends before, or it never does.
    void wait_until(const std::string& what, const std::function<bool()>& holds) const {
        candela::wait_until(what, [&] {
            const bool ended = viewer_ && viewer_->has_ended();
            if (holds()) return true;
            if (ended) throw std::runtime_error("the viewer ended before " + what);
            return false;
        });
    }

    // Runs xdotool, which takes several commands at once.
    std::string xdotool(const Words& commands) const {
        return run_process(Words{"/usr/bin/env", "xdotool"} + commands,
                           ProcessOptions{.environment = environment()})
            .out;
    }
    // The title of the window of `candela view`, which has one as soon as it takes input; before that,
    // nothing.
    std::string title() const {
        std::string text = xdotool({"search", "--name", " samples per pixel", "getwindowname"});
        if (!text.empty()) text.pop_back();
        return text;
    }
    void wait_for_title(const std::string& expected) const {
        wait_until("the title is \"" + expected + "\"", [&] { return title() == expected; });
    }
    // Waits until the title says that the scene of that name has that many samples.
    void wait_for_samples(const std::string& name, int count) const {
        const std::string begin = name + ": " + std::to_string(count) + " samples per pixel";
        wait_until("the title begins with \"" + begin + "\"", [&] { return title().starts_with(begin); });
    }
    // The number of samples in the title; -1 if there is none.
    int samples() const {
        const std::string text = title();
        return text.empty() ? -1 : std::stoi(text.substr(text.find(": ") + 2));
    }
    bool says(const std::string& word) const {
        return title().find(", " + word) != std::string::npos;
    }

    // Drops a file onto the window.
    void drop(const std::string& path) const {
        const ProcessResult result =
            run_process({"/usr/bin/python3", CANDELA_DROP_FILE, " samples per pixel", path},
                        ProcessOptions{.environment = environment()});
        EXPECT_EQ(result.exit_code, 0) << result.err << "(python3-xlib drops files)";
    }

    // Presses a key when the window has the keyboard.
    void press(const std::string& key) const {
        wait_until("the window has the keyboard", [&] {
            const std::string focused = xdotool({"getwindowfocus", "-f", "getwindowname"});
            return focused.find(" samples per pixel") != std::string::npos;
        });
        xdotool({"key", key});
    }
    // Presses that key, which saves the next file of that name; returns its path.
    std::string saved_by(const std::string& key, const std::string& name) const {
        press(key);
        wait_until(name + " is there", [&] { return std::filesystem::exists(file(name)); });
        return file(name);
    }
    // Saves the picture of the scene of that name until it is at rest, with that size and that many samples
    // in every pixel. What is saved shows everything that was done before.
    Image picture_at_rest(const std::string& name, uvec2 size, float spp) const {
        Image image;
        wait_until("the picture is at rest", [&] {
            const std::string path = saved_by("x", name + "-1.exr");
            image = read_exr(path);
            std::filesystem::remove(path);
            const std::vector<float>& counts = image.find("SampleCount.V")->values;
            return image.full == size &&
                   std::ranges::all_of(counts, [&](float count) { return count == spp; });
        });
        return image;
    }

    // The screen: words of blue, green, red and nothing, row-major. Xvfb keeps it in a file, X's window dump:
    // 32-bit words, most significant byte first, of which word 0 is the header's size and word 19 the number
    // of colours, of twelve bytes each, that follow it.
    std::vector<uint32_t> screen() const {
        const std::string bytes = read_file(file("Xvfb_screen0"));
        const auto word = [&](size_t at) {
            uint32_t value = 0;
            for (size_t i = 0; i < 4; ++i)
                value = value << 8 | static_cast<unsigned char>(bytes.at(4 * at + i));
            return value;
        };
        std::vector<uint32_t> pixels(size_t{SCREEN.x} * SCREEN.y);
        std::memcpy(pixels.data(), &bytes.at(word(0) + 12 * word(19)), pixels.size() * sizeof(uint32_t));
        return pixels;
    }
    // How many of the window's codes differ by more than one step from what the image looks like.
    static size_t wrong_codes(const std::vector<uint32_t>& screen, const Image& image) {
        const std::vector<std::byte> codes = develop(image, {}).texels;
        const uint32_t width = image.data.width();
        size_t wrong = 0;
        for (size_t i = 0; i < image.pixel_count(); ++i) {
            const uint32_t shown = screen[i / width * SCREEN.x + i % width];
            for (size_t c = 0; c < 3; ++c)
                wrong += std::abs(int(shown >> (16 - 8 * c) & 255u) - int(codes[3 * i + c])) > 1;
        }
        return wrong;
    }

    // Whether the screen is black but for the pointer, which rests far from the window.
    bool shows_nothing(uvec2 size) const {
        const std::vector<uint32_t> pixels = screen();
        for (uint32_t i = 0; i < size.x * size.y; ++i) {
            if ((pixels[i / size.x * SCREEN.x + i % size.x] & 0xFFFFFFu) != 0) return false;
        }
        return true;
    }

    // Closes the window as its user would and expects a clean end, also by the validation layer.
    void expect_clean_end() {
        press("Escape");
        const ProcessResult result = viewer_->finish();
        EXPECT_EQ(result.exit_code, 0) << result.err;
    }

    std::string display_;
    std::optional<Process> server_;
    std::optional<Process> viewer_;
};

// The tests of `candela view`.
class View : public ViewTest {
  protected:
    // What `candela render` makes of the scene.
    Image rendered(const Words& arguments, const std::string& scene = CORNELL_BOX) const {
        const ProcessResult result = candela(
            Words{"render", scene, "-q", "-o", file("rendered.exr"), "-o", file("rendered.png")} + arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return read_exr(file("rendered.exr"));
    }
    // The codes of a PNG file, without what it says of itself.
    static std::vector<std::byte> codes_of(const std::string& png) {
        std::vector<std::string> warnings;
        return decode_texels(read_file(png), png, warnings).texels;
    }
    // The same pictures, bit for bit.
    static void expect_same_rgb(const Image& a, const Image& b) {
        EXPECT_EQ(a.full, b.full);
        EXPECT_EQ(image_hash(a), image_hash(b));
    }
};

}  // namespace candela
