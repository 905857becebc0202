// See os/file.h. Permissions are those that a file's folder gives it: Windows has no others that a file keeps
// when it is replaced.
#include "os/file.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <aclapi.h>

#include "os/mapped_file.h"
#include "os/windows/calls.h"

namespace candela::os {
namespace {

namespace fs = std::filesystem;

constexpr DWORD SHARE_ALL = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

HANDLE handle_of(intptr_t file) {
    return reinterpret_cast<HANDLE>(file);
}

HANDLE open_file(const fs::path& path, DWORD access, DWORD share, DWORD how, DWORD flags = 0) {
    return CreateFileW(native(path).c_str(), access, share, nullptr, how, FILE_ATTRIBUTE_NORMAL | flags,
                       nullptr);
}

std::error_code refusal(const fs::path& file, DWORD access) {
    const Handle opened(open_file(file, access, SHARE_ALL, OPEN_EXISTING));
    return opened ? std::error_code() : error_of();
}

// What the program's token says of its user (TokenUser), or of who owns what it makes (TokenOwner).
std::vector<std::byte> token_information(TOKEN_INFORMATION_CLASS what) {
    HANDLE token = nullptr;
    if (OpenProcessToken(GetCurrentProcess(), TOKEN_QUERY, &token) == 0) return {};
    const Handle opened(token);
    DWORD size = 0;
    GetTokenInformation(token, what, nullptr, 0, &size);
    std::vector<std::byte> information(size);
    if (GetTokenInformation(token, what, information.data(), size, &size) == 0) return {};
    return information;
}

bool belongs_to_user(HANDLE file) {
    PSID owner = nullptr;
    PSECURITY_DESCRIPTOR descriptor = nullptr;
    if (GetSecurityInfo(file, SE_FILE_OBJECT, OWNER_SECURITY_INFORMATION, &owner, nullptr, nullptr, nullptr,
                        &descriptor) != ERROR_SUCCESS)
        return false;
    std::vector<std::byte> user = token_information(TokenUser), maker = token_information(TokenOwner);
    const bool own =
        (!user.empty() && EqualSid(owner, reinterpret_cast<TOKEN_USER*>(user.data())->User.Sid) != 0) ||
        (!maker.empty() && EqualSid(owner, reinterpret_cast<TOKEN_OWNER*>(maker.data())->Owner) != 0);
    LocalFree(descriptor);
    return own;
}

DWORD attributes_of(HANDLE file) {
    BY_HANDLE_FILE_INFORMATION information{};
    return GetFileInformationByHandle(file, &information) != 0 ? information.dwFileAttributes
                                                               : FILE_ATTRIBUTE_DEVICE;
}

// One that is neither a folder nor a link.
bool is_plain_file(HANDLE file) {
    constexpr DWORD OTHERS = FILE_ATTRIBUTE_DIRECTORY | FILE_ATTRIBUTE_REPARSE_POINT | FILE_ATTRIBUTE_DEVICE;
    return GetFileType(file) == FILE_TYPE_DISK && (attributes_of(file) & OTHERS) == 0;
}

}  // namespace

bool means_no_room(const std::error_code& error) {
    return error == std::errc::no_space_on_device || error == std::errc::file_too_large;
}

std::error_code refusal_to_read(const fs::path& file) {
    return refusal(file, GENERIC_READ);
}

std::error_code refusal_to_write(const fs::path& file) {
    return refusal(file, GENERIC_WRITE);
}

Obstacle obstacle_to_replacing(const fs::path&, const fs::path&) {
    return Obstacle::none;
}

std::string identity_of(const fs::path& file) {
    const Handle opened(open_file(file, 0, SHARE_ALL, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS));
    BY_HANDLE_FILE_INFORMATION information{};
    if (!opened || GetFileInformationByHandle(opened.get(), &information) == 0) return "";
    return std::to_string(information.dwVolumeSerialNumber) + ':' +
           std::to_string(information.nFileIndexHigh) + ':' + std::to_string(information.nFileIndexLow);
}

std::optional<Permissions> permissions_of(const fs::path&) {
    return std::nullopt;
}

fs::path make_temporary_folder() {
    fs::path folder = fs::temp_directory_path() / ("candela-" + random_digits());
    if (CreateDirectoryW(native(folder).c_str(), nullptr) == 0) fail("CreateDirectory");
    return folder;
}

InputFile::InputFile(const fs::path& path, Pipes, Links links)
    : file_(
          reinterpret_cast<intptr_t>(open_file(path, GENERIC_READ, SHARE_ALL, OPEN_EXISTING,
                                               links == Links::refuse ? FILE_FLAG_OPEN_REPARSE_POINT : 0))) {
    if (!is_open()) {
        error_ = error_of();
    } else if (links == Links::refuse &&
               (attributes_of(handle_of(file_)) & FILE_ATTRIBUTE_REPARSE_POINT) != 0) {
        error_ = std::make_error_code(std::errc::too_many_symbolic_link_levels);
    }
}

InputFile::~InputFile() {
    if (is_open()) CloseHandle(handle_of(file_));
}

bool InputFile::is_regular() const {
    return is_open() && is_plain_file(handle_of(file_));
}

bool InputFile::is_own() const {
    return is_open() && belongs_to_user(handle_of(file_));
}

uint64_t InputFile::size() const {
    LARGE_INTEGER size{};
    const bool known = is_regular() && GetFileSizeEx(handle_of(file_), &size) != 0;
    return known ? uint64_t(size.QuadPart) : 0;
}

size_t InputFile::read(std::span<char> buffer) {
    DWORD count = 0;
    const auto size = DWORD(std::min<size_t>(buffer.size(), size_t{1} << 30));
    if (ReadFile(handle_of(file_), buffer.data(), size, &count, nullptr) == 0 &&
        GetLastError() != ERROR_BROKEN_PIPE)
        error_ = error_of();
    return count;
}

size_t InputFile::read_at(uint64_t offset, std::span<std::byte> bytes) {
    OVERLAPPED place{};
    place.Offset = DWORD(offset);
    place.OffsetHigh = DWORD(offset >> 32);
    DWORD count = 0;
    const auto size = DWORD(std::min<size_t>(bytes.size(), size_t{1} << 30));
    if (ReadFile(handle_of(file_), bytes.data(), size, &count, &place) == 0 &&
        GetLastError() != ERROR_HANDLE_EOF)
        error_ = error_of();
    return count;
}

// Locked for all who want to write.
OutputFile::OutputFile(fs::path path, std::optional<Permissions>) : path_(std::move(path)) {
    file_ = reinterpret_cast<intptr_t>(open_file(path_, GENERIC_WRITE, FILE_SHARE_READ, CREATE_NEW));
    if (file_ == -1) fail("CreateFile");
}

OutputFile::~OutputFile() {
    if (file_ != -1) CloseHandle(handle_of(file_));
}

void OutputFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        DWORD count = 0;
        const auto size = DWORD(std::min<size_t>(bytes.size(), size_t{1} << 30));
        if (WriteFile(handle_of(file_), bytes.data(), size, &count, nullptr) == 0) fail("WriteFile");
        bytes.remove_prefix(count);
    }
}

void OutputFile::flush() {
    if (FlushFileBuffers(handle_of(file_)) == 0) fail("FlushFileBuffers");
}

// Programs that look at all new files, for viruses or for an index, keep others from them for a moment.
void OutputFile::rename(const fs::path& target) {
    constexpr int TRIES = 50;
    constexpr DWORD PAUSE = 20;  // [ms]
    CloseHandle(handle_of(file_));
    file_ = -1;
    for (int i = 1;; ++i) {
        if (MoveFileExW(native(path_).c_str(), native(target).c_str(),
                        MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) != 0)
            return;
        const DWORD error = GetLastError();
        if ((error != ERROR_ACCESS_DENIED && error != ERROR_SHARING_VIOLATION) || i == TRIES)
            throw std::system_error(error_of(error), "MoveFileEx");
        Sleep(PAUSE);
    }
}

void make_empty_file(const fs::path& path) {
    const Handle file(open_file(path, GENERIC_WRITE, 0, CREATE_NEW));
    if (!file) fail("CreateFile");
}

bool is_unlocked(const fs::path& file) {
    return bool(
        Handle(open_file(file, GENERIC_WRITE, SHARE_ALL, OPEN_EXISTING, FILE_FLAG_OPEN_REPARSE_POINT)));
}

// In the user's profile, where caches are, new folders are for the user alone. While it is open, it cannot be
// replaced.
PrivateFolder::PrivateFolder(const fs::path& path, bool make) : path_(path) {
    std::error_code ignored;
    if (make) fs::create_directories(path, ignored);
    const HANDLE folder = open_file(path, GENERIC_READ, FILE_SHARE_READ | FILE_SHARE_WRITE, OPEN_EXISTING,
                                    FILE_FLAG_BACKUP_SEMANTICS | FILE_FLAG_OPEN_REPARSE_POINT);
    folder_ = reinterpret_cast<intptr_t>(folder);
    if (folder_ == -1) return;
    constexpr DWORD KIND = FILE_ATTRIBUTE_DIRECTORY | FILE_ATTRIBUTE_REPARSE_POINT;
    exists_ = (attributes_of(folder) & KIND) == FILE_ATTRIBUTE_DIRECTORY && belongs_to_user(folder);
}

PrivateFolder::~PrivateFolder() {
    if (folder_ != -1) CloseHandle(handle_of(folder_));
}

std::optional<std::string> PrivateFolder::read(const std::string& name, size_t max) const {
    InputFile file(path_ / name, InputFile::Pipes::refuse, InputFile::Links::refuse);
    if (!file.is_regular() || !file.is_own() || file.size() > max) return std::nullopt;
    std::string bytes(size_t(file.size()), '\0');
    for (size_t done = 0; done < bytes.size();) {
        const size_t count = file.read(std::span(bytes).subspan(done));
        if (count == 0) return std::nullopt;
        done += count;
    }
    return bytes;
}

}  // namespace candela::os
