// `candela completion`: scripts for shells, from the table of options.
// Ref: GNU, "Bash Reference Manual", section 8.6; "The Z Shell Manual", section 20; the page of fish's
// `complete`.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include "base/text.h"
#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/option_table.h"

namespace candela {
namespace {

// Lists of completions have short lines: a description up to the end of its first clause.
std::string summary(const std::string& description) {
    size_t end = description.size();
    for (const char* const stop : {". ", ": ", "; ", " ("})
        end = std::min(end, description.find(stop));
    return description.substr(0, end);
}

std::string escaped(const std::string& text, std::string_view special) {
    std::string result;
    for (const char c : text) {
        if (special.find(c) != std::string_view::npos) result += '\\';
        result += c;
    }
    return result;
}

std::string joined(const std::vector<std::string>& words, const char* separator) {
    std::string text;
    for (const std::string& word : words)
        text += (text.empty() ? "" : separator) + word;
    return text;
}

std::vector<OptionRow> options_of(const CommandRow& command) {
    std::vector<OptionRow> options;
    for (const OptionGroup& group : command.groups)
        options.insert(options.end(), group.options.begin(), group.options.end());
    return options;
}

std::vector<std::string> names_of(const std::vector<OptionRow>& options) {
    std::vector<std::string> names;
    for (const OptionRow& option : options)
        names.insert(names.end(), option.names.begin(), option.names.end());
    return names;
}

// What may stand where an option or operand takes a value.
std::string bash_values(const std::vector<std::string>& words, bool files) {
    return concat(" words=", shell_quoted(joined(words, " ")), files ? " files=1" : "");
}

std::string bash_script(const std::vector<CommandRow>& table) {
    std::string values, commands;
    for (const CommandRow& command : table) {
        const std::vector<OptionRow> options = options_of(command);
        for (const OptionRow& option : options) {
            if (!option.takes_value) continue;
            std::vector<std::string> calls;
            for (const std::string& name : option.names)
                calls.push_back(shell_quoted(command.name + ' ' + name));
            values += concat("        ", joined(calls, " | "), ')',
                             bash_values(option.choices, option.takes_file), " ;;\n");
        }
        std::vector<std::string> words;
        bool files = false;
        for (const OptionRow& operand : command.positionals) {
            words.insert(words.end(), operand.choices.begin(), operand.choices.end());
            files = files || operand.takes_file;
        }
        if (command.name.empty()) {
            for (const CommandRow& other : table)
                if (!other.name.empty()) words.push_back(other.name);
        }
        commands += concat("                ", shell_quoted(command.name),
                           ") options=", shell_quoted(joined(names_of(options), " ")),
                           bash_values(words, files), " ;;\n");
    }
    return concat(R"(_candela() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command='' options='' words='' files=''
    if ((COMP_CWORD > 1)); then command=${COMP_WORDS[1]}; fi
    case "$command $before" in
)",
                  values, R"(        *)
            case "$command" in
)",
                  commands, R"(            esac
            if [[ $word == -* ]]; then words=$options files=''; fi
            ;;
    esac
    COMPREPLY=()
    if [[ $words ]]; then COMPREPLY=($(compgen -W "$words" -- "$word")); fi
    if [[ $files ]]; then
        local IFS=$'\n'
        COMPREPLY+=($(compgen -f -- "$word"))
    fi
}
complete -o filenames -F _candela candela
)");
}

// ":VALUE:ACTION", as _arguments takes it.
std::string zsh_value(const OptionRow& option) {
    const std::string action = option.takes_file        ? "_files"
                               : option.choices.empty() ? " "
                                                        : concat('(', joined(option.choices, " "), ')');
    return concat(':', escaped(option.value, ":\\"), ':', action);
}

std::string zsh_option(const OptionRow& option) {
    const std::string once = option.repeats ? "*" : concat('(', joined(option.names, " "), ')');
    const std::string text = concat('[', escaped(summary(option.description), "[]\\"), ']',
                                    option.takes_value ? zsh_value(option) : "");
    const std::string names =
        option.names.size() > 1 ? concat('{', joined(option.names, ","), '}') : option.names[0];
    return concat(shell_quoted(once), names, shell_quoted(text));
}

std::string zsh_script(const std::vector<CommandRow>& table) {
    std::string words, cases;
    for (const CommandRow& command : table) {
        if (command.name.empty()) {
            for (const OptionRow& option : options_of(command))
                words += concat("        ",
                                shell_quoted(option.names.back() + ':' + summary(option.description)), '\n');
            continue;
        }
        words += concat("        ", shell_quoted(command.name + ':' + summary(command.description)), '\n');
        cases += concat("        ", command.name, ")\n            _arguments");
        for (const OptionRow& option : options_of(command))
            cases += concat(" \\\n                ", zsh_option(option));
        for (const OptionRow& operand : command.positionals)
            cases += concat(" \\\n                ",
                            shell_quoted(concat(operand.repeats ? "*" : "", zsh_value(operand))));
        cases += " ;;\n";
    }
    return concat(R"(#compdef candela
_candela() {
    local -a commands=(
)",
                  words, R"(    )
    if ((CURRENT == 2)); then
        _describe command commands
        return
    fi
    shift words
    ((CURRENT--))
    case $words[1] in
)",
                  cases, R"(    esac
}
if [[ $funcstack[1] == _candela ]]; then _candela "$@"; else compdef _candela candela; fi
)");
}

std::string fish_quoted(const std::string& text) {
    return '\'' + escaped(text, "'\\") + '\'';
}

std::string fish_line(const std::string& condition, const std::string& rest, const std::string& description) {
    return concat("complete -c candela -n ", fish_quoted(condition), rest, " -d ",
                  fish_quoted(summary(description)), '\n');
}

std::string fish_option(const OptionRow& option) {
    std::string text;
    for (const std::string& name : option.names)
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (option.takes_file) return text + " -r -F";
    if (!option.choices.empty()) return concat(text, " -x -a ", fish_quoted(joined(option.choices, " ")));
    return option.takes_value ? text + " -x" : text;
}

std::string fish_script(const std::vector<CommandRow>& table) {
    std::string script = "complete -c candela -f\n";
    for (const CommandRow& command : table) {
        const bool program = command.name.empty();
        if (!program)
            script += fish_line("__fish_use_subcommand", " -a " + command.name, command.description);
        const std::string condition =
            program ? "__fish_use_subcommand" : "__fish_seen_subcommand_from " + command.name;
        for (const OptionRow& option : options_of(command))
            script += fish_line(condition, fish_option(option), option.description);
        for (const OptionRow& operand : command.positionals) {
            const std::string values =
                operand.takes_file ? " -F" : concat(" -a ", fish_quoted(joined(operand.choices, " ")));
            script += fish_line(condition, values, operand.description);
        }
    }
    return script;
}

enum class Shell { bash, zsh, fish };
constexpr Choices<Shell, 3> SHELL_NAMES{{{"bash", Shell::bash}, {"zsh", Shell::zsh}, {"fish", Shell::fish}}};

std::string script_for(Shell shell, const std::vector<CommandRow>& table) {
    switch (shell) {
        case Shell::bash:
            return bash_script(table);
        case Shell::zsh:
            return zsh_script(table);
        case Shell::fish:
            break;
    }
    return fish_script(table);
}

}  // namespace

Command add_completion_command(CLI::App& app) {
    CLI::App* const command =
        app.add_subcommand("completion", "Print a script by which a shell completes calls of candela");
    const auto shell = std::make_shared<Shell>(Shell::bash);
    add_choice(*command, "SHELL", *shell, SHELL_NAMES, "The shell")->required();
    command->footer(
        "Examples:\n"
        "  candela completion bash > ~/.local/share/bash-completion/completions/candela\n"
        "  candela completion zsh > \"${fpath[1]}/_candela\"\n"
        "  candela completion fish > ~/.config/fish/completions/candela.fish");
    return {command, [&app, shell] {
                std::fputs(script_for(*shell, option_table(app)).c_str(), stdout);
                flush_results();
                return ExitCode::done;
            }};
}

}  // namespace candela
