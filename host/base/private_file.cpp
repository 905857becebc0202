// See private_file.h. Every path goes through the open folder, so that nobody can replace the folder in
// between.
#include "base/private_file.h"

#include <cerrno>
#include <cstdint>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/temporary_file.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

// An open file or folder.
class Place {
  public:
    Place(const fs::path& path, int flags) {
        do {
            file_ = ::open(path.c_str(), flags | O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
        } while (file_ < 0 && errno == EINTR);
        if (file_ < 0 || ::fstat(file_, &status_) != 0) status_ = {};
    }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;
    ~Place() {
        if (file_ >= 0) ::close(file_);
    }

    // Whether it has that type, belongs to this user, and nobody else may write to it.
    bool is_private(mode_t type) const {
        constexpr mode_t OTHERS_WRITE = S_IWGRP | S_IWOTH;
        return (status_.st_mode & S_IFMT) == type && status_.st_uid == ::geteuid() &&
               (status_.st_mode & OTHERS_WRITE) == 0;
    }
    fs::path path() const { return "/proc/self/fd/" + std::to_string(file_); }

    // All bytes of a file; nothing if there are more than `max`, or reading fails.
    std::optional<std::string> read(size_t max) const {
        if (uint64_t(status_.st_size) > max) return std::nullopt;
        std::string bytes(size_t(status_.st_size), '\0');
        for (size_t done = 0; done < bytes.size();) {
            const ssize_t count = ::read(file_, bytes.data() + done, bytes.size() - done);
            if (count == 0 || (count < 0 && errno != EINTR)) return std::nullopt;
            if (count > 0) done += size_t(count);
        }
        return bytes;
    }

  private:
    int file_ = -1;
    struct stat status_ {};
};

// Creates a folder and the missing ones above it, for this user alone. A failure shows when it is opened.
void create_folders(const fs::path& folder) {
    std::error_code ignored;
    if (folder.has_relative_path() && !fs::exists(folder, ignored)) {
        create_folders(folder.parent_path());
        ::mkdir(folder.c_str(), 0700);
    }
}

}  // namespace

std::optional<std::string> read_private_file(const fs::path& folder, const std::string& name, size_t max) {
    const Place there(folder, O_DIRECTORY);
    if (!there.is_private(S_IFDIR)) return std::nullopt;
    const Place file(there.path() / name, O_NONBLOCK);  // Else opening a pipe would wait for a writer.
    return file.is_private(S_IFREG) ? file.read(max) : std::nullopt;
}

void write_private_file(const fs::path& folder, const std::string& name, std::string_view bytes) {
    create_folders(folder);
    const Place there(folder, O_DIRECTORY);
    if (!there.is_private(S_IFDIR)) return;
    const fs::path target = there.path() / name;
    std::error_code error;
    const fs::file_type old = fs::symlink_status(target, error).type();
    if (old != fs::file_type::regular && old != fs::file_type::not_found) return;
    remove_abandoned_files(there.path());
    TemporaryFile file(target, S_IRUSR | S_IWUSR);
    file.write(bytes);
    file.flush();
    file.commit();
}

}  // namespace candela
