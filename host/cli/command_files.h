// The files of one command: none that is written may be another of them under whatever name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace candela {

class CommandFiles {
  public:
    // A file that is read, and one that is written; `role` is what messages call it: "SCENE", "-o". "-", for
    // standard output, is no file. Throws Error (usage) that names both roles and paths if one of them was
    // added before, unless both are only read.
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

    std::vector<File> files_;
};

}  // namespace candela
