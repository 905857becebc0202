// What a table that a shader inverts says, read by its promises alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shared/light.h"

namespace candela {

// How many of the 2^32 random words choose each place of a table.
inline std::vector<uint64_t> words_of(std::span<const CdfEntry> table) {
    std::vector<uint64_t> words(table.size());
    const uint32_t first = table[0].range & (CDF_MAX_PLACES - 1);
    uint64_t begin = 0;
    for (size_t i = first; i < table.size(); ++i) {
        const uint64_t end = uint64_t(table[i].last_word) + 1;
        words[i] = end - begin;
        begin = end;
    }
    return words;
}

}  // namespace candela
