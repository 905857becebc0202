// Warnings about a file, each kind once.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace candela {

class CountedWarnings {
  public:
    // The first warning of each kind is shown; the others are counted.
    void add(const std::string& kind, const std::string& text);

    // In the order of the first of each kind: `text`, or `text (12 times)`.
    std::vector<std::string> texts() const;

  private:
    struct Entry {
        std::string kind;
        std::string text;
        size_t count = 1;
    };

    std::vector<Entry> entries_;
};

}  // namespace candela
