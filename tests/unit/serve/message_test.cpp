// Requests as they are read, and the texts of answers.
#include "serve/message.h"

#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "load/quote.h"
#include "serve/line_reader.h"

namespace candela::serve {
namespace {

struct Refusal {
    Code code;
    std::string message;
    std::optional<std::string> id;
};

// How a line is refused; its code is that of a failure if it is not.
Refusal refusal_of(const std::string& line) {
    Refusal refusal{Code::failed, "", std::nullopt};
    try {
        parse_request(line, refusal.id);
    } catch (const RequestError& error) {
        refusal.code = error.code();
        refusal.message = error.what();
    }
    return refusal;
}

TEST(Message, ARequestHasAMethodParametersAndAnId) {
    std::optional<std::string> id;
    const Request request =
        parse_request(R"({"jsonrpc": "2.0", "id": 7, "method": "render", "params": {"spp": 3}})", id);
    EXPECT_EQ(request.method, "render");
    EXPECT_EQ(request.id, "7");
    EXPECT_EQ(id, "7");
    EXPECT_EQ(request.parameters().require("spp").integer(1, 9), 3u);
    const Request notification = parse_request(R"({"jsonrpc": "2.0", "method": "cancel"})", id);
    EXPECT_FALSE(notification.id);
    EXPECT_TRUE(notification.parameters().members().empty());
    EXPECT_EQ(parse_request(R"({"jsonrpc": "2.0", "id": "a\nb", "method": "x"})", id).id, R"("a\nb")");
}

TEST(Message, WhatIsNotARequestIsRefusedByItsCode) {
    const struct {
        std::string line;
        Code code;
        std::string message;
    } cases[] = {{"garbage", Code::not_json, "request:1:1: "},
                 {"", Code::not_json, "request:1:1: "},
                 {"[]", Code::invalid_request, "request: several requests in one message are not supported"},
                 {"7", Code::invalid_request, "request: expected an object with "},
                 {R"({"method": "x"})", Code::invalid_request, R"(request: "jsonrpc" must be "2.0")"},
                 {R"({"jsonrpc": "1.0", "method": "x"})", Code::invalid_request,
                  R"(request: "jsonrpc" must be "2.0")"},
                 {R"({"jsonrpc": "2.0", "method": 5})", Code::invalid_request,
                  R"(request: "method" must be the name)"},
                 {R"({"jsonrpc": "2.0", "id": 0.5, "method": "x"})", Code::invalid_request,
                  R"(request: "id" must be )"},
                 {R"({"jsonrpc": "2.0", "id": 1e300, "method": "x"})", Code::invalid_request,
                  R"(request: "id" must be )"},
                 {R"({"jsonrpc": "2.0", "method": "x", "params": [1]})", Code::invalid_parameters,
                  R"(request: "params" must be an object, by names)"}};
    for (const auto& [line, code, message] : cases) {
        const Refusal refusal = refusal_of(line);
        EXPECT_EQ(refusal.code, code) << line;
        EXPECT_EQ(refusal.message.substr(0, message.size()), message) << line;
    }
    EXPECT_EQ(refusal_of(R"({"jsonrpc": "2.0", "id": 4, "method": 5})").id, "4");
}

TEST(Message, AnswersAreLinesOfJson) {
    const auto parsed = [](const std::string& line) {
        EXPECT_EQ(line.find('\n'), line.size() - 1);
        return Json::parse(line);
    };
    EXPECT_EQ(parsed(result_line("7", {{"a", "\xff\n"}})),
              (Json{{"jsonrpc", "2.0"}, {"id", 7}, {"result", {{"a", "\uFFFD\n"}}}}));
    const Json failure = parsed(error_line(std::nullopt, Error("no room", ErrorKind::out_of_memory)));
    EXPECT_EQ(failure, (Json{{"jsonrpc", "2.0"},
                             {"id", nullptr},
                             {"error",
                              {{"code", -32000},
                               {"message", "no room"},
                               {"data", {{"kind", "out_of_memory"}, {"exit_code", 5}}}}}}));
    const Json cancelled = parsed(error_line("1", RequestError(Code::cancelled, "stop")));
    EXPECT_EQ(cancelled["error"]["data"], (Json{{"kind", "cancelled"}, {"exit_code", 130}}));
    const Json busy = parsed(error_line("1", RequestError(Code::busy, "wait")));
    EXPECT_EQ(busy["error"]["data"], (Json{{"kind", "busy"}, {"exit_code", 1}}));
    for (const auto& [kind, name] :
         {std::pair(ErrorKind::request, "usage"), std::pair(ErrorKind::other, "failed"),
          std::pair(ErrorKind::no_device, "no_device"), std::pair(ErrorKind::device_lost, "device_lost")})
        EXPECT_EQ(parsed(error_line("1", Error("x", kind)))["error"]["data"]["kind"], name);
    EXPECT_EQ(parsed(notification_line("progress", {{"done", 0.5}})),
              (Json{{"jsonrpc", "2.0"}, {"method", "progress"}, {"params", {{"done", 0.5}}}}));
}

TEST(LineReader, CutsBytesIntoLines) {
    LineReader lines(10);
    EXPECT_FALSE(lines.next());
    lines.add("ab");
    EXPECT_FALSE(lines.next());
    lines.add("c\n\nde");
    EXPECT_EQ(lines.next(), "abc");
    EXPECT_EQ(lines.next(), "");
    EXPECT_FALSE(lines.next());
    EXPECT_THROW(lines.finish(), RequestError);
    lines.add("f\n");
    EXPECT_EQ(lines.next(), "def");
    EXPECT_FALSE(lines.next());
    lines.finish();
}

TEST(LineReader, SkipsALineThatIsTooLongWithoutKeepingIt) {
    const auto refusal = [](LineReader& lines) -> std::string {
        try {
            lines.next();
        } catch (const RequestError& error) {
            return error.what();
        }
        return "";
    };
    const std::string message = "request: a line has more than 10 bytes; send less, or name a file";
    LineReader lines(10);
    lines.add("0123456789\n0123456789a\nb\n");  // Whole.
    EXPECT_EQ(lines.next(), "0123456789");
    EXPECT_EQ(refusal(lines), message);
    EXPECT_EQ(lines.next(), "b");
    lines.add("0123456789a");  // Without its end.
    EXPECT_EQ(refusal(lines), message);
    lines.add("more");
    EXPECT_FALSE(lines.next());
    EXPECT_THROW(lines.finish(), RequestError);
    lines.add("and more\nc\n");
    EXPECT_EQ(lines.next(), "c");
    lines.finish();
}

}  // namespace
}  // namespace candela::serve
