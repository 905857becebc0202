// See file_reach.h.
#include "base/file_reach.h"

#include <algorithm>
#include <system_error>

#include "base/error.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

// The folder of a file, as the user wrote it.
fs::path name_of_folder(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

// Where a file is, or would be if it is missing; empty if the system does not say.
fs::path real_path(const fs::path& path) {
    std::error_code error;
    const fs::path absolute = fs::absolute(path, error);
    const fs::path real = error ? fs::path() : fs::weakly_canonical(absolute, error);
    return error ? fs::path() : real;
}

}  // namespace

FileReach::FileReach(const fs::path& opened, const ReachOptions& options)
    : opened_(opened), folders_{real_path(name_of_folder(opened))}, anywhere_(options.anywhere) {
    for (const fs::path& folder : options.folders) {
        std::error_code ignored;
        if (!fs::is_directory(folder, ignored))
            throw Error("--allow-folder: " + quoted(folder) + " is not a folder; name one that exists",
                        ErrorKind::request);
        folders_.push_back(real_path(folder));
    }
}

// By its text alone, since on Windows looking at a file can reach another computer, with the user's name:
// whether the path is on the drive, or the share, of an allowed folder.
bool FileReach::may_hold(const fs::path& path) const {
    const auto is_there = [&](const fs::path& folder) { return folder.root_name() == path.root_name(); };
    return anywhere_ || !path.has_root_name() || std::ranges::any_of(folders_, is_there);
}

bool FileReach::holds_real(const fs::path& real) const {
    if (real.empty()) return false;
    return anywhere_ || std::ranges::any_of(folders_, [&](const fs::path& folder) {
               const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), real.begin(), real.end());
               return !folder.empty() && end == folder.end();
           });
}

bool FileReach::holds(const fs::path& path) const {
    return may_hold(path) && holds_real(real_path(path));
}

std::string FileReach::refusal(const std::string& name) const {
    return "cannot read " + quoted(fs::path(name)) +
           ": with links followed, it is not in the folder of the file that is "
           "opened, " +
           quoted(name_of_folder(opened_)) +
           "; if you trust that file, allow the folder of this one (--allow-folder DIR), or all "
           "(--allow-any-folder)";
}

fs::path FileReach::find(const fs::path& folder, const std::string& name) const {
    fs::path path = folder / name;
    if (!holds(path)) throw Error(refusal(name));
    return path;
}

std::string FileReach::read(const fs::path& path, uint64_t max, const ReadProgress& progress) const {
    if (path == opened_) return read_file(path, progress);
    const fs::path real = may_hold(path) ? real_path(path) : fs::path();
    if (!holds_real(real)) throw Error(refusal(path.string()));
    return read_finite_file(path, real, max, progress);
}

}  // namespace candela
