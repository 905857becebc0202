// The program: runs the command line, and turns every error into a message and an exit code.
#include <exception>

#include "base/caught_error.h"
#include "base/exit_code.h"
#include "cli/console.h"
#include "cli/program.h"
#include "os/program.h"

int main(int argc, char** argv) {
    const std::vector<std::string> words = candela::os::start_program(argc, argv);
    try {
        return int(candela::run_program(words));
    } catch (const std::exception&) {
        const candela::Error error = candela::caught_error();
        candela::print_error(error.what());
        return int(exit_code(error.kind()));
    }
}
