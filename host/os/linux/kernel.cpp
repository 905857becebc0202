// See os/posix/kernel.h, os/library.h, os/memory.h and os/process.h.
#include "os/posix/kernel.h"

#include <algorithm>
#include <cerrno>
#include <fstream>

#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

#include "os/library.h"
#include "os/memory.h"
#include "os/process.h"

namespace candela::os {

namespace fs = std::filesystem;

static uint64_t physical_memory() {
    return uint64_t(::sysconf(_SC_PHYS_PAGES)) * uint64_t(::sysconf(_SC_PAGESIZE));
}

uint64_t allowed_memory() {
    uint64_t bytes = physical_memory();
    std::ifstream groups("/proc/self/cgroup");
    std::string group;
    while (std::getline(groups, group) && !group.starts_with("0::/")) {
    }
    if (!groups) return bytes;
    // The limits of the groups above apply, too; without a limit, the file says "max".
    for (fs::path path = "/sys/fs/cgroup" + group.substr(3); path.has_relative_path();
         path = path.parent_path()) {
        uint64_t allowed = 0;
        if (std::ifstream(path / "memory.max") >> allowed) bytes = std::min(bytes, allowed);
    }
    return bytes;
}

uint64_t free_memory() {
    std::ifstream meminfo("/proc/meminfo");
    std::string word;
    while (meminfo >> word) {
        uint64_t kibibytes = 0;
        if (word == "MemAvailable:" && meminfo >> kibibytes) return kibibytes * 1024;
    }
    return physical_memory();
}

fs::path program_file() {
    std::error_code unknown;
    const fs::path file = fs::read_symlink("/proc/self/exe", unknown);
    return unknown ? fs::path() : file;
}

std::string library_file(const std::string& name, int version) {
    return "lib" + name + ".so." + std::to_string(version);
}

bool reserve(int file, uint64_t size) {
    int error = EINTR;
    while (error == EINTR)
        error = ::posix_fallocate(file, 0, off_t(size));
    return error == 0;
}

size_t usable_size(void* memory) {
    return ::malloc_usable_size(memory);
}

std::string boot_identity() {
    std::string identity;
    std::getline(std::ifstream("/proc/sys/kernel/random/boot_id"), identity);
    return identity;
}

fs::path path_of_folder(int folder) {
    return "/proc/self/fd/" + std::to_string(folder);
}

}  // namespace candela::os
