// Which images a command writes, and how.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "film/accumulation.h"
#include "image/tonemap.h"
#include "scene/names.h"

namespace candela {

inline constexpr Choices<Tonemap, 5> TONEMAP_NAMES{{{"linear", Tonemap::linear},
                                                    {"reinhard", Tonemap::reinhard},
                                                    {"aces", Tonemap::aces},
                                                    {"agx", Tonemap::agx},
                                                    {"neutral", Tonemap::neutral}}};

// How radiance becomes a PNG.
struct DevelopmentOptions {
    double exposure = 0.0;  // [EV].
    Tonemap tonemap = Tonemap::linear;

    // Declares them on `app`; this object must not move.
    void add_to(CLI::App& app);
};

struct ImageOutputs {
    std::vector<std::string> files;
    AovSelection aovs{true, true, true, true, true, true};  // In an EXR.
    bool half = false;                                      // EXR: R G B A and Albedo with 16 bits.
    DevelopmentOptions development;

    // Declares all but --aov on `app`; this object must not move.
    void add_to(CLI::App& app);
    void add_aovs_to(CLI::App& app);

    // The images besides R G B A that will be written: those selected, if one of the files is an EXR;
    // otherwise none.
    AovSelection written_aovs() const;
};

}  // namespace candela
