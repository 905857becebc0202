// The commands and options of the program as a table, for completions and manual pages.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace candela {

struct OptionRow {
    std::vector<std::string> names{};    // With dashes, short ones first; none for a positional argument.
    std::string value;                   // What help calls it; empty for a flag.
    std::vector<std::string> choices{};  // Words that the value may be, where help lists them.
    std::string description;             // As in help.
    bool takes_value = false;
    bool repeats = false;     // May be given several times, each with a meaning of its own.
    bool takes_file = false;  // Or a folder.
};

struct OptionGroup {
    std::string title;  // As in help.
    std::vector<OptionRow> options;
};

struct CommandRow {
    std::string name;  // Empty for the program itself.
    std::string description, footer;
    std::vector<OptionRow> positionals{};
    std::vector<OptionGroup> groups{};  // Hidden options are left out.
};

// The program itself, then its commands, in the order of help.
std::vector<CommandRow> option_table(const CLI::App& program);

}  // namespace candela
