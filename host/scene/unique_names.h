// Unique names.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "base/text.h"

namespace candela {

// The names in use. Choosing one takes constant time: a hundred thousand things of a file may have the same
// name.
class UniqueNames {
  public:
    void note(const std::string& name) { taken_.insert(name); }

    // `name`, or, if that is in use, the first free name of `name (2)`, `name (3)` ...; it is then in use.
    std::string choose(const std::string& name) {
        if (taken_.insert(name).second) return name;
        uint64_t& next = next_.try_emplace(name, 2).first->second;
        std::string unique = concat(name, " (", next++, ')');
        while (!taken_.insert(unique).second)
            unique = concat(name, " (", next++, ')');
        return unique;
    }

  private:
    std::unordered_set<std::string> taken_;
    std::unordered_map<std::string, uint64_t> next_;  // For each name that was requested more than once.
};

}  // namespace candela
