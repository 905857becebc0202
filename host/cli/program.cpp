// Help, version, dispatch, and the errors of a command line.
#include "cli/program.h"

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/console.h"
#include "session/version.h"

namespace candela {

// Declares help, version and all commands on `app`, and returns the commands.
static std::vector<Command> declare_program(CLI::App& app, const std::string& command_line) {
    app.name("candela");
    app.description("candela: a physically based path tracer for any Vulkan device, GPU or CPU");
    app.set_version_flag("--version", "candela " CANDELA_VERSION "\nbuilt with " CANDELA_BUILT_WITH,
                         "Print the version, and those of what the program is built with, and exit");
    app.require_subcommand(0,
                           1);  // Further names of commands are words like others: `candela manual render`.
    // Commands inherit the column width, but must not inherit the footer, which is therefore set last.
    app.get_formatter()->column_width(36);
    std::vector<Command> commands{add_render_command(app, command_line),
                                  add_fidelity_command(app, command_line),
                                  add_view_command(app, command_line),
                                  add_info_command(app),
                                  add_devices_command(app),
                                  add_compare_command(app),
                                  add_merge_command(app, command_line),
                                  add_denoise_command(app, command_line),
                                  add_plot_command(app),
                                  add_selftest_command(app),
                                  add_bench_command(app),
                                  add_serve_command(app, command_line),
                                  add_completion_command(app),
                                  add_manual_command(app)};
    app.footer(
        "`candela COMMAND --help` lists the options of a command.\n\n"
        "Exit codes: 0 done, 1 failed, 2 wrong usage, 3 no suitable device, 4 device lost,\n"
        "            5 out of memory, 6 images differ, 7 time over (--batch-time),\n"
        "            130 interrupted (with a valid partial image)\n"
        "Environment: CANDELA_OIDN=FILE names the library Open Image Denoise;\n"
        "             CANDELA_NO_CACHE=1 disables the cache of compiled kernels ($XDG_CACHE_HOME/candela);\n"
        "             CANDELA_VALIDATION=1 turns on the Vulkan validation layer; its messages are errors");
    return commands;
}

// The call as one line that a shell would accept: words with special characters are quoted.
static std::string command_line_text(const std::vector<std::string>& words) {
    std::string line;
    for (const std::string& word : words) {
        const bool plain =
            !word.empty() && word.find_first_of(" \t\n\"'\\$`&|;<>()*?[]{}!#~") == std::string::npos;
        if (!line.empty()) line += ' ';
        line += plain ? word : shell_quoted(word);
    }
    return line;
}

// The command that was called, or null.
static const CLI::App* find_parsed(const CLI::App& app) {
    const auto parsed = app.get_subcommands();
    return parsed.empty() ? nullptr : parsed.front();
}

static std::string explain(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App* const command = find_parsed(app);
    const std::string help =
        command == nullptr ? "candela --help" : "candela " + command->get_name() + " --help";
    if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr)
        return std::string(error.what()) + "; see " + help;
    const std::string word = app.remaining(true).front();
    const char* const kind =
        command == nullptr && word.front() != '-' ? "unknown command \"" : "unknown argument \"";
    return kind + word + "\"; see " + help;
}

// Parses the command line into `app`. Returns false if help or the version was asked for, and has been
// printed.
static bool parse_command_line(CLI::App& app, const std::vector<std::string>& words) {
    try {
        app.parse(std::vector<std::string>(words.rbegin(), words.rend() - 1));  // The last one first.
    } catch (const CLI::Success& help_or_version) {
        app.exit(help_or_version);
        flush_results();
        return false;
    } catch (const CLI::ParseError& error) {
        throw Error(explain(app, error), ErrorKind::request);
    }
    return true;
}

ExitCode run_program(const std::vector<std::string>& words) {
    CLI::App app;
    app.allow_windows_style_options(false);  // A scene may be named /scenes/box.json on Windows, too.
    const std::vector<Command> commands = declare_program(app, command_line_text(words));
    if (!parse_command_line(app, words)) return ExitCode::done;
    for (const Command& command : commands) {
        if (command.app->parsed()) return command.run();
    }
    throw Error(
        "no command given; use render, fidelity, view, info, devices, compare, merge, denoise, plot, "
        "selftest, bench, serve, completion or manual, or see candela --help",
        ErrorKind::request);
}

}  // namespace candela
