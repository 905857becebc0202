// Records at the end of an array.
#pragma once

#include <vector>

#include "base/math.h"

namespace candela {

// Appends the words of a record.
template <class Record>
void append(std::vector<uvec4>& out, const Record& record) {
    out.insert(out.end(), record.begin(), record.end());
}

}  // namespace candela
