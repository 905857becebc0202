// TemporaryFile: holds what is written to a file until all of it is on the disk.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "os/file.h"

namespace candela {

// A new, empty file beside `target`, with these permissions or the usual ones. Removed with this object
// unless commit() gave it the target's name. Its name identifies its process and computer, and it is locked
// as long as the process lives. All functions throw std::system_error.
class TemporaryFile {
  public:
    explicit TemporaryFile(std::filesystem::path target, std::optional<os::Permissions> permissions = {});
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile();

    void write(std::string_view bytes);
    // Waits until the bytes are on the disk.
    void flush();
    // Replaces the target.
    void commit();
    // Takes a free name like the target's instead, such as box-1.exr, and returns the path.
    std::filesystem::path commit_beside();

  private:
    std::filesystem::path target_;
    std::filesystem::path name_;
    std::optional<os::OutputFile> file_;
    bool committed_ = false;
};

// Removes the files that killed processes left in the folder, if they ran on this computer since it was
// started: whether other processes are still running cannot be known.
void remove_abandoned_files(const std::filesystem::path& folder);

}  // namespace candela
