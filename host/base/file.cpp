// Reading and atomic writing of files.
#include "base/file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <system_error>

#include "base/error.h"
#include "base/printable.h"
#include "base/temporary_file.h"
#include "base/text.h"
#include "os/file.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_to_read(const fs::path& path, const std::string& reason) {
    throw Error("cannot read " + quoted(path) + ": " + reason);
}

[[noreturn]] void fail_to_write(const fs::path& path, const std::string& reason) {
    throw Error("cannot write " + quoted(path) + ": " + reason);
}

// The folder that holds a file.
fs::path folder_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

// Throws the Error of a system call that failed with `error` while `target` was being written.
[[noreturn]] void fail_to_write(const fs::path& path, const fs::path& target, const std::error_code& error) {
    const fs::path directory = folder_of(target);
    std::error_code ignored;
    if ((error.value() == ENOENT || error.value() == ENOTDIR) && !fs::is_directory(directory, ignored)) {
        fail_to_write(path, "the directory " + quoted(directory) + " does not exist; create it first");
    }
    switch (error.value()) {
        case ENOENT:  // The code of kernel file systems in which nothing can be created.
        case EACCES:
        case EPERM:
        case EROFS:
            fail_to_write(path, "no file can be created in the directory " + quoted(directory) + " (" +
                                    error.message() + "); choose a place that you may write to");
        default:
            fail_to_write(path, error.message() + (os::means_no_room(error)
                                                       ? "; free some space or choose another place"
                                                       : "; choose another place"));
    }
}

// The file that `path` leads to, following symbolic links, even if it does not exist yet; a link if they form
// a circle.
fs::path follow_links(const fs::path& path) {
    constexpr int MAX_LINKS = 40;  // As in the Linux kernel.
    fs::path target = path;
    std::error_code ignored;
    for (int i = 0; i < MAX_LINKS && fs::is_symlink(fs::symlink_status(target, ignored)); ++i)
        target = target.parent_path() / fs::read_symlink(target, ignored);
    return target;
}

// The file to write for `path`, checked to be one that may be replaced, or new.
fs::path writable_target(const fs::path& path) {
    if (!path.has_filename()) fail_to_write(path, "it names no file; give a file name");
    fs::path target = follow_links(path);
    std::error_code error;
    const fs::file_status status = fs::status(target, error);
    switch (status.type()) {
        case fs::file_type::not_found:
            break;
        case fs::file_type::regular:
            if (const std::error_code refusal = os::refusal_to_write(target)) {
                fail_to_write(path, "the file exists and is write-protected (" + refusal.message() +
                                        "); choose another name");
            }
            break;
        case fs::file_type::directory:
            fail_to_write(path, "it is a directory; give the name of a file in it");
        case fs::file_type::none:
            fail_to_write(path, target, error);
        default:
            fail_to_write(path, "it is not a regular file; choose another name");
    }
    return target;
}

// Throws Error if `target` is a file that may be written to but not replaced by another.
void check_replaceable(const fs::path& path, const fs::path& target) {
    const fs::path folder = folder_of(target);
    switch (os::obstacle_to_replacing(target, folder)) {
        case os::Obstacle::none:
            break;
        case os::Obstacle::mount_point:
            fail_to_write(
                path, "the file is a mount point, and cannot be replaced; mount the folder that holds it");
        case os::Obstacle::append_only:
            fail_to_write(path,
                          "the file is append-only (chattr +a), and cannot be replaced; choose another name");
        case os::Obstacle::owner:
            fail_to_write(path, "the file belongs to another user, and in the directory " + quoted(folder) +
                                    " only its owner may replace it; choose another name");
    }
}

// Gives a file the name of its target.
void put_in_place(const fs::path& path, TemporaryFile& file) {
    try {
        file.commit();
    } catch (const std::system_error& error) {
        fail_to_write(
            path, "no file can be put in its place (" + error.code().message() + "); choose another place");
    }
}

// Writes a new file under a free name like that of `target`, which another folder may hold. Returns its path;
// nothing if that fails.
std::optional<fs::path> write_beside(const fs::path& target, std::optional<os::Permissions> permissions,
                                     std::string_view bytes) {
    try {
        TemporaryFile file(target, permissions);
        file.write(bytes);
        file.flush();
        return file.commit_beside();
    } catch (const std::system_error&) {
        return std::nullopt;
    }
}

// As write_beside(), in a new folder for this user alone among the temporary files.
std::optional<fs::path> write_to_temporary_folder(const fs::path& target, std::string_view bytes) {
    fs::path folder;
    try {
        folder = os::make_temporary_folder();
    } catch (const std::system_error&) {
        return std::nullopt;
    }
    auto kept = write_beside(folder / target.filename(), std::nullopt, bytes);
    std::error_code ignored;
    if (!kept) fs::remove(folder, ignored);
    return kept;
}

// Writes data that can no longer be written to `target`: beside it, otherwise to the working folder,
// otherwise to the temporary one. Returns the path; nothing if all three fail.
std::optional<fs::path> write_elsewhere(const fs::path& target, std::string_view bytes) {
    const std::optional<os::Permissions> permissions = os::permissions_of(target);
    std::optional<fs::path> kept = write_beside(target, permissions, bytes);
    std::error_code error;
    const fs::path working = fs::current_path(error);
    if (!kept && !error) kept = write_beside(working / target.filename(), permissions, bytes);
    return kept ? kept : write_to_temporary_folder(target, bytes);
}

// Appends the remaining bytes of a file, at most `max`. Throws Error if it is not open or cannot be read.
void read_all(const fs::path& path, os::InputFile& file, std::string& bytes, uint64_t max = UINT64_MAX,
              const ReadProgress& progress = {}) {
    bytes.reserve(std::min(file.size(), max));
    std::array<char, 65536> buffer;
    for (size_t count = 1; count > 0 && !file.error();) {
        count = file.read({buffer.data(), size_t(std::min<uint64_t>(buffer.size(), max - bytes.size()))});
        bytes.append(buffer.data(), count);
        if (count > 0 && progress) progress(bytes.size(), file.size());
    }
    if (file.error()) fail_to_read(path, file.error().message() + "; check the file and its disk");
}

constexpr std::string_view START_OF_POINTER = "version https://git-lfs.github.com/spec/";

// Throws Error if these bytes, the first ones of a file, are a pointer of Git LFS.
void refuse_pointer(const fs::path& path, std::string_view start) {
    if (start.starts_with(START_OF_POINTER))
        fail_to_read(path, "it is a pointer of Git LFS, not the file itself; run `git lfs pull`");
}

}  // namespace

std::string quoted(const fs::path& path) {
    return '"' + printable(path.string(), MAX_PATH_BYTES) + '"';
}

std::string extension_of(const fs::path& path) {
    return lower_case(path.extension().string());
}

void check_readable(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    switch (status.type()) {
        case fs::file_type::regular:
        case fs::file_type::fifo:
            break;
        case fs::file_type::not_found:
            fail_to_read(path, "the file does not exist; check the name");
        case fs::file_type::directory:
            fail_to_read(path, "it is a directory; give the name of a file in it");
        case fs::file_type::none:
            fail_to_read(path, error.message() + "; check the name and the permissions");
        default:
            fail_to_read(path, "it is neither a regular file nor a pipe; give the name of a file");
    }
    if (const std::error_code refusal = os::refusal_to_read(path))
        fail_to_read(path, refusal.message() + "; check the permissions");
}

std::string read_file(const fs::path& path, const ReadProgress& progress) {
    check_readable(path);
    os::InputFile file(path);
    std::string bytes;
    read_all(path, file, bytes, UINT64_MAX, progress);
    refuse_pointer(path, bytes);
    return bytes;
}

std::string read_finite_file(const fs::path& path, const fs::path& real, uint64_t max,
                             const ReadProgress& progress) {
    check_readable(path);
    constexpr const char* NO_FILE = "it is not a regular file, and files may name no others";
    std::error_code ignored;
    if (!fs::is_regular_file(real, ignored)) fail_to_read(path, NO_FILE);
    os::InputFile file(real, os::InputFile::Pipes::refuse, os::InputFile::Links::refuse);
    if (file.is_open() && !file.is_regular()) fail_to_read(path, NO_FILE);
    const uint64_t size = file.size();
    const uint64_t wanted = std::max<uint64_t>(max, START_OF_POINTER.size());
    std::string bytes;
    // Reads one byte beyond the size, to notice that there are more.
    read_all(path, file, bytes, std::min(wanted, size + 1), progress);
    if (bytes.size() != std::min(wanted, size)) {
        fail_to_read(path,
                     "its contents do not match its size; is it a system file, or still being written?");
    }
    refuse_pointer(path, bytes);
    bytes.resize(std::min(bytes.size(), size_t(max)));
    return bytes;
}

FileStart read_file_start(const fs::path& path, size_t max) {
    check_readable(path);
    os::InputFile file(path, os::InputFile::Pipes::refuse);
    FileStart start;
    if (file.is_open() && !file.is_regular())
        fail_to_read(path, "it is a pipe, but must be read more than once; give the name of a file");
    read_all(path, file, start.bytes, max);
    refuse_pointer(path, start.bytes);
    start.size = file.size();
    return start;
}

void check_writable(const fs::path& path) {
    const fs::path target = writable_target(path);
    remove_abandoned_files(folder_of(target));
    check_replaceable(path, target);
    try {
        const TemporaryFile probe(target);
    } catch (const std::system_error& error) {
        fail_to_write(path, target, error.code());
    }
}

void write_file_atomically(const fs::path& path, std::string_view bytes) {
    const fs::path target = writable_target(path);
    try {
        TemporaryFile file(target, os::permissions_of(target));
        file.write(bytes);
        file.flush();
        put_in_place(path, file);
    } catch (const std::system_error& error) {
        fail_to_write(path, target, error.code());
    }
}

void write_finished_work(const fs::path& path, std::string_view bytes) {
    try {
        write_file_atomically(path, bytes);
    } catch (const Error& error) {
        const std::optional<fs::path> kept = write_elsewhere(follow_links(path), bytes);
        if (!kept) throw;
        throw Error(std::string(error.what()) + "; the data is saved in " + quoted(*kept));
    }
}

std::vector<std::string> file_keys(const fs::path& path) {
    std::error_code ignored;
    const fs::path target = follow_links(path);
    std::vector<std::string> keys{
        (fs::weakly_canonical(folder_of(target), ignored) / target.filename()).string()};
    std::string identity = os::identity_of(path);
    if (!identity.empty()) keys.push_back(std::move(identity));
    return keys;
}

}  // namespace candela
