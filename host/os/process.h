// This program among others: who it is, and running others.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace candela::os {

int process_id();
int parent_process_id();

// Whether a process with that number may still run; true if this user may not know.
bool may_run(int process);

// What tells this computer since its start from all others, and from itself before; empty if the system does
// not say.
std::string computer_since_start();

// The file of this program; empty if the system does not say.
std::filesystem::path program_file();

struct ProgramCall {
    // The program, found as a shell finds it, and its arguments.
    std::vector<std::string> words;
    // "NAME=value", added to our environment or instead of what is there.
    std::vector<std::string> variables;
    // A file for all that it prints, instead of our streams.
    std::optional<std::filesystem::path> output;
};

struct ProgramEnd {
    bool exited = false;       // Otherwise the system ended it.
    int code = 0;              // Of the exit, or the number of what ended it.
    double cpu_seconds = 0.0;  // Of the program and those that it waited for.

    bool succeeded() const { return exited && code == 0; }
};

// Runs a program to its end. Throws std::system_error if it cannot be started.
ProgramEnd run_program(const ProgramCall& call);

}  // namespace candela::os
