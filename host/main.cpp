// The program: runs the command line, and turns every error into a message and an exit code.
#include <csignal>
#include <exception>

#include "base/caught_error.h"
#include "base/exit_code.h"
#include "cli/console.h"
#include "cli/program.h"

int main(int argc, char** argv) {
    // A write beyond the limit on file sizes must be an ordinary error, not the end of the program.
    std::signal(SIGXFSZ, SIG_IGN);
    // So must a write to a pipe without a reader.
    std::signal(SIGPIPE, SIG_IGN);
    try {
        return int(candela::run_program(argc, argv));
    } catch (const std::exception&) {
        const candela::Error error = candela::caught_error();
        candela::print_error(error.what());
        return int(exit_code(error.kind()));
    }
}
