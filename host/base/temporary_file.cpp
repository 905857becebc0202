// See temporary_file.h.
#include "base/temporary_file.h"

#include <array>
#include <atomic>
#include <charconv>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <utility>

#include "base/hash.h"
#include "os/process.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view SUFFIX = ".tmp";

// The beginning of the names of this computer's files until it is restarted: ".candela-", 16 hexadecimal
// digits and "-". Empty if the system does not identify itself and its last start.
const std::string& own_prefix() {
    static const std::string prefix = [] {
        const std::string computer = os::computer_since_start();
        if (computer.empty()) return std::string();
        std::array<char, 32> digits{};
        std::snprintf(digits.data(), digits.size(), "%016llx",
                      static_cast<unsigned long long>(fnv1a64(std::as_bytes(std::span(computer)))));
        return std::string(".candela-") + digits.data() + '-';
    }();
    return prefix;
}

// Independent of the target's name, so that it never exceeds the longest name allowed.
std::string new_name() {
    static std::atomic<unsigned> counter = 0;
    const std::string prefix = own_prefix().empty() ? ".candela-" : own_prefix();
    return prefix + std::to_string(os::process_id()) + '-' + std::to_string(counter++) + std::string(SUFFIX);
}

// The process that a file of that name belongs to; nothing if it is another computer's, or not a temporary
// file.
std::optional<int> owner_of(std::string_view name) {
    const std::string& prefix = own_prefix();
    if (prefix.empty() || !name.starts_with(prefix) || !name.ends_with(SUFFIX)) return std::nullopt;
    name.remove_prefix(prefix.size());
    int owner = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), owner);
    return error == std::errc() && *end == '-' && owner > 0 ? std::optional(owner) : std::nullopt;
}

// Calls create(path) with names that next() makes, until there is no file of that name. Returns the path.
template <class Next, class Create>
fs::path create_new(const Next& next, const Create& create) {
    while (true) {
        fs::path path = next();
        try {
            create(path);
            return path;
        } catch (const std::system_error& error) {
            if (error.code() != std::errc::file_exists) throw;
        }
    }
}

}  // namespace

TemporaryFile::TemporaryFile(fs::path target, std::optional<os::Permissions> permissions)
    : target_(std::move(target)) {
    // Another file of that name was left behind by an earlier process of that number.
    name_ = create_new([this] { return target_.parent_path() / new_name(); },
                       [&](const fs::path& path) { file_.emplace(path, permissions); });
}

TemporaryFile::~TemporaryFile() {
    file_.reset();
    std::error_code ignored;
    if (!committed_) fs::remove(name_, ignored);
}

void TemporaryFile::write(std::string_view bytes) {
    file_->write(bytes);
}

void TemporaryFile::flush() {
    file_->flush();
}

void TemporaryFile::commit() {
    file_->rename(target_);
    committed_ = true;
}

fs::path TemporaryFile::commit_beside() {
    const std::string stem = target_.stem().string(), extension = target_.extension().string();
    int i = 0;
    // Once a file of that name exists and is ours, it can be replaced.
    target_ =
        create_new([&] { return target_.parent_path() / (stem + '-' + std::to_string(++i) + extension); },
                   os::make_empty_file);
    try {
        commit();
    } catch (const std::system_error&) {
        std::error_code ignored;
        fs::remove(target_, ignored);
        throw;
    }
    return target_;
}

void remove_abandoned_files(const fs::path& folder) {
    std::error_code ignored;
    for (fs::directory_iterator entry(folder, ignored); entry != fs::directory_iterator();
         entry.increment(ignored)) {
        const fs::path& file = entry->path();
        const std::optional<int> owner = owner_of(file.filename().string());
        // A process that has ended may only be invisible from here, but then it has its lock.
        if (owner && !os::may_run(*owner) && os::is_unlocked(file)) fs::remove(file, ignored);
    }
}

}  // namespace candela
