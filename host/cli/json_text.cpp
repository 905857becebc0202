// See json_text.h.
#include "cli/json_text.h"

#include <nlohmann/json.hpp>

#include "base/printable.h"

namespace candela {

std::string json_text(const nlohmann::ordered_json& json) {
    return printable_json(json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace candela
