// See os/stream.h. Windows cannot wait for a pipe that others made, so this looks again and again.
#include "os/stream.h"

#include <algorithm>
#include <thread>

#include <io.h>

#include "os/windows/calls.h"

namespace candela::os {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds PAUSE{2};

HANDLE handle_of(int file) {
    return reinterpret_cast<HANDLE>(_get_osfhandle(file));
}

}  // namespace

StreamStep read_some(int file, std::span<char> buffer, std::chrono::milliseconds patience) {
    const HANDLE stream = handle_of(file);
    const Clock::time_point end = Clock::now() + patience;
    DWORD ready = 0;
    while (GetFileType(stream) == FILE_TYPE_PIPE) {
        if (PeekNamedPipe(stream, nullptr, 0, nullptr, &ready, nullptr) == 0)
            return {.bytes = 0, .ended = true};
        if (ready > 0) break;
        if (Clock::now() >= end) return {};
        std::this_thread::sleep_for(PAUSE);
    }
    DWORD count = 0;
    const bool done = ReadFile(stream, buffer.data(), DWORD(buffer.size()), &count, nullptr) != 0;
    return {.bytes = count, .ended = !done || count == 0};
}

// A pipe that does not wait takes what there is room for, or nothing; a part if it is small enough.
StreamStep write_some(int file, std::string_view bytes, std::chrono::milliseconds patience) {
    constexpr size_t LARGEST = 4096;
    const Clock::time_point end = Clock::now() + patience;
    while (true) {
        for (size_t size = std::min(bytes.size(), LARGEST); size > 0; size /= 2) {
            DWORD count = 0;
            if (WriteFile(handle_of(file), bytes.data(), DWORD(size), &count, nullptr) == 0)
                return {.bytes = 0, .ended = true};
            if (count > 0) return {.bytes = count};
        }
        if (Clock::now() >= end) return {};
        std::this_thread::sleep_for(PAUSE);
    }
}

bool has_reader(int file) {
    DWORD count = 0;
    return WriteFile(handle_of(file), "", 0, &count, nullptr) != 0;
}

int take_standard_output() {
    const int file = _dup(1);
    if (file < 0 || _dup2(2, 1) < 0) return -1;
    DWORD mode = PIPE_READMODE_BYTE | PIPE_NOWAIT;
    if (GetFileType(handle_of(file)) == FILE_TYPE_PIPE)
        SetNamedPipeHandleState(handle_of(file), &mode, nullptr, nullptr);
    return file;
}

}  // namespace candela::os
