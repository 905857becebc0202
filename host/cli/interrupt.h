// Catches Ctrl-C, termination and the end of the terminal, so that the image so far is kept, or nothing is
// left behind.
#pragma once

#include <array>
#include <csignal>

namespace candela {

// What SIGINT, SIGTERM and SIGHUP do.
enum class OnSignal {
    note,  // The first only sets a flag; a second one ends the program at once.
    quit,  // Each ends the program at once, with ExitCode::interrupted and a message that a scene was loaded.
};

// Determines what signals do while it lives. A SIGHUP that was ignored before, as by nohup, stays ignored.
// Only one may exist at a time.
class InterruptGuard {
  public:
    explicit InterruptGuard(OnSignal on_signal = OnSignal::note);
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    // Whether a signal has been noted.
    bool interrupted() const;

    static constexpr std::array SIGNALS{SIGINT, SIGTERM, SIGHUP};

  private:
    std::array<struct sigaction, SIGNALS.size()> old_;
};

}  // namespace candela
