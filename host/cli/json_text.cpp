// See json_text.h.
#include "cli/json_text.h"

#include <nlohmann/json.hpp>

#include "base/printable.h"

namespace candela {

static std::string dumped(const nlohmann::ordered_json& json, int indentation) {
    return printable_json(
        json.dump(indentation, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

std::string json_text(const nlohmann::ordered_json& json) {
    return dumped(json, 2);
}

std::string json_line(const nlohmann::ordered_json& json) {
    return dumped(json, -1);
}

}  // namespace candela
