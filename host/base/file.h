// Files read and written whole. A written file appears complete or not at all: the bytes go to a temporary
// file beside the target, which then takes the target's name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace candela {

// The path in quotation marks, as messages show it: printable, and cut at MOST_PATH_BYTES.
std::string quoted(const std::filesystem::path& path);

// The extension of a path in lower case, with its dot.
std::string extension_of(const std::filesystem::path& path);

// Throws Error if `path` cannot be read: it is missing, a directory or a device, or may not be opened.
void check_readable(const std::filesystem::path& path);

// Called while a file is read: `done` bytes are there, of `of`, which is 0 for a pipe.
using ReadProgress = std::function<void(size_t done, size_t of)>;

// Returns the bytes of a file or pipe. Throws Error as check_readable() does, if reading breaks off, or if
// Git LFS has put a pointer in the place of the file.
std::string read_file(const std::filesystem::path& path, const ReadProgress& progress = {});

// Returns the first `most` bytes of a regular file, and no more than the system says that it holds: pipes,
// devices and sockets are refused before they are opened, and a file that the kernel makes up while it is
// read, as those in /proc, after its first byte. `real` is the same file without symbolic links, and is
// opened; messages name `path`. Throws Error otherwise, and as read_file() does.
std::string read_finite_file(const std::filesystem::path& path, const std::filesystem::path& real,
                             uint64_t most = UINT64_MAX, const ReadProgress& progress = {});

// The first bytes of a regular file, `most` at most. Throws Error as read_file() does, and for a pipe.
struct FileStart {
    std::string bytes;
    uint64_t size = 0;  // Of the whole file.
};
FileStart read_file_start(const std::filesystem::path& path, size_t most);

// Throws Error if write_file_atomically(path, ...) could not succeed now: the directory is missing or may not
// be written to, or the target is a directory, a device, write-protected, or a file that cannot be replaced:
// mounted by itself, or another user's where only owners may replace files. Really creates and removes a
// temporary file, so that a long computation can learn beforehand whether its result can be kept; and removes
// those that killed processes left behind.
void check_writable(const std::filesystem::path& path);

// Writes `bytes` to `path`, which keeps its old contents until the new ones are safely on the disk, and its
// permissions. A symbolic link stays and its target is replaced. Throws Error (also on a full disk), with no
// temporary file left behind.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

// The same for what must not get lost, because it took long and is made only once. If it cannot be written to
// `path`, it gets a free name such as box-1.exr: beside that, else in the working folder, else in a new
// folder for this user alone among the temporary files. The Error then says where it is.
void write_finished_work(const std::filesystem::path& path, std::string_view bytes);

// One of these two.
using FileWriter = void (*)(const std::filesystem::path& path, std::string_view bytes);

// Whether two paths name one file: by device and inode if both exist, else by where the names lead, links
// followed.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace candela
