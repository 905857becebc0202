// See output.h.
#include "serve/output.h"

#include <utility>

#include "os/stream.h"

namespace candela::serve {

using std::chrono::milliseconds;

Output::Output(int file, size_t max) : file_(file), max_(max), thread_([this] { run(); }) {}

Output::~Output() {
    const std::lock_guard lock(mutex_);
    stops_ = true;
    wake_.notify_all();
}

void Output::send(std::string line) {
    const std::lock_guard lock(mutex_);
    if (gone_) return;
    if (waiting_ + line.size() > max_) {
        given_up_ = gone_ = true;
        return;
    }
    waiting_ += line.size();
    lines_.push_back(std::move(line));
    wake_.notify_all();
}

void Output::offer(std::string line) {
    {
        const std::lock_guard lock(mutex_);
        if (!lines_.empty()) return;
    }
    send(std::move(line));
}

void Output::finish(milliseconds patience) {
    std::unique_lock lock(mutex_);
    const auto is_over = [this] { return lines_.empty() || gone_; };
    for (size_t before = written_; !wake_.wait_for(lock, patience, is_over); before = written_) {
        if (written_ > before) continue;
        given_up_ = gone_ = true;
        return;
    }
}

// Writes the line, unless the client is gone before its end.
void Output::write(std::string_view line) {
    while (!line.empty() && !gone_ && !stops_) {
        const os::StreamStep step = os::write_some(file_, line, LOOK);
        if (step.ended) gone_ = true;
        line.remove_prefix(step.bytes);
        const std::lock_guard lock(mutex_);
        written_ += step.bytes;
    }
}

void Output::run() {
    std::unique_lock lock(mutex_);
    while (!gone_ && !stops_) {
        if (lines_.empty()) {
            const bool woken = wake_.wait_for(lock, LOOK, [this] { return !lines_.empty() || stops_; });
            if (!woken && !os::has_reader(file_)) gone_ = true;
            continue;
        }
        const std::string& line = lines_.front();  // Others are only added behind it.
        lock.unlock();
        write(line);
        lock.lock();
        waiting_ -= lines_.front().size();
        lines_.pop_front();
        wake_.notify_all();
    }
    wake_.notify_all();
}

}  // namespace candela::serve
