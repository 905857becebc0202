// The signal handler.
#include "cli/interrupt.h"

#include <atomic>

namespace candela {

static std::atomic<bool> signalled = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not lock");

// Whatever signal comes next has its usual effect.
static void on_signal(int) {
    signalled = true;
    for (const int signal : InterruptGuard::SIGNALS) {
        struct sigaction action {};
        sigaction(signal, nullptr, &action);
        if (action.sa_handler == on_signal) std::signal(signal, SIG_DFL);
    }
}

InterruptGuard::InterruptGuard() {
    signalled = false;
    struct sigaction action {};
    action.sa_handler = on_signal;
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
