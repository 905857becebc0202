// See command_files.h.
#include "cli/command_files.h"

#include "base/error.h"
#include "base/file.h"

namespace candela {
void CommandFiles::read(const std::string& role, const std::filesystem::path& path) {
    add({role, path, false});
}

void CommandFiles::write(const std::string& role, const std::filesystem::path& path) {
    if (path != "-") add({role, path, true});
}

void CommandFiles::read_all(const std::string& role, const std::vector<std::filesystem::path>& paths) {
    for (const std::filesystem::path& path : paths)
        read(role, path);
}

void CommandFiles::add(const File& file) {
    for (const std::string& key : file_keys(file.path)) {
        const auto [known, is_new] = files_.emplace(key, file);
        if (is_new) continue;
        const File& other = known->second;
        if (file.written || other.written) {
            throw Error(file.role + ": " + quoted(file.path) + " is the same file as " + other.role + ' ' +
                            quoted(other.path) + "; give it a name of its own",
                        ErrorKind::request);
        }
    }
}

}  // namespace candela
