// See os/memory.h.
#include "os/memory.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

namespace candela::os {

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
    for (std::filesystem::path path = "/sys/fs/cgroup" + group.substr(3); path.has_relative_path();
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

bool has_address_space(size_t bytes) {
    void* const room =
        ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room == MAP_FAILED) return false;
    ::munmap(room, bytes);
    return true;
}

void* allocate(size_t size) {
    return std::malloc(size);
}

void release(void* memory) {
    std::free(memory);
}

size_t size_of(void* memory) {
    return ::malloc_usable_size(memory);
}

void* allocate_aligned(size_t size, size_t alignment) {
    return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

void release_aligned(void* memory) {
    std::free(memory);
}

size_t size_of_aligned(void* memory) {
    return ::malloc_usable_size(memory);
}

}  // namespace candela::os
