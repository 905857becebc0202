// The command line as a whole: from its words to the command that they name.
#pragma once

#include <string>
#include <vector>

#include "base/exit_code.h"

namespace candela {

// Parses the command line, whose first word is the program's name, and runs the command; help and version go
// to stdout. Returns the exit code of a run that did its work. Throws Error (request) that says what is wrong
// with the command line, and the Errors of the command.
ExitCode run_program(const std::vector<std::string>& words);

}  // namespace candela
