// See temporary_file.h. POSIX calls: the standard library has neither locks nor fsync.
#include "base/temporary_file.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/hash.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view SUFFIX = ".tmp";

[[noreturn]] void fail(const char* call) {
    throw std::system_error(errno, std::generic_category(), call);
}

// Repeats a call that a signal interrupted.
template <class Call>
auto retried(Call call) {
    decltype(call()) result;
    do {
        result = call();
    } while (result < 0 && errno == EINTR);
    return result;
}

// The beginning of the names of this computer's files until it is restarted: ".candela-", 16 hexadecimal
// digits and "-". Empty if the system does not identify itself and its last start.
const std::string& own_prefix() {
    static const std::string prefix = [] {
        std::array<char, 256> host{};
        std::string boot;
        std::getline(std::ifstream("/proc/sys/kernel/random/boot_id"), boot);
        if (boot.empty() || ::gethostname(host.data(), host.size() - 1) != 0) return std::string();
        const std::string both = boot + host.data();
        std::array<char, 32> digits{};
        std::snprintf(digits.data(), digits.size(), "%016llx",
                      static_cast<unsigned long long>(fnv1a64(std::as_bytes(std::span(both)))));
        return std::string(".candela-") + digits.data() + '-';
    }();
    return prefix;
}

// Independent of the target's name, so that it never exceeds the longest name allowed.
std::string new_name() {
    static std::atomic<unsigned> counter = 0;
    const std::string prefix = own_prefix().empty() ? ".candela-" : own_prefix();
    return prefix + std::to_string(::getpid()) + '-' + std::to_string(counter++) + std::string(SUFFIX);
}

// The process that a file of that name belongs to; nothing if it is another computer's, or not a temporary
// file.
std::optional<pid_t> owner_of(std::string_view name) {
    const std::string& prefix = own_prefix();
    if (prefix.empty() || !name.starts_with(prefix) || !name.ends_with(SUFFIX)) return std::nullopt;
    name.remove_prefix(prefix.size());
    pid_t owner = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), owner);
    return error == std::errc() && *end == '-' && owner > 0 ? std::optional(owner) : std::nullopt;
}

// Whether the process has ended and, since it may only be invisible from here, has lost its lock.
bool is_abandoned(const fs::path& file, pid_t owner) {
    if (::kill(owner, 0) == 0 || errno != ESRCH) return false;
    const int descriptor =
        retried([&] { return ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC); });
    if (descriptor < 0) return false;
    const bool unlocked = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    ::close(descriptor);
    return unlocked;
}

}  // namespace

std::optional<mode_t> permissions_of(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    return status.st_mode & 0777u;
}

TemporaryFile::TemporaryFile(fs::path target, std::optional<mode_t> permissions)
    : target_(std::move(target)) {
    const mode_t mode = permissions.value_or(0666);
    do {
        name_ = target_.parent_path() / new_name();
        file_ = retried([&] { return ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode); });
    } while (file_ < 0 && errno == EEXIST);  // Left behind by an earlier process of that number.
    if (file_ < 0) fail("open");
    ::flock(file_, LOCK_EX | LOCK_NB);  // On file systems without locks, nothing is ever removed.
    if (permissions) ::fchmod(file_, mode);
}

TemporaryFile::~TemporaryFile() {
    ::close(file_);
    if (!committed_) ::unlink(name_.c_str());
}

void TemporaryFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = retried([&] { return ::write(file_, bytes.data(), bytes.size()); });
        if (written < 0) fail("write");
        bytes.remove_prefix(size_t(written));
    }
}

void TemporaryFile::flush() {
    if (retried([&] { return ::fsync(file_); }) != 0) fail("fsync");
}

void TemporaryFile::commit() {
    if (::rename(name_.c_str(), target_.c_str()) != 0) fail("rename");
    committed_ = true;
}

fs::path TemporaryFile::commit_beside() {
    const std::string stem = target_.stem().string(), extension = target_.extension().string();
    for (int i = 1; !committed_; ++i) {
        std::string name = stem;
        name += '-' + std::to_string(i) + extension;
        target_.replace_filename(name);
        // Once a file of that name exists and is ours, it can be replaced.
        const int placeholder =
            retried([&] { return ::open(target_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600); });
        if (placeholder >= 0) {
            ::close(placeholder);
            if (::rename(name_.c_str(), target_.c_str()) != 0) {
                const int error = errno;
                ::unlink(target_.c_str());
                throw std::system_error(error, std::generic_category(), "rename");
            }
            committed_ = true;
        } else if (errno != EEXIST) {
            fail("open");
        }
    }
    return target_;
}

void remove_abandoned_files(const fs::path& folder) {
    std::error_code ignored;
    for (fs::directory_iterator entry(folder, ignored); entry != fs::directory_iterator();
         entry.increment(ignored)) {
        const std::optional<pid_t> owner = owner_of(entry->path().filename().native());
        if (owner && is_abandoned(entry->path(), *owner)) fs::remove(entry->path(), ignored);
    }
}

}  // namespace candela
