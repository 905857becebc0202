// See os/file.h.
#include "os/file.h"

#include <cerrno>
#include <cstdlib>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "os/posix/kernel.h"

namespace candela::os {
namespace {

namespace fs = std::filesystem;

std::error_code last_error() {
    return {errno, std::generic_category()};
}

[[noreturn]] void fail(const char* call) {
    throw std::system_error(last_error(), call);
}

// Repeats a call that a signal interrupted.
template <class Call>
auto retried(Call call) {
    decltype(call()) result;
    do {
        result = call();
    } while (result < 0 && errno == EINTR);
    return result;
}

int open_file(const fs::path& path, int flags, mode_t mode = 0) {
    return retried([&] { return ::open(path.c_str(), flags | O_CLOEXEC, mode); });
}

// Of an open file; all zeros if it is not open.
struct stat status_of(int file) {
    struct stat status {};
    if (file < 0 || ::fstat(file, &status) != 0) status = {};
    return status;
}

// Whether it has that type, belongs to this user, and nobody else may write to it.
bool is_private(int file, mode_t type) {
    constexpr mode_t OTHERS_WRITE = S_IWGRP | S_IWOTH;
    const struct stat status = status_of(file);
    return (status.st_mode & S_IFMT) == type && status.st_uid == ::geteuid() &&
           (status.st_mode & OTHERS_WRITE) == 0;
}

// Creates a folder and the missing ones above it, for this user alone. A failure shows when it is opened.
void create_folders(const fs::path& folder) {
    std::error_code ignored;
    if (folder.has_relative_path() && !fs::exists(folder, ignored)) {
        create_folders(folder.parent_path());
        ::mkdir(folder.c_str(), 0700);
    }
}

}  // namespace

bool means_no_room(const std::error_code& error) {
    return error.value() == ENOSPC || error.value() == EDQUOT || error.value() == EFBIG;
}

std::error_code refusal_to_read(const fs::path& file) {
    return ::access(file.c_str(), R_OK) == 0 ? std::error_code() : last_error();
}

std::error_code refusal_to_write(const fs::path& file) {
    return ::access(file.c_str(), W_OK) == 0 ? std::error_code() : last_error();
}

Obstacle obstacle_to_replacing(const fs::path& file, const fs::path& folder) {
    struct statx status {};
    if (::statx(AT_FDCWD, file.c_str(), 0, STATX_BASIC_STATS, &status) != 0) return Obstacle::none;
    if ((status.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0) return Obstacle::mount_point;
    if ((status.stx_attributes & STATX_ATTR_APPEND) != 0) return Obstacle::append_only;
    struct stat above {};
    const uid_t user = ::geteuid();
    const bool foreign = user != 0 && status.stx_uid != user && ::stat(folder.c_str(), &above) == 0 &&
                         (above.st_mode & S_ISVTX) != 0 && above.st_uid != user;
    return foreign ? Obstacle::owner : Obstacle::none;
}

std::string identity_of(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return "";
    return std::to_string(status.st_dev) + ':' + std::to_string(status.st_ino);
}

std::optional<Permissions> permissions_of(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    return status.st_mode & 0777u;
}

fs::path make_temporary_folder() {
    std::string name = (fs::temp_directory_path() / "candela-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) fail("mkdtemp");
    return name;
}

InputFile::InputFile(const fs::path& path, Pipes pipes, Links links)
    : file_(open_file(path, O_RDONLY | (pipes == Pipes::refuse ? O_NONBLOCK : 0) |
                                (links == Links::refuse ? O_NOFOLLOW : 0))) {
    if (file_ < 0) error_ = last_error();
}

InputFile::~InputFile() {
    if (file_ >= 0) ::close(int(file_));
}

bool InputFile::is_regular() const {
    return S_ISREG(status_of(int(file_)).st_mode);
}

bool InputFile::is_own() const {
    return is_open() && status_of(int(file_)).st_uid == ::geteuid();
}

uint64_t InputFile::size() const {
    const off_t size = status_of(int(file_)).st_size;
    return size > 0 ? uint64_t(size) : 0;
}

size_t InputFile::read(std::span<char> buffer) {
    const ssize_t count = retried([&] { return ::read(int(file_), buffer.data(), buffer.size()); });
    if (count < 0) error_ = last_error();
    return count < 0 ? 0 : size_t(count);
}

size_t InputFile::read_at(uint64_t offset, std::span<std::byte> bytes) {
    const ssize_t count =
        retried([&] { return ::pread(int(file_), bytes.data(), bytes.size(), off_t(offset)); });
    if (count < 0) error_ = last_error();
    return count < 0 ? 0 : size_t(count);
}

OutputFile::OutputFile(fs::path path, std::optional<Permissions> permissions) : path_(std::move(path)) {
    const mode_t mode = permissions.value_or(0666);
    file_ = open_file(path_, O_WRONLY | O_CREAT | O_EXCL, mode);
    if (file_ < 0) fail("open");
    ::flock(int(file_), LOCK_EX | LOCK_NB);  // On file systems without locks, nothing is ever removed.
    if (permissions) ::fchmod(int(file_), mode);
}

OutputFile::~OutputFile() {
    ::close(int(file_));
}

void OutputFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = retried([&] { return ::write(int(file_), bytes.data(), bytes.size()); });
        if (written < 0) fail("write");
        bytes.remove_prefix(size_t(written));
    }
}

void OutputFile::flush() {
    if (retried([&] { return ::fsync(int(file_)); }) != 0) fail("fsync");
}

void OutputFile::rename(const fs::path& target) {
    if (::rename(path_.c_str(), target.c_str()) != 0) fail("rename");
    path_ = target;
}

void make_empty_file(const fs::path& path) {
    const int file = open_file(path, O_WRONLY | O_CREAT | O_EXCL, OWNER_ONLY);
    if (file < 0) fail("open");
    ::close(file);
}

bool is_unlocked(const fs::path& file) {
    const int descriptor = open_file(file, O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
    if (descriptor < 0) return false;
    const bool unlocked = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    ::close(descriptor);
    return unlocked;
}

PrivateFolder::PrivateFolder(const fs::path& path, bool make) {
    if (make) create_folders(path);
    const int folder = open_file(path, O_DIRECTORY | O_RDONLY | O_NOFOLLOW);
    exists_ = is_private(folder, S_IFDIR);
    folder_ = folder;
    path_ = path_of_folder(folder);
}

PrivateFolder::~PrivateFolder() {
    if (folder_ >= 0) ::close(int(folder_));
}

std::optional<std::string> PrivateFolder::read(const std::string& name, size_t max) const {
    // Opening a pipe would else wait for a writer.
    const int file = open_file(path_ / name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
    std::optional<std::string> bytes;
    const auto size = uint64_t(status_of(file).st_size);
    if (is_private(file, S_IFREG) && size <= max) {
        bytes.emplace(size, '\0');
        for (size_t done = 0; bytes && done < size;) {
            const ssize_t count = retried([&] { return ::read(file, bytes->data() + done, size - done); });
            if (count > 0) {
                done += size_t(count);
            } else {
                bytes.reset();
            }
        }
    }
    if (file >= 0) ::close(file);
    return bytes;
}

}  // namespace candela::os
