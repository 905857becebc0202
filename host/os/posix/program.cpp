// See os/program.h.
#include "os/program.h"

#include <csignal>
#include <cstdlib>
#include <string_view>

#include <sys/utsname.h>
#include <unistd.h>

namespace candela::os {

std::vector<std::string> start_program(int argc, char** argv) {
    // A write beyond the limit on file sizes must be an ordinary error, not the end of the program.
    std::signal(SIGXFSZ, SIG_IGN);
    // So must a write to a pipe without a reader.
    std::signal(SIGPIPE, SIG_IGN);
    return argc > 0 ? std::vector<std::string>(argv, argv + argc) : std::vector<std::string>{"candela"};
}

std::string environment(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? "" : value;
}

void set_default_environment(const char* name, const char* value) {
    ::setenv(name, value, 0);
}

// By the XDG specification, a relative path is ignored.
std::optional<std::filesystem::path> cache_folder() {
    const std::filesystem::path cache = environment("XDG_CACHE_HOME");
    if (cache.is_absolute()) return cache;
    const std::filesystem::path home = environment("HOME");
    return home.is_absolute() ? std::optional(home / ".cache") : std::nullopt;
}

bool stderr_is_terminal() {
    const std::string terminal = environment("TERM");
    return ::isatty(STDERR_FILENO) != 0 && !terminal.empty() && terminal != "dumb";
}

std::string system_text() {
    utsname names{};
    if (::uname(&names) != 0) return "unknown";
    return std::string(names.sysname) + ' ' + names.release + ' ' + names.machine;
}

}  // namespace candela::os
