// See counted_warnings.h.
#include "load/obj/counted_warnings.h"

#include <algorithm>

#include "base/text.h"

namespace candela {

void CountedWarnings::add(const std::string& kind, const std::string& text) {
    const auto known = std::ranges::find(entries_, kind, &Entry::kind);
    if (known != entries_.end()) {
        ++known->count;
    } else {
        entries_.push_back({kind, text});
    }
}

std::vector<std::string> CountedWarnings::texts() const {
    std::vector<std::string> texts;
    for (const Entry& entry : entries_)
        texts.push_back(entry.count == 1 ? entry.text : concat(entry.text, " (", entry.count, " times)"));
    return texts;
}

}  // namespace candela
