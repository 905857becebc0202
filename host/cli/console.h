// Messages on stderr, and numbers as people read them. stdout is only for results.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace candela {

// Messages are lines: unprintable characters are escaped, and a message longer than MAX_MESSAGE_BYTES is
// cut.

// Prints `candela: warning: MESSAGE` to stderr.
void print_warning(const std::string& message);

// Prints the summary_of() many warnings.
void print_warnings(const std::vector<std::string>& messages);

// Prints `candela: error: MESSAGE` to stderr.
void print_error(const std::string& message);

// Prints the message alone to stderr.
void print_note(const std::string& message);

// Sends buffered results to stdout. Throws Error if they, or any before, could not be written.
void flush_results();

// `value` with that many digits after the decimal point.
std::string fixed(double value, int digits);

// A number of bytes for people: "512 B", "1.50 MiB".
std::string bytes_text(uint64_t bytes);

// A duration for people: "9.3 s", "2 min 05 s", "3 h 07 min"; `seconds` is not negative.
std::string duration_text(double seconds);

}  // namespace candela
