// See shared_memory.h.
#include "os/shared_memory.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

// What the names begin with; the number of the process and a random number follow.
constexpr std::string_view PREFIX = "candela-shared-";

// Where the files may be, the best first.
std::vector<fs::path> folders() {
    std::error_code ignored;
    std::vector<fs::path> all{"/dev/shm"};
    const fs::path temporary = fs::temp_directory_path(ignored);
    if (!temporary.empty()) all.push_back(temporary);
    return all;
}

// A name that nobody else can have guessed.
std::string new_name() {
    constexpr char DIGITS[] = "0123456789abcdef";
    std::array<unsigned char, 12> random{};
    if (::getrandom(random.data(), random.size(), 0) != ssize_t(random.size())) random[0] = 0;
    std::string name = std::string(PREFIX) + std::to_string(::getpid()) + '-';
    for (const unsigned char byte : random)
        (name += DIGITS[byte >> 4]) += DIGITS[byte & 15];
    return name;
}

// A new, locked file; -1 if there cannot be one. A file that is not locked yet may be taken for abandoned.
int make_file(const fs::path& path) {
    while (true) {
        const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
        if (file < 0) return -1;
        struct stat status {};
        if (::flock(file, LOCK_EX | LOCK_NB) == 0 && ::fstat(file, &status) == 0 && status.st_nlink > 0)
            return file;
        ::close(file);
    }
}

// Whether the file has the room for good, so that writing to it cannot fail.
bool reserve(int file, uint64_t size) {
    int error = EINTR;
    while (error == EINTR)
        error = ::posix_fallocate(file, 0, off_t(size));
    return error == 0;
}

}  // namespace

SharedMemory::SharedMemory(uint64_t size) {
    for (const fs::path& folder : folders()) {
        const fs::path path = folder / new_name();
        const int file = make_file(path);
        if (file < 0) continue;
        void* const memory = reserve(file, size)
                                 ? ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0)
                                 : MAP_FAILED;
        if (memory != MAP_FAILED) {
            path_ = path;
            file_ = file;
            bytes_ = {static_cast<std::byte*>(memory), size};
            return;
        }
        ::unlink(path.c_str());
        ::close(file);
    }
    throw Error(
        "cannot share " + std::to_string(size) +
            " bytes of memory with another program: neither /dev/shm nor the folder of temporary files "
            "has the room; make some, or name another folder (TMPDIR)",
        ErrorKind::out_of_memory);
}

SharedMemory::~SharedMemory() {
    ::munmap(bytes_.data(), bytes_.size());
    ::unlink(path_.c_str());
    ::close(file_);
}

SharedFile::SharedFile(const fs::path& path) : path_(path) {
    const std::vector<fs::path> places = folders();
    const auto is_place = [&](const fs::path& folder) { return path == folder / path.filename(); };
    const bool is_named = path.filename().string().starts_with(PREFIX);
    if (is_named && std::ranges::any_of(places, is_place))
        file_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    struct stat status {};
    if (file_ >= 0 && ::fstat(file_, &status) == 0 && S_ISREG(status.st_mode) &&
        status.st_uid == ::geteuid()) {
        size_ = uint64_t(status.st_size);
        return;
    }
    if (file_ >= 0) ::close(file_);
    std::string where;
    for (const fs::path& folder : places)
        where += (where.empty() ? "" : " or ") + folder.string();
    throw Error("no shared memory is called \"" + path.string() + "\": it must be a file of this user in " +
                where + ", whose name begins with \"" + std::string(PREFIX) + '"');
}

SharedFile::~SharedFile() {
    ::close(file_);
}

void SharedFile::read(uint64_t offset, std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
        const ssize_t count = ::pread(file_, bytes.data(), bytes.size(), off_t(offset));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) {
            throw Error("the shared memory \"" + path_.string() + "\" ends before byte " +
                        std::to_string(offset + bytes.size()) +
                        "; keep the file as it is until the scene is loaded");
        }
        offset += uint64_t(count);
        bytes = bytes.subspan(size_t(count));
    }
}

void remove_abandoned_memory() {
    for (const fs::path& folder : folders()) {
        std::error_code error;
        for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
             entry.increment(error)) {
            const fs::path& path = entry->path();
            if (!path.filename().string().starts_with(PREFIX)) continue;
            const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
            if (file < 0) continue;
            struct stat status {};
            const bool ours =
                ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == ::geteuid();
            if (ours && ::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(path.c_str());
            ::close(file);
        }
    }
}

void remove_abandoned_memory_of(int process) {
    constexpr int TIMES = 200;
    constexpr std::chrono::milliseconds PAUSE{10};
    const std::string prefix = std::string(PREFIX) + std::to_string(process) + '-';
    const auto has_some = [&](const fs::path& folder) {
        std::error_code error;
        for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
             entry.increment(error)) {
            if (entry->path().filename().string().starts_with(prefix)) return true;
        }
        return false;
    };
    for (int i = 0; i < TIMES; ++i) {
        remove_abandoned_memory();
        if (std::ranges::none_of(folders(), has_some)) return;
        std::this_thread::sleep_for(PAUSE);
    }
}

}  // namespace candela
