// Ctrl-C and termination, caught so that what is rendered so far can be kept.
#pragma once

#include <csignal>

namespace candela {

// While it lives, the first SIGINT or SIGTERM only sets a flag; a second one ends the program at once. One at
// a time.
class InterruptGuard {
  public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    // Whether a signal has arrived.
    bool interrupted() const;

  private:
    struct sigaction old_interrupt_ {};
    struct sigaction old_terminate_ {};
};

}  // namespace candela
