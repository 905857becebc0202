// The frames of an animation that `candela render` shows.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace candela {

struct FrameOptions {
    std::optional<std::vector<uint32_t>> frames;  // Their numbers, in order; empty: all.
    double fps = 24.0;                            // Frame f is at f / fps [s].
    bool seed_per_frame = false;

    // Declares them on `app`, after the options of glTF files; this object must not move.
    void add_to(CLI::App& app);

    bool wants_all() const { return frames && frames->empty(); }
    // Whether a scene has several pictures for its frames, or may have.
    bool are_several() const { return frames && frames->size() != 1; }
    // The frames between two times of the file's animation [s], both included. Throws Error (usage), which
    // begins with the name of the scene's file, if there are too many, or none.
    std::vector<uint32_t> between(const std::string& file, std::pair<double, double> times) const;
};

}  // namespace candela
