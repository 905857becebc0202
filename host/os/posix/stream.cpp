// See os/stream.h.
#include "os/stream.h"

#include <algorithm>
#include <cerrno>
#include <climits>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

namespace candela::os {
namespace {

constexpr short GONE = POLLERR | POLLHUP | POLLNVAL;

// What is true of the stream, of `wanted` and GONE; 0 if that takes too long.
short wait_for(int file, short wanted, std::chrono::milliseconds patience) {
    struct pollfd stream {
        file, wanted, 0
    };
    return ::poll(&stream, 1, int(patience.count())) > 0 ? stream.revents : short(0);
}

StreamStep step_of(ssize_t count) {
    if (count > 0) return {.bytes = size_t(count)};
    return {.ended = count == 0 || (errno != EINTR && errno != EAGAIN)};
}

}  // namespace

StreamStep read_some(int file, std::span<char> buffer, std::chrono::milliseconds patience) {
    if (wait_for(file, POLLIN, patience) == 0) return {};
    return step_of(::read(file, buffer.data(), buffer.size()));
}

StreamStep write_some(int file, std::string_view bytes, std::chrono::milliseconds patience) {
    const short state = wait_for(file, POLLOUT, patience);
    if (state == 0) return {};
    if ((state & GONE) != 0) return {.ended = true};
    // A pipe that is said to have room has room for that many.
    return step_of(::write(file, bytes.data(), std::min<size_t>(bytes.size(), PIPE_BUF)));
}

bool has_reader(int file) {
    return (wait_for(file, 0, std::chrono::milliseconds(0)) & GONE) == 0;
}

int take_standard_output() {
    const int file = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    return file < 0 || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0 ? -1 : file;
}

}  // namespace candela::os
