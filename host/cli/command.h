// The commands of candela. Each has a file of its own, which declares its options and does its work.
#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "base/exit_code.h"

namespace candela {

struct Command {
    CLI::App* app;                  // Its options; parsed() says whether the command was called.
    std::function<ExitCode()> run;  // Does the work with the options as parsed. Throws Error.
};

// Each adds one command to `app`. `command_line` is the whole call as the user typed it, for image files.
Command add_render_command(CLI::App& app, const std::string& command_line);
Command add_fidelity_command(CLI::App& app, const std::string& command_line);
Command add_info_command(CLI::App& app);
Command add_devices_command(CLI::App& app);
Command add_compare_command(CLI::App& app);
Command add_merge_command(CLI::App& app, const std::string& command_line);
Command add_denoise_command(CLI::App& app, const std::string& command_line);
Command add_plot_command(CLI::App& app);
Command add_selftest_command(CLI::App& app);
Command add_bench_command(CLI::App& app);
Command add_serve_command(CLI::App& app, const std::string& command_line);
Command add_view_command(CLI::App& app, const std::string& command_line);
// These describe `app`, which must outlive them.
Command add_completion_command(CLI::App& app);
Command add_manual_command(CLI::App& app);

}  // namespace candela
