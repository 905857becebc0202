// See quote.h.
#include "load/quote.h"

#include <nlohmann/json.hpp>

namespace candela {

std::string quote(std::string_view text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '"' || c == '\\') escaped += '\\';
        escaped += c;
    }
    return '"' + printable(escaped, MOST_NAME_BYTES) + '"';
}

std::string json_string(std::string_view text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace candela
