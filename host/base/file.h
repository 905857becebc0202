// Files read and written whole. A written file appears complete or not at all: the bytes go to a temporary
// file beside the target, which is then renamed to the target.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace candela {

// The path in quotation marks, as messages show it: printable, and cut at MAX_PATH_BYTES.
std::string quoted(const std::filesystem::path& path);

// The extension of a path in lower case, with its dot.
std::string extension_of(const std::filesystem::path& path);

// Throws Error if `path` cannot be read: it is missing, a directory or a device, or may not be opened.
void check_readable(const std::filesystem::path& path);

// Called while a file is read: `done` bytes are there, of `of`, which is 0 for a pipe.
using ReadProgress = std::function<void(size_t done, size_t of)>;

// Returns the bytes of a file or pipe. Throws Error as check_readable() does, if reading fails, or if the
// file is a pointer of Git LFS.
std::string read_file(const std::filesystem::path& path, const ReadProgress& progress = {});

// Returns the first `max` bytes of a regular file, and no more than its size: pipes, devices and sockets are
// refused before they are opened, and files that the kernel makes up while they are read, as in /proc, after
// the first byte. `real` is the same file without symbolic links, and is opened; messages name `path`. Throws
// Error otherwise, and as read_file() does.
std::string read_finite_file(const std::filesystem::path& path, const std::filesystem::path& real,
                             uint64_t max = UINT64_MAX, const ReadProgress& progress = {});

// The first bytes of a regular file, `max` at most. Throws Error as read_file() does, and for a pipe.
struct FileStart {
    std::string bytes;
    uint64_t size = 0;  // Size of the whole file.
};
FileStart read_file_start(const std::filesystem::path& path, size_t max);

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

// The same for data that must not be lost, because it took long to make. If it cannot be written to `path`,
// it gets a free name such as box-1.exr: beside `path`, otherwise in the working folder, otherwise in a new
// folder for this user alone among the temporary files. The Error then says where it is.
void write_finished_work(const std::filesystem::path& path, std::string_view bytes);

// One of these two.
using FileWriter = void (*)(const std::filesystem::path& path, std::string_view bytes);

// What tells the file of a path from all others: its place, after following links, and, if it exists, its
// device and inode. Two paths name the same file if they share one of these keys.
std::vector<std::string> file_keys(const std::filesystem::path& path);

}  // namespace candela
