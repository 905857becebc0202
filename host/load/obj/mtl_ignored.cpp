// See mtl_ignored.h.
#include "load/obj/mtl_ignored.h"

#include <algorithm>

#include "base/printable.h"
#include "base/text.h"

namespace candela {

void MtlIgnored::add(std::string_view statement, std::string_view reason) {
    auto place = std::ranges::find(statements_, reason, [](const auto& entry) { return entry.first; });
    if (place == statements_.end()) place = statements_.insert(place, {std::string(reason), {}});
    if (known_.emplace(reason, statement).second) place->second.emplace_back(statement);
}

std::vector<std::string> MtlIgnored::warnings(const std::string& file) const {
    std::vector<std::string> result;
    for (const auto& [reason, statements] : statements_)
        result.push_back(concat(file, ": ignored ", joined(statements), " (", reason, ')'));
    return result;
}

}  // namespace candela
