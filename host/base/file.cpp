// Reading and atomic writing of files, through POSIX calls: the standard library has no fsync.
#include "base/file.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "base/error.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_to_read(const fs::path& path, const std::string& reason) {
    throw Error("cannot read " + quoted(path) + ": " + reason);
}

[[noreturn]] void fail_to_write(const fs::path& path, const std::string& reason) {
    throw Error("cannot write " + quoted(path) + ": " + reason);
}

std::string describe(int error) {
    return std::generic_category().message(error);
}

// Throws the Error for a system call that failed with `error` while `target` was being written.
[[noreturn]] void fail_to_write(const fs::path& path, const fs::path& target, int error) {
    const fs::path directory = target.has_parent_path() ? target.parent_path() : fs::path(".");
    std::error_code ignored;
    if ((error == ENOENT || error == ENOTDIR) && !fs::is_directory(directory, ignored)) {
        fail_to_write(path, "the directory " + quoted(directory) + " does not exist; create it first");
    }
    switch (error) {
        case ENOENT:  // What a kernel file system says where nothing can be created.
        case EACCES:
        case EPERM:
        case EROFS:
            fail_to_write(path, "no file can be created in the directory " + quoted(directory) + " (" +
                                    describe(error) + "); choose a place that you may write to");
        case ENOSPC:
        case EDQUOT:
        case EFBIG:
            fail_to_write(path, describe(error) + "; free some space or choose another place");
        default:
            fail_to_write(path, describe(error) + "; choose another place");
    }
}

// A new, empty file beside `target`; removed with this object unless commit() gave it the target's name.
class TemporarySibling {
  public:
    // `path` is what the user called the target.
    TemporarySibling(fs::path path, fs::path target) : path_(std::move(path)), target_(std::move(target)) {
        do {
            name_ = new_name(target_);
            file_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        } while (file_ < 0 && errno == EEXIST);  // Another's, or left behind by a process that was killed.
        if (file_ < 0) fail_to_write(path_, target_, errno);
    }
    TemporarySibling(const TemporarySibling&) = delete;
    TemporarySibling& operator=(const TemporarySibling&) = delete;
    ~TemporarySibling() {
        ::close(file_);
        if (!committed_) ::unlink(name_.c_str());
    }

    void write(std::string_view bytes) {
        while (!bytes.empty()) {
            const ssize_t written = ::write(file_, bytes.data(), bytes.size());
            if (written >= 0) {
                bytes.remove_prefix(size_t(written));
            } else if (errno != EINTR) {
                fail_to_write(path_, target_, errno);
            }
        }
    }

    void commit() {
        if (::fsync(file_) != 0) fail_to_write(path_, target_, errno);
        if (::rename(name_.c_str(), target_.c_str()) != 0) fail_to_write(path_, target_, errno);
        committed_ = true;
    }

  private:
    // Short whatever the target is called, so that it never exceeds the longest name allowed.
    static fs::path new_name(const fs::path& target) {
        static std::atomic<unsigned> counter = 0;
        const std::string unique = std::to_string(::getpid()) + '-' + std::to_string(counter++);
        return target.parent_path() / (".candela-" + unique + ".tmp");
    }

    fs::path path_;
    fs::path target_;
    fs::path name_;
    int file_ = -1;
    bool committed_ = false;
};

// The file that `path` means once symbolic links are followed, even if it does not exist yet.
fs::path follow_links(const fs::path& path) {
    constexpr int MOST_LINKS = 40;  // As in the Linux kernel.
    fs::path target = path;
    std::error_code ignored;
    for (int i = 0; fs::is_symlink(fs::symlink_status(target, ignored)); ++i) {
        if (i == MOST_LINKS) fail_to_write(path, describe(ELOOP) + "; choose another place");
        target = target.parent_path() / fs::read_symlink(target, ignored);
    }
    return target;
}

// The file to write for `path`, checked to be one that may be replaced, or new.
fs::path writable_target(const fs::path& path) {
    if (!path.has_filename()) fail_to_write(path, "it names no file; give a file name");
    fs::path target = follow_links(path);
    std::error_code error;
    const fs::file_status status = fs::status(target, error);
    switch (status.type()) {
        case fs::file_type::not_found:
            break;
        case fs::file_type::regular:
            if (::access(target.c_str(), W_OK) != 0) {
                fail_to_write(path, "the file exists and is write-protected (" + describe(errno) +
                                        "); choose another name");
            }
            break;
        case fs::file_type::directory:
            fail_to_write(path, "it is a directory; give the name of a file in it");
        case fs::file_type::none:
            fail_to_write(path, target, error.value());
        default:
            fail_to_write(path, "it is not a regular file; choose another name");
    }
    return target;
}

}  // namespace

std::string quoted(const fs::path& path) {
    return '"' + path.string() + '"';
}

void check_readable(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    switch (status.type()) {
        case fs::file_type::regular:
        case fs::file_type::fifo:
            break;
        case fs::file_type::not_found:
            fail_to_read(path, "the file does not exist; check the name");
        case fs::file_type::directory:
            fail_to_read(path, "it is a directory; give the name of a file in it");
        case fs::file_type::none:
            fail_to_read(path, error.message() + "; check the name and the permissions");
        default:
            fail_to_read(path, "it is neither a regular file nor a pipe; give the name of a file");
    }
    if (::access(path.c_str(), R_OK) != 0) fail_to_read(path, describe(errno) + "; check the permissions");
}

std::string read_file(const fs::path& path) {
    check_readable(path);
    std::ifstream file(path, std::ios::binary);
    std::string bytes;
    std::error_code unknown_size;  // Of what is no file of its own, such as a pipe.
    const uintmax_t size = fs::file_size(path, unknown_size);
    if (!unknown_size) bytes.reserve(size);
    std::array<char, 65536> buffer;
    do {
        errno = 0;  // Streams do not promise to set it, but those of Unix do.
        file.read(buffer.data(), buffer.size());
        bytes.append(buffer.data(), size_t(file.gcount()));
    } while (file);
    if (!file.eof()) fail_to_read(path, describe(errno) + "; check the file and its disk");
    return bytes;
}

void check_writable(const fs::path& path) {
    const TemporarySibling probe(path, writable_target(path));
}

void write_file_atomically(const fs::path& path, std::string_view bytes) {
    TemporarySibling file(path, writable_target(path));
    file.write(bytes);
    file.commit();
}

}  // namespace candela
