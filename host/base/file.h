// Files read and written whole. A written file appears complete or not at all: the bytes go to a temporary
// file beside the target, which then takes the target's name.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace candela {

// The path in quotation marks, as messages show it.
std::string quoted(const std::filesystem::path& path);

// Throws Error if `path` cannot be read: it is missing, a directory or a device, or may not be opened.
void check_readable(const std::filesystem::path& path);

// Returns the bytes of a file or pipe. Throws Error as check_readable() does, or if reading breaks off.
std::string read_file(const std::filesystem::path& path);

// Throws Error if write_file_atomically(path, ...) could not succeed now: the directory is missing or may not
// be written to, or the target is a directory, a device or write-protected. Really creates and removes a
// temporary file, so that a long computation can learn beforehand whether its result can be kept.
void check_writable(const std::filesystem::path& path);

// Writes `bytes` to `path`, which keeps its old contents until the new ones are safely on the disk. A
// symbolic link stays and its target is replaced. Throws Error (also on a full disk), with no temporary file
// left behind.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

}  // namespace candela
