// The server: takes requests from one client, in order, and answers them. It knows nothing of what they ask.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "serve/line_reader.h"
#include "serve/message.h"
#include "serve/output.h"

namespace candela::serve {

// What a method may ask and tell while it works.
struct Call {
    std::function<bool()> is_cancelled;                    // Whether to stop.
    std::function<void(const Json& parameters)> progress;  // Of which the latest are told.
};

// Does what a request asks, and returns the answer. Throws Error, which is then the answer.
using Handler = std::function<Json(const Request& request, const Call& call)>;

struct Limits {
    size_t line_bytes = size_t{64} << 20;       // Of a message.
    size_t waiting = 64;                        // Requests that wait,
    size_t waiting_bytes = size_t{64} << 20;    // and the bytes of their messages.
    size_t output_bytes = size_t{64} << 20;     // Of answers that the client has not read.
    std::chrono::milliseconds patience{10000};  // For a client that reads nothing, at the end.
};

class Server {
  public:
    enum class End {
        finished,  // All requests are answered.
        gone,      // The client is.
        given_up,  // It reads nothing.
        stopped,   // As is_stopped() asks.
    };

    // Reads from the file `in` and writes to `out`. The handler is called by the thread that calls run();
    // is_stopped() is called regularly, by another one.
    Server(int in, int out, Handler handler, std::function<bool()> is_stopped, const Limits& limits = {});

    // Answers requests until there are no more, one is {"method": "close"} without parameters, or the client
    // is gone. `cancel` acts at once: on the request that its parameter "request" names, or on all.
    End run();

  private:
    struct Waiting {
        Request request;
        size_t bytes;
        bool is_cancelled = false;
    };

    void read();
    void read_lines(LineReader& lines);
    void take(const std::string& line);
    Json cancel(const Request& request);
    std::optional<Waiting> next();
    void answer(const Waiting& waiting);
    bool is_over();

    int in_;
    Handler handler_;
    std::function<bool()> is_stopped_;
    Limits limits_;
    Output output_;
    std::mutex mutex_;
    std::condition_variable wake_;
    std::deque<Waiting> waiting_;
    size_t waiting_bytes_ = 0;
    std::optional<std::string> current_;  // The id of the request that is being answered.
    bool current_is_cancelled_ = false;
    bool has_ended_ = false;    // No more requests come.
    bool is_stopping_ = false;  // Nothing is answered any more.
};

}  // namespace candela::serve
