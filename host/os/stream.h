// Streams between programs, which are read and written without waiting for ever.
#pragma once

#include <chrono>
#include <cstddef>
#include <span>
#include <string_view>

namespace candela::os {

inline constexpr int STANDARD_INPUT = 0;

struct StreamStep {
    size_t bytes = 0;    // How many were read or written; 0 if it took too long.
    bool ended = false;  // Nothing follows: the other side is gone, or the stream has failed.
};

// Reads what is there. Waits at most this long for it.
StreamStep read_some(int file, std::span<char> buffer, std::chrono::milliseconds patience);

// Writes a part of `bytes`. Waits at most this long until the other side makes room.
StreamStep write_some(int file, std::string_view bytes, std::chrono::milliseconds patience);

// Whether somebody may still read what is written to it.
bool has_reader(int file);

// Another number for the program's standard output, which from now on goes to standard error: so libraries
// that print write nothing between our bytes. Negative if the program has no
// standard output.
int take_standard_output();

}  // namespace candela::os
