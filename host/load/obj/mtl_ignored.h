// What candela ignores in a material library.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace candela {

// Statements and options, each once, by the reason why they are ignored.
class MtlIgnored {
  public:
    void add(std::string_view statement, std::string_view reason);

    // `file: ignored a, b (reason)`, in the order of the first of each reason.
    std::vector<std::string> warnings(const std::string& file) const;

  private:
    std::vector<std::pair<std::string, std::vector<std::string>>> statements_;  // By reason.
    std::set<std::pair<std::string, std::string>> known_;                       // The same, for lookup.
};

}  // namespace candela
