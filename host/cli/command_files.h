// The files of one command. A file that is written may not be the same file as any other, even under another
// name.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace candela {

class CommandFiles {
  public:
    // Add a file that is read, or one that is written; messages call it `role`: "SCENE", "-o". An output "-"
    // means standard output, and is ignored. Throw Error (usage) that names both roles and paths if the same
    // file was added before, unless both only read it.
    void read(const std::string& role, const std::filesystem::path& path);
    void write(const std::string& role, const std::filesystem::path& path);
    void read_all(const std::string& role, const std::vector<std::filesystem::path>& paths);

  private:
    struct File {
        std::string role;
        std::filesystem::path path;
        bool written;
    };
    void add(const File& file);

    std::map<std::string, File> files_;  // By each of file_keys().
};

}  // namespace candela
