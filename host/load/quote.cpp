// See quote.h.
#include "load/quote.h"

#include <nlohmann/json.hpp>

namespace candela {
namespace {

thread_local bool hidden = false;

}  // namespace

HiddenValues::HiddenValues(const FileReach& reach) : were_hidden_(hidden) {
    hidden = !reach.is_anywhere();
}

HiddenValues::~HiddenValues() {
    hidden = were_hidden_;
}

std::string shown(std::string text) {
    return hidden ? "(not shown)" : text;
}

std::string quote(std::string_view text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '"' || c == '\\') escaped += '\\';
        escaped += c;
    }
    return '"' + printable(escaped, MAX_NAME_BYTES) + '"';
}

std::string json_string(std::string_view text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace candela
