// See os/interrupt.h. Signal handlers.
#include "os/interrupt.h"

#include <array>
#include <atomic>
#include <csignal>
#include <utility>

#include <unistd.h>

namespace candela::os {
namespace {

constexpr std::array SIGNALS{SIGINT, SIGTERM, SIGHUP};

std::atomic<bool> signalled = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not lock");

// What quit() says; unchanged while it may be called.
std::string last_words;
int last_code = 0;

// The next signal has its usual effect.
void note(int) {
    signalled = true;
    for (const int signal : SIGNALS) {
        struct sigaction action {};
        sigaction(signal, nullptr, &action);
        if (action.sa_handler == note) std::signal(signal, SIG_DFL);
    }
}

// Does only what a signal handler may.
void quit(int) {
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, last_words.data(), last_words.size());
    ::_exit(last_code);
}

}  // namespace

struct Interrupts::Handlers {
    explicit Handlers(void (*handler)(int)) {
        struct sigaction action {};
        action.sa_handler = handler;
        action.sa_flags = SA_RESTART;
        sigemptyset(&action.sa_mask);
        for (size_t i = 0; i < SIGNALS.size(); ++i) {
            sigaction(SIGNALS[i], nullptr, &old[i]);
            const bool stays = SIGNALS[i] == SIGHUP && old[i].sa_handler == SIG_IGN;
            if (!stays) sigaction(SIGNALS[i], &action, nullptr);
        }
    }
    Handlers(const Handlers&) = delete;
    Handlers& operator=(const Handlers&) = delete;
    ~Handlers() {
        for (size_t i = 0; i < SIGNALS.size(); ++i)
            sigaction(SIGNALS[i], &old[i], nullptr);
    }

    std::array<struct sigaction, SIGNALS.size()> old;
};

Interrupts::Interrupts() {
    signalled = false;
    handlers_ = std::make_unique<Handlers>(note);
}

Interrupts::Interrupts(int exit_code, std::string text) {
    last_words = std::move(text);
    last_code = exit_code;
    handlers_ = std::make_unique<Handlers>(quit);
}

Interrupts::~Interrupts() = default;

bool Interrupts::noted() const {
    return signalled;
}

}  // namespace candela::os
