// The files that may be read because another file names them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/file.h"

namespace candela {

// What the user allows in addition to the folder of the file that is opened.
struct ReachOptions {
    std::vector<std::filesystem::path> folders{};
    bool anywhere = false;
};

// The files in or below the folder of the file that the user opens, and the others that the user allows.
// Symbolic links are followed first: the place of the file decides, not that of the link.
class FileReach {
  public:
    // No files.
    FileReach() = default;
    // The files that `opened`, and the files that it names, may name. Throws Error (usage) for an allowed
    // folder that is not a folder.
    explicit FileReach(const std::filesystem::path& opened, const ReachOptions& options = {});

    // Whether the user trusts all files.
    bool is_anywhere() const { return anywhere_; }

    // Whether a path, of a file that may be missing, is within reach.
    bool holds(const std::filesystem::path& path) const;

    // The message about a file that is out of reach, by the name that another file gives it.
    std::string refusal(const std::string& name) const;

    // The file that another one in `folder` calls `name`. Throws Error if it is out of reach.
    std::filesystem::path find(const std::filesystem::path& folder, const std::string& name) const;

    // The first `max` bytes of a file. The file that the user opened is read as by read_file(). Any other
    // must be within reach, and a regular file with as many bytes as its size, so that reading ends. Throws
    // Error otherwise, and if the file cannot be read.
    std::string read(const std::filesystem::path& path, uint64_t max = UINT64_MAX,
                     const ReadProgress& progress = {}) const;

  private:
    bool holds_real(const std::filesystem::path& real) const;
    bool may_hold(const std::filesystem::path& path) const;

    std::filesystem::path opened_;
    std::vector<std::filesystem::path> folders_;  // Their places, after following links.
    bool anywhere_ = false;
};

}  // namespace candela
