// See os/stream.h. Windows cannot wait for a while for a pipe that others made: threads do, which end with
// the program.
#include "os/stream.h"

#include <algorithm>
#include <array>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <string>
#include <thread>

#include <io.h>

#include "os/windows/calls.h"

namespace candela::os {
namespace {

using std::chrono::milliseconds;

HANDLE handle_of(int file) {
    return reinterpret_cast<HANDLE>(_get_osfhandle(file));
}

// Reads a stream, a piece after the other.
class Reader {
  public:
    explicit Reader(int file) : file_(file) {
        std::thread([this] { run(); }).detach();
    }

    StreamStep read(std::span<char> buffer, milliseconds patience) {
        std::unique_lock lock(mutex_);
        wake_.wait_for(lock, patience, [this] { return ended_ || !piece_.empty(); });
        const size_t count = std::min(buffer.size(), piece_.size());
        std::memcpy(buffer.data(), piece_.data(), count);
        piece_.erase(0, count);
        if (piece_.empty()) wake_.notify_all();
        return {.bytes = count, .ended = count == 0 && ended_};
    }

  private:
    void run() {
        std::array<char, 65536> buffer;
        while (true) {
            DWORD count = 0;
            const bool more =
                ReadFile(handle_of(file_), buffer.data(), DWORD(buffer.size()), &count, nullptr) != 0;
            std::unique_lock lock(mutex_);
            piece_.assign(buffer.data(), count);
            ended_ = !more || count == 0;
            wake_.notify_all();
            if (ended_) return;
            wake_.wait(lock, [this] { return piece_.empty(); });
        }
    }

    int file_;
    std::mutex mutex_;
    std::condition_variable wake_;
    std::string piece_;
    bool ended_ = false;
};

// Writes to a stream, a piece after the other.
class Writer {
  public:
    explicit Writer(int file) : file_(file) {
        std::thread([this] { run(); }).detach();
    }

    // A piece that takes longer is what the next call waits for, whose bytes begin with it.
    StreamStep write(std::string_view bytes, milliseconds patience) {
        constexpr size_t LONGEST = 65536;
        std::unique_lock lock(mutex_);
        if (piece_.empty()) {
            piece_ = bytes.substr(0, LONGEST);
            done_ = false;
            wake_.notify_all();
        }
        if (!wake_.wait_for(lock, patience, [this] { return done_; })) return {};
        const size_t count = piece_.size();
        piece_.clear();
        return failed_ ? StreamStep{.bytes = 0, .ended = true} : StreamStep{.bytes = count};
    }

  private:
    void run() {
        std::unique_lock lock(mutex_);
        while (true) {
            wake_.wait(lock, [this] { return !done_; });
            const std::string piece = piece_;
            lock.unlock();
            bool written = true;
            for (size_t begin = 0; written && begin < piece.size();) {
                DWORD count = 0;
                written = WriteFile(handle_of(file_), piece.data() + begin, DWORD(piece.size() - begin),
                                    &count, nullptr) != 0;
                begin += count;
            }
            lock.lock();
            failed_ = !written;
            done_ = true;
            wake_.notify_all();
        }
    }

    int file_;
    std::mutex mutex_;
    std::condition_variable wake_;
    std::string piece_;
    bool done_ = true, failed_ = false;
};

}  // namespace

// There is one stream in each direction. Both live as long as the program, since their threads do.
StreamStep read_some(int file, std::span<char> buffer, milliseconds patience) {
    static Reader& reader = *new Reader(file);
    return reader.read(buffer, patience);
}

StreamStep write_some(int file, std::string_view bytes, milliseconds patience) {
    static Writer& writer = *new Writer(file);
    return writer.write(bytes, patience);
}

bool has_reader(int file) {
    DWORD count = 0;
    return WriteFile(handle_of(file), "", 0, &count, nullptr) != 0;
}

int take_standard_output() {
    const int file = _dup(1);
    return file < 0 || _dup2(2, 1) < 0 ? -1 : file;
}

}  // namespace candela::os
