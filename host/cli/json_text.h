// JSON as commands print and write it.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace candela {

// Lines of JSON without control characters. Names come from files and drivers: bytes that are not UTF-8
// become U+FFFD.
std::string json_text(const nlohmann::ordered_json& json);
// The same on one line.
std::string json_line(const nlohmann::ordered_json& json);

}  // namespace candela
