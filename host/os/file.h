// Files, as the system sees them: what the standard library does not report or promise. Errors are of
// std::generic_category().
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

namespace candela::os {

// Whether the error says that there is no room for a file: its disk is full, or a limit on it is reached.
bool means_no_room(const std::error_code& error);

// Why this user may not read or write the file; nothing if that is allowed.
std::error_code refusal_to_read(const std::filesystem::path& file);
std::error_code refusal_to_write(const std::filesystem::path& file);

// What keeps a file that may be written to from being replaced by another.
enum class Obstacle {
    none,
    mount_point,  // It is mounted by itself.
    append_only,
    owner,  // It belongs to another user, in a folder where only owners may replace files.
};
Obstacle obstacle_to_replacing(const std::filesystem::path& file, const std::filesystem::path& folder);

// What tells a file from all others of the machine, by whatever path; empty if there is none.
std::string identity_of(const std::filesystem::path& file);

// Which users may do what, in the system's own terms.
using Permissions = uint32_t;
inline constexpr Permissions OWNER_ONLY = 0600;

// Those of a regular file; nothing if there is none of that name.
std::optional<Permissions> permissions_of(const std::filesystem::path& file);

// A new folder among the temporary files, for this user alone. Throws std::system_error.
std::filesystem::path make_temporary_folder();

// A file that is read.
class InputFile {
  public:
    enum class Pipes {
        wait,   // For somebody who writes into it.
        refuse  // Never waits. A pipe without a writer is open and empty.
    };
    enum class Links { follow, refuse };

    // If it cannot be opened, error() says why.
    explicit InputFile(const std::filesystem::path& path, Pipes pipes = Pipes::wait,
                       Links links = Links::follow);
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;
    ~InputFile();

    bool is_open() const { return file_ != -1; }
    std::error_code error() const { return error_; }
    bool is_regular() const;
    // Whether it belongs to this user.
    bool is_own() const;
    // Bytes now; 0 for a pipe.
    uint64_t size() const;
    // Reads what follows; returns 0 at the end, and if that fails, as error() then says.
    size_t read(std::span<char> buffer);
    // Reads bytes from `offset` on, as read() does.
    size_t read_at(uint64_t offset, std::span<std::byte> bytes);

  private:
    intptr_t file_ = -1;
    std::error_code error_;
};

// A new file that is written, and locked as long as it is open. All functions throw std::system_error.
class OutputFile {
  public:
    // With these permissions, or the usual ones. Throws std::errc::file_exists if there is one.
    explicit OutputFile(std::filesystem::path path, std::optional<Permissions> permissions);
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    ~OutputFile();

    void write(std::string_view bytes);
    // Waits until the bytes are on the disk.
    void flush();
    // Gives it another name. A file that has it is replaced, at once and as a whole.
    void rename(const std::filesystem::path& target);

  private:
    std::filesystem::path path_;
    intptr_t file_ = -1;
};

// Makes an empty file for this user alone. Throws std::system_error, std::errc::file_exists if there is one.
void make_empty_file(const std::filesystem::path& path);

// Whether no program has it open as an OutputFile.
bool is_unlocked(const std::filesystem::path& file);

// A folder that belongs to this user, and that nobody else may write to. It stays open, and files in it go
// through it, so that nobody can replace it in between. A link in its place is not followed.
class PrivateFolder {
  public:
    // Makes it, and the folders above it, if `make`. If it is no such folder, exists() says so.
    explicit PrivateFolder(const std::filesystem::path& path, bool make = false);
    PrivateFolder(const PrivateFolder&) = delete;
    PrivateFolder& operator=(const PrivateFolder&) = delete;
    ~PrivateFolder();

    bool exists() const { return exists_; }
    // The way to the open folder, while this lives.
    const std::filesystem::path& path() const { return path_; }
    // The bytes of a file in it that belongs to this user alone, in the same sense; nothing if there is none,
    // if it has more than `max`, or if reading fails.
    std::optional<std::string> read(const std::string& name, size_t max) const;

  private:
    std::filesystem::path path_;
    intptr_t folder_ = -1;
    bool exists_ = false;
};

}  // namespace candela::os
