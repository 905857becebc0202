// See os/mapped_file.h. A file that is open, here or elsewhere, cannot be removed.
#include "os/mapped_file.h"

#include <array>

#include <ntsecapi.h>

#include "os/windows/calls.h"

namespace candela::os {

namespace fs = std::filesystem;

const char* const TEMPORARY_FOLDER_VARIABLE = "TMP";

std::vector<fs::path> mapped_file_folders() {
    std::error_code ignored;
    const fs::path temporary = fs::temp_directory_path(ignored);
    return temporary.empty() ? std::vector<fs::path>() : std::vector<fs::path>{temporary};
}

std::string random_digits() {
    constexpr char DIGITS[] = "0123456789abcdef";
    std::array<unsigned char, 12> random{};
    if (RtlGenRandom(random.data(), ULONG(random.size())) == 0) fail("RtlGenRandom");
    std::string digits;
    for (const unsigned char byte : random)
        (digits += DIGITS[byte >> 4]) += DIGITS[byte & 15];
    return digits;
}

// The mapping gives the file its size, and the room on the disk.
MappedFile::MappedFile(const fs::path& path, uint64_t size) : path_(path) {
    const HANDLE file =
        CreateFileW(native(path).c_str(), GENERIC_READ | GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE,
                    nullptr, CREATE_NEW, FILE_ATTRIBUTE_TEMPORARY, nullptr);
    file_ = reinterpret_cast<intptr_t>(file);
    if (file_ == -1) return;
    const Handle mapping(
        CreateFileMappingW(file, nullptr, PAGE_READWRITE, DWORD(size >> 32), DWORD(size), nullptr));
    void* const memory = mapping ? MapViewOfFile(mapping.get(), FILE_MAP_ALL_ACCESS, 0, 0, size) : nullptr;
    if (memory != nullptr) bytes_ = {static_cast<std::byte*>(memory), size};
}

MappedFile::~MappedFile() {
    if (is_mapped()) UnmapViewOfFile(bytes_.data());
    if (file_ == -1) return;
    CloseHandle(reinterpret_cast<HANDLE>(file_));
    DeleteFileW(native(path_).c_str());
}

void remove_unlocked_file(const fs::path& path) {
    DeleteFileW(native(path).c_str());
}

}  // namespace candela::os
