// `candela manual`: pages for `man`, from the table of options.
// Ref: man(7) of groff.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "base/file.h"
#include "base/text.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/option_table.h"
#include "session/version.h"

namespace candela {
namespace {

// Text for roff, which takes a backslash for a command, a dash for a hyphen, and a full stop or an apostrophe
// at the beginning of a line for a request.
std::string roff(const std::string& text) {
    std::string result;
    for (const char c : text) {
        const bool begins = result.empty() || result.back() == '\n';
        if (begins && (c == '.' || c == '\'')) result += "\\&";
        if (c == '\\') {
            result += "\\e";
        } else if (c == '-') {
            result += "\\-";
        } else if (c == '`') {
            result += "\\(ga";
        } else if (c == '^') {
            result += "\\(ha";
        } else if (c == '~') {
            result += "\\(ti";
        } else {
            result += c;
        }
    }
    return result;
}

std::string bold(const std::string& text) {
    return "\\fB" + roff(text) + "\\fR";
}

std::string italic(const std::string& text) {
    return "\\fI" + roff(text) + "\\fR";
}

std::string entry(const OptionRow& option) {
    std::string names;
    for (const std::string& name : option.names)
        names += (names.empty() ? "" : ", ") + bold(name);
    const std::string value = option.value.empty() ? "" : italic(option.value);
    const char* const between = names.empty() || value.empty() ? "" : " ";
    return concat(".TP\n", names, between, value, '\n', roff(option.description), '\n');
}

std::string page_name(const CommandRow& command) {
    return command.name.empty() ? "candela" : "candela-" + command.name;
}

std::string see_also(const std::vector<CommandRow>& table, const CommandRow& command) {
    std::string names;
    for (const CommandRow& other : table) {
        const bool related = command.name.empty() != other.name.empty();  // The program with its commands.
        if (related) names += concat(names.empty() ? "" : ",\n", ".BR ", roff(page_name(other)), " (1)");
    }
    return names;
}

std::string page(const std::vector<CommandRow>& table, const CommandRow& command) {
    const std::string name = roff(page_name(command));
    std::string text = concat(".TH ", name, R"( 1 "" "candela )", CANDELA_VERSION, "\"\n.SH NAME\n", name,
                              " \\- ", roff(command.description), "\n.SH SYNOPSIS\n", bold("candela"), ' ');
    text += command.name.empty() ? italic("COMMAND") : bold(command.name);
    text += " [" + italic("OPTIONS") + ']';
    for (const OptionRow& operand : command.positionals)
        text += ' ' + italic(operand.value) + (operand.repeats ? "..." : "");
    text += '\n';
    if (command.name.empty()) {
        text += ".SH COMMANDS\n";
        for (const CommandRow& other : table)
            if (!other.name.empty())
                text += concat(".TP\n", bold(other.name), '\n', roff(other.description), '\n');
    }
    text += ".SH OPTIONS\n";
    for (const OptionRow& operand : command.positionals)
        text += entry(operand);
    for (const OptionGroup& group : command.groups) {
        if (group.title != "Options") text += concat(".SS ", roff(group.title), '\n');
        for (const OptionRow& option : group.options)
            text += entry(option);
    }
    if (!command.footer.empty()) text += concat(".SH NOTES\n.nf\n", roff(command.footer), "\n.fi\n");
    return text + ".SH SEE ALSO\n" + see_also(table, command) + '\n';
}

}  // namespace

Command add_manual_command(CLI::App& app) {
    struct Arguments {
        std::string command, folder;
    };
    CLI::App* const command =
        app.add_subcommand("manual", "Print a page of the manual for man: of candela, or of a command");
    const auto arguments = std::make_shared<Arguments>();
    command->add_option("COMMAND", arguments->command, "The command (default: candela itself)")
        ->type_name("");
    command->add_option("-o,--output", arguments->folder, "Write all pages into this folder instead")
        ->type_name("FOLDER")
        ->take_last();
    command->footer("Example:\n  candela manual render | man -l -");
    return {
        command, [&app, arguments] {
            const std::vector<CommandRow> table = option_table(app);
            if (!arguments->folder.empty()) {
                for (const CommandRow& row : table)
                    write_file_atomically(std::filesystem::path(arguments->folder) / (page_name(row) + ".1"),
                                          page(table, row));
                return ExitCode::done;
            }
            const auto row = std::ranges::find(table, arguments->command, &CommandRow::name);
            if (row == table.end()) {
                throw Error(
                    concat("COMMAND: there is no command \"", arguments->command, "\"; see candela --help"),
                    ErrorKind::request);
            }
            std::fputs(page(table, *row).c_str(), stdout);
            flush_results();
            return ExitCode::done;
        }};
}

}  // namespace candela
