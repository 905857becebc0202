// See os/memory.h.
#include "os/memory.h"

#include <cstdlib>

#include <sys/mman.h>

#include "os/posix/kernel.h"

namespace candela::os {

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
    return usable_size(memory);
}

void* allocate_aligned(size_t size, size_t alignment) {
    return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

void release_aligned(void* memory) {
    std::free(memory);
}

size_t size_of_aligned(void* memory) {
    return usable_size(memory);
}

}  // namespace candela::os
