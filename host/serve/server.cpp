// See server.h.
#include "serve/server.h"

#include <array>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/caught_error.h"
#include "base/memory_limit.h"
#include "base/threads.h"
#include "os/stream.h"

namespace candela::serve {

// The most bytes of a line whose values need no memory to speak of.
static constexpr size_t SHORT_LINE = size_t{1} << 16;

// The answer that the exception being handled is.
static std::string line_of_caught(const std::optional<std::string>& id) {
    try {
        throw;
    } catch (const RequestError& error) {
        return error_line(id, error);
    } catch (...) {
        return error_line(id, caught_error());
    }
}

Server::Server(int in, int out, Handler handler, std::function<bool()> is_stopped, const Limits& limits)
    : in_(in),
      handler_(std::move(handler)),
      is_stopped_(std::move(is_stopped)),
      limits_(limits),
      output_(out, limits.output_bytes) {}

// Whether nobody waits for answers any more. `mutex_` is held.
bool Server::is_over() {
    is_stopping_ |= output_.is_gone() || is_stopped_();
    return is_stopping_;
}

Json Server::cancel(const Request& request) {
    const Node parameters = request.parameters();
    checked([&] { parameters.allow_only({"request"}); });
    const std::optional<Node> wanted = parameters.find("request");
    const std::lock_guard lock(mutex_);
    const auto is_meant = [&](const std::optional<std::string>& id) {
        return !wanted || id == wanted->text();
    };
    size_t count = 0;
    if (current_ && is_meant(current_) && !std::exchange(current_is_cancelled_, true)) ++count;
    for (Waiting& waiting : waiting_) {
        if (is_meant(waiting.request.id) && !std::exchange(waiting.is_cancelled, true)) ++count;
    }
    return {{"cancelled", count}};
}

// Takes a line: a request joins the others, and anything else is answered at once.
void Server::take(const std::string& line) {
    std::optional<std::string> id;
    try {
        // A short one is read whatever is in use, so that scenes can be closed.
        std::optional<LimitedMemory> limited;
        if (line.size() > SHORT_LINE) limited.emplace();
        Request request = with_memory_for(
            "its values", [] { return std::string("request"); }, [&] { return parse_request(line, id); });
        if (request.method == "cancel") {
            const Json result = cancel(request);
            if (id) output_.send(result_line(*id, result));
            return;
        }
        const std::lock_guard lock(mutex_);
        if (waiting_.size() >= limits_.waiting || waiting_bytes_ + line.size() > limits_.waiting_bytes)
            throw RequestError(Code::busy,
                               "request: too many requests wait; wait for answers before the next");
        waiting_bytes_ += line.size();
        waiting_.push_back({std::move(request), line.size()});
        wake_.notify_one();
    } catch (...) {
        output_.send(line_of_caught(id));
    }
}

void Server::read_lines(LineReader& lines) {
    while (true) {
        try {
            const std::optional<std::string> line = lines.next();
            if (!line) return;
            take(*line);
        } catch (const RequestError& error) {
            output_.send(error_line(std::nullopt, error));
        }
    }
}

// Reads until the client ends, or nobody waits for answers.
void Server::read() {
    LineReader lines(limits_.line_bytes);
    std::array<char, size_t{1} << 16> buffer;
    bool ended = false;
    while (!ended) {
        const os::StreamStep step = os::read_some(in_, buffer, LOOK);
        ended = step.ended;
        lines.add({buffer.data(), step.bytes});
        read_lines(lines);
        const std::lock_guard lock(mutex_);
        ended |= is_over() || has_ended_;
        if (is_stopping_) wake_.notify_one();
    }
    try {
        lines.finish();
    } catch (const RequestError& error) {
        output_.send(error_line(std::nullopt, error));
    }
}

// The next request, for which this waits; nothing at the end.
std::optional<Server::Waiting> Server::next() {
    std::unique_lock lock(mutex_);
    current_.reset();
    wake_.wait(lock, [this] { return has_ended_ || is_over() || !waiting_.empty(); });
    if (is_stopping_ || waiting_.empty()) return std::nullopt;
    Waiting first = std::move(waiting_.front());
    waiting_.pop_front();
    waiting_bytes_ -= first.bytes;
    current_ = first.request.id.value_or("null");
    current_is_cancelled_ = first.is_cancelled;
    return first;
}

void Server::answer(const Waiting& waiting) {
    const std::optional<std::string>& id = waiting.request.id;
    const Call call{.is_cancelled =
                        [this] {
                            const std::lock_guard lock(mutex_);
                            return current_is_cancelled_ || is_over();
                        },
                    .progress =
                        [&](const Json& parameters) {
                            Json told = parameters;
                            told["request"] = Json::parse(id.value_or("null"));
                            output_.offer(notification_line("progress", told));
                        }};
    std::string line;
    try {
        if (waiting.is_cancelled) throw RequestError(Code::cancelled, "request: cancelled before it began");
        line = result_line(id.value_or("null"), handler_(waiting.request, call));
    } catch (...) {
        line = line_of_caught(id);
    }
    {
        const std::lock_guard lock(mutex_);
        current_.reset();  // Who has the answer cannot cancel it any more.
    }
    if (id) output_.send(std::move(line));
}

Server::End Server::run() {
    {
        const JoiningThread reader([this] {
            try {
                read();
            } catch (...) {  // There is no memory for the bytes of a line.
                output_.send(line_of_caught(std::nullopt));
            }
            const std::lock_guard lock(mutex_);
            has_ended_ = true;
            wake_.notify_one();
        });
        while (const std::optional<Waiting> request = next()) {
            answer(*request);
            if (request->request.method == "close" && request->request.parameters().members().empty()) break;
        }
        const std::lock_guard lock(mutex_);
        has_ended_ = true;
    }
    if (!is_stopping_) output_.finish(limits_.patience);
    if (output_.is_given_up()) return End::given_up;
    if (output_.is_gone()) return End::gone;
    return is_stopping_ ? End::stopped : End::finished;
}

}  // namespace candela::serve
