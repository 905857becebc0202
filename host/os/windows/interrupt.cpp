// See os/interrupt.h. The system calls handlers in a thread of their own.
#include "os/interrupt.h"

#include <atomic>
#include <utility>

#include "os/windows/calls.h"

namespace candela::os {
namespace {

std::atomic<bool> signalled = false;

// What quit() says; unchanged while it may be called.
std::string last_words;
int last_code = 0;

// When the console is closed, or the user logs off, the program ends as soon as this returns, or after some
// seconds.
BOOL WINAPI note(DWORD event) {
    const bool again = signalled.exchange(true);
    if (event != CTRL_C_EVENT && event != CTRL_BREAK_EVENT) Sleep(INFINITE);
    return again ? FALSE : TRUE;
}

BOOL WINAPI quit(DWORD) {
    DWORD count = 0;
    WriteFile(GetStdHandle(STD_ERROR_HANDLE), last_words.data(), DWORD(last_words.size()), &count, nullptr);
    TerminateProcess(GetCurrentProcess(), UINT(last_code));
    return TRUE;
}

}  // namespace

struct Interrupts::Handlers {
    explicit Handlers(PHANDLER_ROUTINE routine) : handler(routine) { SetConsoleCtrlHandler(handler, TRUE); }
    Handlers(const Handlers&) = delete;
    Handlers& operator=(const Handlers&) = delete;
    ~Handlers() { SetConsoleCtrlHandler(handler, FALSE); }

    PHANDLER_ROUTINE handler;
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
