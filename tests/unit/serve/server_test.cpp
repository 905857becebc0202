// The transport: requests in order, cancelled at once, and clients that misbehave.
#include "serve/server.h"

#include <array>
#include <atomic>
#include <csignal>
#include <future>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace candela::serve {
namespace {

using namespace std::chrono_literals;

// A pipe, whose ends are closed with it unless they were before.
struct Pipe {
    std::array<int, 2> ends{-1, -1};
    Pipe() { EXPECT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0); }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    ~Pipe() {
        close(0);
        close(1);
    }
    void close(size_t end) {
        if (ends[end] >= 0) ::close(std::exchange(ends[end], -1));
    }
};

// A server, and the client's ends of its pipes.
class ServerTest : public testing::Test {
  protected:
    ServerTest() { std::signal(SIGPIPE, SIG_IGN); }  // As in main().
    ~ServerTest() override {
        to_.close(1);
        from_.close(0);
        if (end_.valid()) end_.wait();
    }

    // Starts it. `echo` is answered with its parameters' "text", and `wait`, which tells its progress at
    // least once, when the call is cancelled or `go_` is set.
    void start(const Limits& limits = {}) {
        end_ = std::async(std::launch::async, [this, limits] {
            Server server(
                to_.ends[0], from_.ends[1],
                [this](const Request& request, const Call& call) { return handle(request, call); },
                [this] { return stop_.load(); }, limits);
            return server.run();
        });
    }
    Json handle(const Request& request, const Call& call) {
        if (request.method == "fail") throw Error("it failed");
        if (request.method != "wait") return {{"text", request.parameters().text()}};
        for (int i = 0; i == 0 || (!call.is_cancelled() && !go_); ++i) {
            call.progress({{"done", i}});
            began_.store(true);
            std::this_thread::sleep_for(1ms);
        }
        return {{"cancelled", call.is_cancelled()}};
    }
    void send(const std::string& text) const {
        ASSERT_EQ(::write(to_.ends[1], text.data(), text.size()), ssize_t(text.size()));
    }
    void request(int id, const std::string& method, const std::string& parameters = "{}") const {
        send(R"({"jsonrpc": "2.0", "id": )" + std::to_string(id) + R"(, "method": ")" + method +
             R"(", "params": )" + parameters + "}\n");
    }
    // Requests whose answers do not fit into the pipe.
    void send_much() const {
        ASSERT_EQ(::fcntl(from_.ends[1], F_SETPIPE_SZ, 4096), 4096);
        for (int id = 1; id <= 6; ++id)
            request(id, "echo", R"({"text": ")" + std::string(4000, 'x') + R"("})");
    }
    void wait_until_it_began() const {
        while (!began_)
            std::this_thread::sleep_for(1ms);
    }
    // The next message that is not about progress; null at the end.
    Json answer() {
        while (true) {
            const size_t end = read_.find('\n');
            if (end == std::string::npos) {
                char buffer[4096];
                const ssize_t count = ::read(from_.ends[0], buffer, sizeof buffer);
                if (count <= 0) return nullptr;
                read_.append(buffer, size_t(count));
                continue;
            }
            Json message = Json::parse(read_.substr(0, end));
            read_.erase(0, end + 1);
            if (!message.contains("method")) return message;
            EXPECT_EQ(message["method"], "progress");
            ++told_;
        }
    }
    Server::End end() {
        const Server::End how = end_.get();
        from_.close(1);
        return how;
    }

    Pipe to_, from_;
    std::atomic<bool> began_ = false, go_ = false, stop_ = false;
    std::future<Server::End> end_;
    std::string read_;
    int told_ = 0;  // Messages about progress.
};

TEST_F(ServerTest, AnswersInOrderAndEndsWithItsInput) {
    start();
    request(1, "echo", R"({"a": 1})");
    request(2, "fail");
    send("garbage\n");
    send(R"({"jsonrpc": "2.0", "method": "echo"})"
         "\n");  // Wants no answer.
    request(3, "echo");
    send(R"({"jsonrpc")");
    to_.close(1);
    std::vector<Json> answers;
    for (int i = 0; i < 5; ++i)
        answers.push_back(answer());
    std::vector<Json> in_order, of_lines;
    for (const Json& message : answers)
        (message["id"].is_null() ? of_lines : in_order).push_back(message);
    ASSERT_EQ(in_order.size(), 3u);
    EXPECT_EQ(in_order[0]["result"]["text"], R"({"a":1})");
    EXPECT_EQ(in_order[1]["error"]["message"], "it failed");
    EXPECT_EQ(in_order[2]["id"], 3);
    EXPECT_EQ(of_lines[0]["error"]["code"], -32700);
    EXPECT_EQ(of_lines[1]["error"]["message"], "request: the messages end in the middle of a line");
    EXPECT_EQ(end(), Server::End::finished);
}

TEST_F(ServerTest, CancelsWhatRunsAndWhatWaits) {
    start();
    request(1, "wait");
    wait_until_it_began();
    request(2, "echo");
    request(3, "echo");
    request(4, "cancel", R"({"request": 2})");
    EXPECT_EQ(answer()["result"], (Json{{"cancelled", 1}}));
    request(5, "cancel", R"({"request": 1})");
    std::map<int, Json> answers;  // That to the fifth may come before, between or after the others.
    std::vector<int> order;
    for (int i = 0; i < 4; ++i) {
        Json message = answer();
        const int id = message["id"].get<int>();
        if (id != 5) order.push_back(id);
        answers[id] = std::move(message);
    }
    EXPECT_EQ(order, (std::vector<int>{1, 2, 3}));
    EXPECT_EQ(answers[5]["result"], (Json{{"cancelled", 1}}));
    EXPECT_EQ(answers[1]["result"], (Json{{"cancelled", true}}));
    EXPECT_EQ(answers[2]["error"]["message"], "request: cancelled before it began");
    EXPECT_TRUE(answers[3].contains("result"));
    EXPECT_GT(told_, 0);
    request(6, "cancel");
    EXPECT_EQ(answer()["result"], (Json{{"cancelled", 0}}));
    request(7, "close");
    EXPECT_EQ(answer()["id"], 7);
    EXPECT_EQ(end(), Server::End::finished);
}

TEST_F(ServerTest, RefusesMoreThanMayWait) {
    start({.waiting = 2});
    request(1, "wait");
    wait_until_it_began();
    for (int id = 2; id <= 4; ++id)
        request(id, "echo");
    const Json refused = answer();
    EXPECT_EQ(refused["id"], 4);
    EXPECT_EQ(refused["error"]["message"],
              "request: too many requests wait; wait for answers before the next");
    go_ = true;
    for (int id = 1; id <= 3; ++id)
        EXPECT_EQ(answer()["id"], id);
}

TEST_F(ServerTest, ALineThatIsTooLongIsAnError) {
    start({.line_bytes = 100});
    std::string line(1000, 'x');
    line.back() = '\n';
    send(line);
    EXPECT_EQ(answer()["error"]["message"],
              "request: a line has more than 100 bytes; send less, or name a file");
    request(1, "echo");
    EXPECT_EQ(answer()["id"], 1);
}

TEST_F(ServerTest, AClientThatReadsNothingIsGivenUp) {
    start({.output_bytes = 10000});
    send_much();
    EXPECT_EQ(end(), Server::End::given_up);
}

TEST_F(ServerTest, AtTheEndAClientThatReadsNothingIsGivenUp) {
    start({.patience = 10ms});
    send_much();
    to_.close(1);
    EXPECT_EQ(end(), Server::End::given_up);
}

TEST_F(ServerTest, EndsWithItsClientWhateverItDoes) {
    start();
    request(1, "wait");
    wait_until_it_began();
    from_.close(0);
    EXPECT_EQ(end(), Server::End::gone);
}

TEST_F(ServerTest, StopsWhenItIsToldTo) {
    start();
    request(1, "wait");
    wait_until_it_began();
    stop_ = true;
    EXPECT_EQ(end(), Server::End::stopped);
}

}  // namespace
}  // namespace candela::serve
