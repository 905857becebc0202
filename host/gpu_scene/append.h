// Records at the end of an array.
#pragma once

#include <span>
#include <vector>

#include "base/math.h"

namespace candela {

// Appends the words of a record.
template <class Record>
void append(std::vector<uvec4>& out, const Record& record) {
    out.insert(out.end(), record.begin(), record.end());
}

// The words of entries of which two are packed together.
template <class Entry>
std::vector<uvec4> pack_pairs(std::span<const Entry> entries) {
    std::vector<uvec4> words;
    words.reserve((entries.size() + 1) / 2);
    for (size_t i = 0; i < entries.size(); i += 2)
        append(words, pack(entries[i], i + 1 < entries.size() ? entries[i + 1] : Entry{}));
    return words;
}

}  // namespace candela
