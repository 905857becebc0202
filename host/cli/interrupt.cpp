// The signal handler.
#include "cli/interrupt.h"

#include <atomic>
#include <string_view>

#include <unistd.h>

#include "base/exit_code.h"
#include "cli/console.h"

namespace candela {

static std::atomic<bool> signalled = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not lock");

// The next signal has its usual effect.
static void on_signal(int) {
    signalled = true;
    for (const int signal : InterruptGuard::SIGNALS) {
        struct sigaction action {};
        sigaction(signal, nullptr, &action);
        if (action.sa_handler == on_signal) std::signal(signal, SIG_DFL);
    }
}

static std::atomic<bool> clears_line = false;

// Does only what a signal handler may.
static void quit_on_signal(int) {
    constexpr std::string_view CLEAR = "\r\x1b[K";
    constexpr std::string_view MESSAGE = "candela: error: interrupted while the scene was loaded\n";
    bool written = true;
    if (clears_line) written = ::write(STDERR_FILENO, CLEAR.data(), CLEAR.size()) > 0;
    if (written) written = ::write(STDERR_FILENO, MESSAGE.data(), MESSAGE.size()) > 0;
    ::_exit(int(ExitCode::interrupted));
}

InterruptGuard::InterruptGuard(OnSignal on_signal_do) {
    signalled = false;
    clears_line = stderr_is_terminal();
    struct sigaction action {};
    action.sa_handler = on_signal_do == OnSignal::quit ? quit_on_signal : on_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < SIGNALS.size(); ++i) {
        sigaction(SIGNALS[i], nullptr, &old_[i]);
        const bool stays = SIGNALS[i] == SIGHUP && old_[i].sa_handler == SIG_IGN;
        if (!stays) sigaction(SIGNALS[i], &action, nullptr);
    }
}

InterruptGuard::~InterruptGuard() {
    for (size_t i = 0; i < SIGNALS.size(); ++i)
        sigaction(SIGNALS[i], &old_[i], nullptr);
}

bool InterruptGuard::interrupted() const {
    return signalled;
}

}  // namespace candela
