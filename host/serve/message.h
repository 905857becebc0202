// The messages of JSON-RPC 2.0, one a line: requests as they are read, and the texts of answers.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "base/error.h"
#include "load/json.h"
#include "load/node.h"

namespace candela::serve {

using Json = nlohmann::ordered_json;

// The codes of errors: those of JSON-RPC, and of candela.
enum class Code : int {
    not_json = -32700,
    invalid_request = -32600,
    unknown_method = -32601,
    invalid_parameters = -32602,
    failed = -32000,  // What was asked for cannot be done.
    busy = -32001,    // Too many requests wait.
    cancelled = -32800,
};

// An error that is the answer to a request. Others are Code::failed.
class RequestError : public Error {
  public:
    RequestError(Code code, const std::string& message) : Error(message, ErrorKind::request), code_(code) {}

    Code code() const { return code_; }

  private:
    Code code_;
};

// Returns read(), which reads parameters: what it throws is that they are wrong.
template <class Read>
decltype(auto) checked(const Read& read) {
    try {
        return read();
    } catch (const RequestError&) {
        throw;
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::out_of_memory) throw;
        throw RequestError(Code::invalid_parameters, error.what());
    }
}

struct Request {
    std::optional<std::string> id{};  // As JSON; none: the client wants no answer.
    std::string method{};

    // An object; empty if the message has none. Valid as long as this object.
    Node parameters() const;

    std::unique_ptr<json::Document> document{};
};

// Reads a line. Messages about its values begin with `request:1:column`. Throws RequestError for what is not
// a request of this kind; `id` then gets the request's, if it has one.
Request parse_request(std::string_view line, std::optional<std::string>& id);

// Lines, with their ends. `id` is JSON; none: it is not known.
std::string result_line(const std::string& id, const Json& result);
std::string error_line(const std::optional<std::string>& id, const Error& error);
std::string notification_line(const std::string& method, const Json& parameters);

}  // namespace candela::serve
