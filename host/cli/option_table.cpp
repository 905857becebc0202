// See option_table.h.
#include "cli/option_table.h"

#include <algorithm>

#include "cli/arguments.h"

namespace candela {
namespace {

// Help writes choices as "EV|auto|first": words in lower case, and in capitals what stands for a value.
bool is_choice(const std::string& part) {
    return part.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos &&
           part.find_first_of("abcdefghijklmnopqrstuvwxyz0123456789") != std::string::npos;
}

bool names_files(const std::string& type) {
    return std::ranges::any_of(std::initializer_list<const char*>{"FILE", "DIR", "FOLDER", "BACKGROUND"},
                               [&](const char* word) { return type.find(word) != std::string::npos; });
}

OptionRow row_of(const CLI::Option& option) {
    OptionRow row{.value = option.get_items_expected_max() > 0 ? option.get_type_name() : "",
                  .description = option.get_description(),
                  .takes_value = option.get_items_expected_max() > 0,
                  .repeats = option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll};
    for (const std::string& name : option.get_snames())
        row.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames())
        row.names.push_back("--" + name);
    for (const std::string& part : split(row.value, '|')) {
        if (is_choice(part)) row.choices.push_back(part);
    }
    row.takes_file = option.get_positional() ? row.choices.empty() : names_files(row.value);
    if (option.get_positional()) row.value = option.get_name(true);
    return row;
}

CommandRow row_of(const CLI::App& command) {
    CommandRow row{.name = command.get_parent() != nullptr ? command.get_name() : "",
                   .description = command.get_description(),
                   .footer = command.get_footer()};
    for (const CLI::Option* option : command.get_options()) {
        if (option->get_group().empty()) continue;
        OptionRow entry = row_of(*option);
        if (option->get_positional()) {
            row.positionals.push_back(std::move(entry));
            continue;
        }
        auto group = std::ranges::find(row.groups, option->get_group(), &OptionGroup::title);
        if (group == row.groups.end()) group = row.groups.insert(group, {option->get_group(), {}});
        group->options.push_back(std::move(entry));
    }
    return row;
}

}  // namespace

std::vector<CommandRow> option_table(const CLI::App& program) {
    std::vector<CommandRow> rows{row_of(program)};
    for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; }))
        rows.push_back(row_of(*command));
    return rows;
}

}  // namespace candela
