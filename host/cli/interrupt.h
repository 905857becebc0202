// Catches Ctrl-C, termination and the end of the terminal, so that the image so far is kept, or nothing is
// left behind.
#pragma once

#include "os/interrupt.h"

namespace candela {

// While it lives, each ends the program at once, with ExitCode::interrupted and a message that a scene was
// loaded.
class QuittingGuard {
  public:
    QuittingGuard();

  private:
    os::Interrupts interrupts_;
};

}  // namespace candela
