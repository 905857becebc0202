// Files in memory that another program of this user can map.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace candela::os {

// Where they may be, the best place first.
std::vector<std::filesystem::path> mapped_file_folders();

// The variable of the environment that names the last of these folders.
extern const char* const TEMPORARY_FOLDER_VARIABLE;

// 24 hexadecimal digits that nobody can guess.
std::string random_digits();

// A new file of zeros, for this user alone, which is mapped, locked as long as the program lives, and removed
// with this object.
class MappedFile {
  public:
    // If the file cannot be made, or there is no room for it, is_mapped() says so.
    MappedFile(const std::filesystem::path& path, uint64_t size);
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;
    ~MappedFile();

    bool is_mapped() const { return bytes_.data() != nullptr; }
    const std::filesystem::path& path() const { return path_; }
    std::span<std::byte> bytes() const { return bytes_; }

  private:
    std::filesystem::path path_;
    std::span<std::byte> bytes_;
    intptr_t file_ = -1;
};

// Removes such a file of this user if no program has it locked.
void remove_unlocked_file(const std::filesystem::path& path);

}  // namespace candela::os
