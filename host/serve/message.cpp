// See message.h.
#include "serve/message.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "base/exit_code.h"
#include "base/printable.h"
#include "load/quote.h"

namespace candela::serve {
namespace {

// What messages about a request begin with.
constexpr const char* NAME = "request";
// The largest whole number up to which doubles tell all apart.
constexpr double MAX_ID = 9007199254740992.0;

[[noreturn]] void refuse(const std::string& what) {
    throw RequestError(Code::invalid_request, what);
}

std::string read_id(const json::Value& value) {
    const auto* const number = std::get_if<double>(&value.data);
    const bool whole = number != nullptr && std::trunc(*number) == *number && std::abs(*number) <= MAX_ID;
    if (whole || std::holds_alternative<std::string>(value.data)) return json::to_text(value);
    refuse(R"(request: "id" must be a text or a whole number of at most 2^53)");
}

// What programs tell errors apart by.
const char* kind_of(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::request:
            return "usage";
        case ErrorKind::no_device:
            return "no_device";
        case ErrorKind::device_lost:
            return "device_lost";
        case ErrorKind::out_of_memory:
            return "out_of_memory";
        case ErrorKind::other:
            break;
    }
    return "failed";
}

std::string line_of(const Json& message) {
    return printable_json(message.dump(-1, ' ', false, Json::error_handler_t::replace)) + '\n';
}

// The same with a member that is JSON already.
std::string line_with_id(const std::string& id, const char* key, const Json& value) {
    return R"({"jsonrpc":"2.0","id":)" + id + R"(,")" + key + R"(":)" +
           printable_json(value.dump(-1, ' ', false, Json::error_handler_t::replace)) + "}\n";
}

}  // namespace

Node Request::parameters() const {
    static const json::Document none{NAME, {{}, json::Object{}}};
    const Node root(*document);
    const std::optional<Node> found = root.find("params");
    return found ? *found : Node(none);
}

Request parse_request(std::string_view line, std::optional<std::string>& id) {
    Request request;
    try {
        request.document = std::make_unique<json::Document>(json::Document{NAME, json::parse(line, NAME)});
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::out_of_memory) throw;
        throw RequestError(Code::not_json, error.what());
    }
    const Node root(*request.document);
    if (root.is_array())
        refuse("request: several requests in one message are not supported; send them one by one");
    if (!root.is_object())
        refuse(R"(request: expected an object with "jsonrpc", "method", "params" and "id")");
    const auto& members = std::get<json::Object>(request.document->root.data);
    if (const json::Member* const member = members.find("id")) request.id = id = read_id(member->value);
    const json::Member* const version = members.find("jsonrpc");
    const auto* const text = version == nullptr ? nullptr : std::get_if<std::string>(&version->value.data);
    if (text == nullptr || *text != "2.0") refuse(R"(request: "jsonrpc" must be "2.0")");
    const json::Member* const method = members.find("method");
    const auto* const name = method == nullptr ? nullptr : std::get_if<std::string>(&method->value.data);
    if (name == nullptr) refuse(R"(request: "method" must be the name of a method)");
    request.method = *name;
    const std::optional<Node> parameters = root.find("params");
    if (parameters && !parameters->is_object())
        throw RequestError(Code::invalid_parameters, R"(request: "params" must be an object, by names)");
    return request;
}

std::string result_line(const std::string& id, const Json& result) {
    return line_with_id(id, "result", result);
}

std::string error_line(const std::optional<std::string>& id, const Error& error) {
    const auto* const answer = dynamic_cast<const RequestError*>(&error);
    const Code code = answer == nullptr ? Code::failed : answer->code();
    const char* kind = kind_of(error.kind());
    ExitCode exit = exit_code(error.kind());
    if (code == Code::cancelled) {
        kind = "cancelled";
        exit = ExitCode::interrupted;
    } else if (code == Code::busy) {
        kind = "busy";
        exit = ExitCode::failed;
    }
    return line_with_id(id.value_or("null"), "error",
                        {{"code", int(code)},
                         {"message", printable(error.what(), MAX_MESSAGE_BYTES)},
                         {"data", {{"kind", kind}, {"exit_code", int(exit)}}}});
}

std::string notification_line(const std::string& method, const Json& parameters) {
    return line_of({{"jsonrpc", "2.0"}, {"method", method}, {"params", parameters}});
}

}  // namespace candela::serve
