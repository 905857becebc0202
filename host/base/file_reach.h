// Which files may be read because another file names them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/file.h"

namespace candela {

// What the user allows besides the folder of the file that is opened.
struct ReachOptions {
    std::vector<std::filesystem::path> folders{};
    bool anywhere = false;
};

// The files in the folder of one that the user opens, and below it, and those that the user allows besides.
// Symbolic links are followed first: what counts is where a file is, not where its name is.
class FileReach {
  public:
    // Nothing.
    FileReach() = default;
    // What the file `opened` may name, and the files that it names in turn. Throws Error (usage) for an
    // allowed folder that is not one.
    explicit FileReach(const std::filesystem::path& opened, const ReachOptions& options = {});

    // Whether the user trusts all files.
    bool is_anywhere() const { return anywhere_; }

    // Whether a path, of a file that may be missing, is within reach.
    bool holds(const std::filesystem::path& path) const;

    // What messages say of a file of that name, as another one has it, that is out of reach.
    std::string refusal(const std::string& name) const;

    // The file that another one in `folder` calls `name`. Throws Error if it is out of reach.
    std::filesystem::path find(const std::filesystem::path& folder, const std::string& name) const;

    // The first `most` bytes of a file. That which the user has opened is read as read_file() does. Any other
    // must be within reach, and a regular file that holds as many bytes as the system says, so that reading
    // ends. Throws Error otherwise, and if the file cannot be read.
    std::string read(const std::filesystem::path& path, uint64_t most = UINT64_MAX,
                     const ReadProgress& progress = {}) const;

  private:
    bool holds_real(const std::filesystem::path& real) const;

    std::filesystem::path opened_;
    std::vector<std::filesystem::path> folders_;  // Where they are, links followed.
    bool anywhere_ = false;
};

}  // namespace candela
