// See frame_options.h.
#include "cli/frame_options.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "base/text.h"
#include "cli/arguments.h"

namespace candela {
namespace {

constexpr uint32_t LAST_FRAME = 999'999, MOST_FRAMES = 100'000;

// Adds the frames of "A", "A..B" or "A..B:STEP"; returns false for anything else.
bool add_frames(std::string text, std::vector<uint32_t>& frames) {
    std::optional<uint32_t> step = 1;
    if (const size_t colon = text.find(':'); colon != std::string::npos) {
        step = parse_uint(text.substr(colon + 1), 1, LAST_FRAME);
        text.resize(colon);
        if (text.find("..") == std::string::npos) return false;
    }
    const size_t dots = text.find("..");
    const auto first = parse_uint(text.substr(0, dots), 0, LAST_FRAME);
    const auto last = dots == std::string::npos ? first : parse_uint(text.substr(dots + 2), 0, LAST_FRAME);
    if (!step || !first || !last || *last < *first) return false;
    for (uint32_t frame = *first; frame <= *last; frame += *step) {
        if (frames.size() == MOST_FRAMES) return false;
        frames.push_back(frame);
    }
    return true;
}

std::optional<std::vector<uint32_t>> parse_frames(const std::string& text) {
    std::vector<uint32_t> frames;
    if (text == "all") return frames;
    for (const std::string& part : split(text, ',')) {
        if (!add_frames(part, frames)) return std::nullopt;
    }
    if (std::set(frames.begin(), frames.end()).size() != frames.size()) return std::nullopt;
    return frames;
}

std::optional<double> parse_fps(const std::string& text) {
    const auto fps = parse_number(text);
    return fps && *fps >= 0.001 && *fps <= 100'000.0 ? fps : std::nullopt;
}

}  // namespace

void FrameOptions::add_to(CLI::App& app) {
    app.option_defaults()->group("Frames of glTF animations (see docs/animation.md)");
    CLI::Option* const shown =
        add_value(app, "--frames", frames, parse_frames,
                  concat("all, or whole numbers from 0 to ", LAST_FRAME,
                         " such as 7, 1..120, 1..120:2 or 1,5,9..12, each once, with A <= B in A..B:STEP and "
                         "a step of "
                         "at least 1; at most ",
                         MOST_FRAMES, " frames"),
                  "A picture of each of these frames, B included; all: of the whole animation")
            ->type_name("A..B[:STEP]")
            ->excludes(app.get_option("--time"));
    add_value(app, "--fps", fps, parse_fps, "a number of frames per second from 0.001 to 100000, such as 24",
              "Frame N is at N / FPS seconds of the animation (default: 24)")
        ->type_name("FPS")
        ->needs(shown);
    app.add_flag("--seed-per-frame", seed_per_frame,
                 "Other noise in each frame: --seed plus the frame's number is its seed")
        ->needs(shown);
}

std::vector<uint32_t> FrameOptions::between(const std::string& file, std::pair<double, double> times) const {
    // Times of keys are rounded to floats.
    constexpr double ROUNDING = 0.01;
    const double first = std::max(0.0, std::ceil(times.first * fps - ROUNDING));
    const double last = std::floor(times.second * fps + ROUNDING);
    const auto refuse = [&](const std::string& what) {
        throw Error(concat(file, ": --frames all: the animation lasts from ", number_text(times.first, 6),
                           " s to ", number_text(times.second, 6), " s, ", what),
                    ErrorKind::request);
    };
    if (last < first) refuse("between two frames; name frames, or give more frames per second (--fps)");
    if (last > LAST_FRAME || last - first >= MOST_FRAMES) {
        refuse(concat("which is more than ", MOST_FRAMES, " frames or beyond frame ", LAST_FRAME,
                      "; name frames, or give fewer frames per second (--fps)"));
    }
    std::vector<uint32_t> all;
    for (auto frame = uint32_t(first); frame <= uint32_t(last); ++frame)
        all.push_back(frame);
    return all;
}

}  // namespace candela
