// Prints messages, and numbers as people read them.
#include "cli/console.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "base/error.h"
#include "base/printable.h"
#include "os/program.h"

namespace candela {

void print_warning(const std::string& message) {
    // On a terminal it replaces a live line, if there is one.
    std::fprintf(stderr, "%scandela: warning: %s\n", os::stderr_is_terminal() ? "\r\x1b[K" : "",
                 printable(message, MAX_MESSAGE_BYTES).c_str());
}

void print_warnings(const std::vector<std::string>& messages) {
    for (const std::string& line : summary_of(messages))
        print_warning(line);
}

void print_error(const std::string& message) {
    std::fprintf(stderr, "candela: error: %s\n", printable(message, MAX_MESSAGE_BYTES).c_str());
}

void print_note(const std::string& message) {
    std::fprintf(stderr, "%s\n", printable(message, MAX_MESSAGE_BYTES).c_str());
}

void flush_results() {
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        throw Error("cannot write to standard output; check where it goes");
    }
}

std::string fixed(double value, int digits) {
    char text[400];  // Room for the largest double.
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

std::string bytes_text(uint64_t bytes) {
    if (bytes < 1024) return std::to_string(bytes) + " B";
    double value = double(bytes) / 1024.0;
    const char* const units[] = {"KiB", "MiB", "GiB", "TiB"};
    size_t unit = 0;
    while (value >= 1024.0 && unit + 1 < std::size(units)) {
        value /= 1024.0;
        ++unit;
    }
    return fixed(value, 2) + ' ' + units[unit];
}

std::string duration_text(double seconds) {
    if (seconds < 59.95) return fixed(seconds, 1) + " s";
    const auto whole = static_cast<unsigned long long>(std::min(std::round(seconds), 1e15));
    const bool hours = whole >= 3600;
    char text[64];
    std::snprintf(text, sizeof text, hours ? "%llu h %02llu min" : "%llu min %02llu s",
                  hours ? whole / 3600 : whole / 60, hours ? whole / 60 % 60 : whole % 60);
    return text;
}

}  // namespace candela
