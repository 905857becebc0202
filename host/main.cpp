// The program: runs the command line, and turns every error into a message and an exit code.
#include <csignal>
#include <exception>
#include <new>
#include <string>

#include "base/error.h"
#include "cli/console.h"
#include "cli/exit_code.h"
#include "cli/program.h"

int main(int argc, char** argv) {
    using candela::ExitCode;
    // A write beyond the limit on file sizes must be an ordinary error, not the end of the program.
    std::signal(SIGXFSZ, SIG_IGN);
    // So must a write to a pipe without a reader.
    std::signal(SIGPIPE, SIG_IGN);
    try {
        return int(candela::run_program(argc, argv));
    } catch (const candela::Error& error) {
        candela::print_error(error.what());
        return int(exit_code(error.kind()));
    } catch (const std::bad_alloc&) {
        candela::print_error("the computer has too little memory; use a smaller picture or scene");
        return int(ExitCode::out_of_memory);
    } catch (const std::exception& error) {
        candela::print_error(std::string("unexpected: ") + error.what() +
                             "; this is a bug, please report it");
        return int(ExitCode::failed);
    }
}
