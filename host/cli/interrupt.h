// Catches Ctrl-C, termination and the end of the terminal, so that the image so far can be kept.
#pragma once

#include <array>
#include <csignal>

namespace candela {

// While it lives, the first SIGINT, SIGTERM or SIGHUP only sets a flag; a second one ends the program at
// once. A SIGHUP that was ignored before, as by nohup, stays ignored. Only one may exist at a time.
class InterruptGuard {
  public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    // Whether a signal has arrived.
    bool interrupted() const;

    static constexpr std::array SIGNALS{SIGINT, SIGTERM, SIGHUP};

  private:
    std::array<struct sigaction, SIGNALS.size()> old_;
};

}  // namespace candela
