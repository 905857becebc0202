// See os/mapped_file.h.
#include "os/mapped_file.h"

#include <array>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include "os/posix/kernel.h"

namespace candela::os {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

const char* const TEMPORARY_FOLDER_VARIABLE = "TMPDIR";

std::vector<fs::path> mapped_file_folders() {
    std::error_code ignored;
    std::vector<fs::path> all{"/dev/shm"};
    const fs::path temporary = fs::temp_directory_path(ignored);
    if (!temporary.empty()) all.push_back(temporary);
    return all;
}

std::string random_digits() {
    constexpr char DIGITS[] = "0123456789abcdef";
    std::array<unsigned char, 12> random{};
    if (::getentropy(random.data(), random.size()) != 0) random[0] = 0;
    std::string digits;
    for (const unsigned char byte : random)
        (digits += DIGITS[byte >> 4]) += DIGITS[byte & 15];
    return digits;
}

MappedFile::MappedFile(const fs::path& path, uint64_t size) : path_(path), file_(make_file(path)) {
    if (file_ < 0) return;
    void* const memory = reserve(int(file_), size)
                             ? ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, int(file_), 0)
                             : MAP_FAILED;
    if (memory != MAP_FAILED) bytes_ = {static_cast<std::byte*>(memory), size};
}

MappedFile::~MappedFile() {
    if (is_mapped()) ::munmap(bytes_.data(), bytes_.size());
    if (file_ < 0) return;
    ::unlink(path_.c_str());
    ::close(int(file_));
}

void remove_unlocked_file(const fs::path& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (file < 0) return;
    struct stat status {};
    const bool ours = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == ::geteuid();
    if (ours && ::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(path.c_str());
    ::close(file);
}

}  // namespace candela::os
