// Memory that another program of the same user can map: a file in memory, or else among the temporary files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "os/file.h"
#include "os/mapped_file.h"

namespace candela {

// A file of this program, for this user alone, which is removed with this object. It is locked as long as the
// program lives. Its name says which program made it.
class SharedMemory {
  public:
    // Zeros. Throws Error (out_of_memory) if neither folder has the room.
    explicit SharedMemory(uint64_t size);

    const std::filesystem::path& path() const { return file_->path(); }
    std::span<std::byte> bytes() const { return file_->bytes(); }

  private:
    std::unique_ptr<os::MappedFile> file_;
};

// Such a file of another program of this user, who may change it at any moment: so it is read, and not
// mapped.
class SharedFile {
  public:
    // Throws Error for any other file.
    explicit SharedFile(const std::filesystem::path& path);

    // Bytes, when it was opened.
    uint64_t size() const { return size_; }
    // Copies bytes from `offset` on. Throws Error if the file has become shorter.
    void read(uint64_t offset, std::span<std::byte> bytes) const;

  private:
    std::filesystem::path path_;
    std::unique_ptr<os::InputFile> file_;
    uint64_t size_ = 0;
};

// Removes the files of this user's programs that were killed.
void remove_abandoned_memory();

// The same, and waits a moment for the program with that number if it holds such files: one that is killed
// loses them after its ends of pipes.
void remove_abandoned_memory_of(int process);

}  // namespace candela
