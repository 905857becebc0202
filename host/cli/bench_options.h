// The options of `candela bench`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "bench/options.h"
#include "cli/arguments.h"
#include "cli/rendering_options.h"

namespace candela {

enum class BenchGroup { traversal, instances, build, render, first_pixel };
inline constexpr Choices<BenchGroup, 5> BENCH_GROUP_NAMES{{{"traversal", BenchGroup::traversal},
                                                           {"instances", BenchGroup::instances},
                                                           {"build", BenchGroup::build},
                                                           {"render", BenchGroup::render},
                                                           {"first-pixel", BenchGroup::first_pixel}}};

// The arguments of the command line.
struct BenchArguments {
    std::vector<std::string> scenes;  // Empty: the embedded Cornell box.
    std::vector<BenchGroup> only{BenchGroup::traversal, BenchGroup::instances, BenchGroup::build,
                                 BenchGroup::render, BenchGroup::first_pixel};
    std::optional<std::string> json;  // "-": stdout.
    BenchOptions bench;
    std::optional<double> seconds;
    std::optional<std::string> reference;
    RenderingOptions rendering;

    // Declares all options on `app`, which fills them in when it parses; this object must not move.
    void add_to(CLI::App& app);
};

}  // namespace candela
