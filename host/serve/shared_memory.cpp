// See shared_memory.h.
#include "serve/shared_memory.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/error.h"
#include "os/process.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

// What the names begin with; the number of the process and a random number follow.
constexpr std::string_view PREFIX = "candela-shared-";

std::string prefix_of(int process) {
    return std::string(PREFIX) + std::to_string(process) + '-';
}

// The folders where shared memory may be, for messages.
std::string places(const char* between) {
    std::string text;
    for (const fs::path& folder : os::mapped_file_folders())
        text += (text.empty() ? "" : between) + folder.string();
    return text;
}

// Calls action(path) for each file that may be shared memory, until that returns true; returns whether it
// did.
template <class Action>
bool for_any_file(std::string_view prefix, const Action& action) {
    for (const fs::path& folder : os::mapped_file_folders()) {
        std::error_code error;
        for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
             entry.increment(error)) {
            if (entry->path().filename().string().starts_with(prefix) && action(entry->path())) return true;
        }
    }
    return false;
}

}  // namespace

SharedMemory::SharedMemory(uint64_t size) {
    for (const fs::path& folder : os::mapped_file_folders()) {
        file_ = std::make_unique<os::MappedFile>(folder / (prefix_of(os::process_id()) + os::random_digits()),
                                                 size);
        if (file_->is_mapped()) return;
    }
    throw Error("cannot share " + std::to_string(size) +
                    " bytes of memory with another program: there is no room in " + places(" and ") +
                    "; make some, or name another folder (" + os::TEMPORARY_FOLDER_VARIABLE + ')',
                ErrorKind::out_of_memory);
}

SharedFile::SharedFile(const fs::path& path) : path_(path) {
    const std::vector<fs::path> folders = os::mapped_file_folders();
    const auto is_place = [&](const fs::path& folder) { return path == folder / path.filename(); };
    if (path.filename().string().starts_with(PREFIX) && std::ranges::any_of(folders, is_place))
        file_ =
            std::make_unique<os::InputFile>(path, os::InputFile::Pipes::refuse, os::InputFile::Links::refuse);
    if (file_ == nullptr || !file_->is_regular() || !file_->is_own()) {
        throw Error("no shared memory is called \"" + path.string() +
                    "\": it must be a file of this user in " + places(" or ") +
                    ", whose name begins with \"" + std::string(PREFIX) + '"');
    }
    size_ = file_->size();
}

void SharedFile::read(uint64_t offset, std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
        const size_t count = file_->read_at(offset, bytes);
        if (count == 0) {
            throw Error("the shared memory \"" + path_.string() + "\" ends before byte " +
                        std::to_string(offset + bytes.size()) +
                        "; keep the file as it is until the scene is loaded");
        }
        offset += count;
        bytes = bytes.subspan(count);
    }
}

void remove_abandoned_memory() {
    for_any_file(PREFIX, [](const fs::path& path) {
        os::remove_unlocked_file(path);
        return false;
    });
}

void remove_abandoned_memory_of(int process) {
    constexpr int TIMES = 200;
    constexpr std::chrono::milliseconds PAUSE{10};
    for (int i = 0; i < TIMES; ++i) {
        remove_abandoned_memory();
        if (!for_any_file(prefix_of(process), [](const fs::path&) { return true; })) return;
        std::this_thread::sleep_for(PAUSE);
    }
}

}  // namespace candela
