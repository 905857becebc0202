// A folder for files that only this program and those that it runs need.
#pragma once

#include <filesystem>
#include <string>

namespace candela {

// A new, empty folder among the temporary files, for this user alone; removed with all its contents at the
// end.
class TemporaryFolder {
  public:
    // Throws Error, whose text begins with `user`, if none can be created.
    explicit TemporaryFolder(const std::string& user);
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder();

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace candela
