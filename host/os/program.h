// The program and the one who runs it: arguments, environment, terminal.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace candela::os {

// Called once, before all else: a write that fails becomes an error instead of the end of the program, and
// texts are UTF-8 in both directions. Returns the words of the command line, the program's name
// first.
std::vector<std::string> start_program(int argc, char** argv);

// The value of an environment variable; empty if it is not set.
std::string environment(const char* name);

// Sets one that is not set yet, for the libraries that this program loads.
void set_default_environment(const char* name, const char* value);

// The folder for files that programs can make again, an absolute path; nothing if the environment names none.
std::optional<std::filesystem::path> cache_folder();

// Whether what is printed to stderr appears on a terminal that can clear a line.
bool stderr_is_terminal();

// "Linux 6.1.0 x86_64".
std::string system_text();

}  // namespace candela::os
