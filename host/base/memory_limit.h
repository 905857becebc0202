// A limit on the program's memory. Allocations by `new` are counted, and refused if they would exceed the
// limit, so that no file can make the program use more.
#pragma once

#include <cstdint>
#include <new>
#include <optional>
#include <string>

#include "base/error.h"

namespace candela {

// Bytes allocated by `new`, and those of MemoryCharge.
uint64_t memory_in_use();

// The limit of the process; at first, there is none.
void set_memory_limit(uint64_t bytes);
uint64_t memory_limit();

// Three quarters of the machine's memory, or of what its control group allows, if that is less.
uint64_t default_memory_limit();

// A number of bytes, alone or with one of the units k, M, G, T, kB, MB ..., powers of 1000, or KiB, MiB ...,
// powers of 1024; nothing for anything else, for 0, and for more than 2^63.
std::optional<uint64_t> parse_memory_size(const std::string& text);

// Thrown by `new` instead of exceeding the limit.
class LimitReached : public std::bad_alloc {
  public:
    LimitReached(uint64_t wanted, uint64_t in_use) : needed_(in_use + wanted) {}

    // Limit of the whole process.
    uint64_t needed() const { return needed_; }

  private:
    uint64_t needed_;
};

// While one lives, the limit applies to its thread and to the helpers that this starts. It does not apply
// otherwise, since drivers and libraries end the program if `new` fails.
class LimitedMemory {
  public:
    LimitedMemory();
    LimitedMemory(const LimitedMemory&) = delete;
    LimitedMemory& operator=(const LimitedMemory&) = delete;
    ~LimitedMemory();

    // Whether one lives in this thread.
    static bool applies();
};

// Counts memory of a C library for as long as this lives. The constructor throws LimitReached.
class MemoryCharge {
  public:
    explicit MemoryCharge(uint64_t bytes);
    MemoryCharge(const MemoryCharge&) = delete;
    MemoryCharge& operator=(const MemoryCharge&) = delete;
    ~MemoryCharge();

  private:
    uint64_t bytes_;
};

// For messages: `, which needs at least 3.2 GiB, where 210.0 MiB are in use and --memory-limit allows 2.0
// GiB`, of an action that began with `before` in use; nothing if the machine itself has run out.
std::string shortage_text(const std::bad_alloc& error, uint64_t before);

// Returns action(). If memory does not suffice, throws Error `PLACE: there is not enough memory for WHAT`
// with the amount needed; the message begins with place().
template <class Place, class Action>
auto with_memory_for(const char* what, const Place& place, const Action& action) {
    const uint64_t before = memory_in_use();
    try {
        return action();
    } catch (const std::bad_alloc& error) {
        throw Error(place() + ": there is not enough memory for " + what + shortage_text(error, before) +
                        "; make it smaller, or use a larger machine",
                    ErrorKind::out_of_memory);
    }
}

}  // namespace candela
