// How a scene is lit, apart from what its file says.
#pragma once

#include <CLI/CLI.hpp>

#include "load/lighting.h"

namespace candela {

struct LightingArguments : LightingOptions {
    // Declares them on `app`; this object must not move.
    void add_to(CLI::App& app);
};

}  // namespace candela
