// What a command says on stderr.
#pragma once

#include <CLI/CLI.hpp>

#include "scene/names.h"

namespace candela {

enum class ProgressStyle { automatic, json, none };
inline constexpr Choices<ProgressStyle, 3> PROGRESS_NAMES{
    {{"auto", ProgressStyle::automatic}, {"json", ProgressStyle::json}, {"none", ProgressStyle::none}}};

struct MessageOptions {
    ProgressStyle progress = ProgressStyle::automatic;
    bool quiet = false;
    bool verbose = false;

    // Declares them on `app`; this object must not move.
    void add_to(CLI::App& app);
    // How progress is shown: not at all if the command shall be quiet.
    ProgressStyle progress_style() const { return quiet ? ProgressStyle::none : progress; }
};

}  // namespace candela
