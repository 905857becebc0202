// The way to the client: a thread writes lines, so that a client that reads slowly, or not at all, holds up
// nothing but them.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <string>
#include <string_view>

#include "base/threads.h"

namespace candela::serve {

// How soon it is noticed that the client is gone, or that the program is to stop.
inline constexpr std::chrono::milliseconds LOOK{100};

class Output {
  public:
    // Lines are written to `file`; at most `max` bytes may wait.
    Output(int file, size_t max);
    Output(const Output&) = delete;
    Output& operator=(const Output&) = delete;
    // Writes no more.
    ~Output();

    // Writes the line, after all others. If too much waits, the client is given up.
    void send(std::string line);
    // The same for a line that may be left out, which it is if others wait.
    void offer(std::string line);
    // Waits until all is written, or the client has read nothing for this long.
    void finish(std::chrono::milliseconds patience);

    // Whether the client is gone, and whether it was given up.
    bool is_gone() const { return gone_; }
    bool is_given_up() const { return given_up_; }

  private:
    void run();
    void write(std::string_view line);

    int file_;
    size_t max_;
    std::mutex mutex_;
    std::condition_variable wake_;
    std::deque<std::string> lines_;  // The first is being written.
    size_t waiting_ = 0;             // Their bytes.
    size_t written_ = 0;             // Bytes, since the start.
    std::atomic<bool> gone_ = false, given_up_ = false;
    std::atomic<bool> stops_ = false;
    JoiningThread thread_;  // The last member, since it uses the others.
};

}  // namespace candela::serve
