// See interrupt.h.
#include "cli/interrupt.h"

#include <string>

#include "base/exit_code.h"
#include "os/program.h"

namespace candela {

QuittingGuard::QuittingGuard()
    : interrupts_(int(ExitCode::interrupted),
                  std::string(os::stderr_is_terminal() ? "\r\x1b[K" : "") +
                      "candela: error: interrupted while the scene was loaded\n") {}

}  // namespace candela
