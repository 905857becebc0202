// See os/memory.h.
#include "os/memory.h"

#include <algorithm>
#include <cstdlib>

#include <malloc.h>

#include "os/windows/calls.h"

namespace candela::os {

namespace {

struct AlignedBlock {
    void* start;
    size_t size;
};

AlignedBlock* block_of(void* memory) {
    return static_cast<AlignedBlock*>(memory) - 1;
}

}  // namespace

static MEMORYSTATUSEX machine_memory() {
    MEMORYSTATUSEX status{};
    status.dwLength = sizeof status;
    GlobalMemoryStatusEx(&status);
    return status;
}

uint64_t allowed_memory() {
    const uint64_t machine = machine_memory().ullTotalPhys;
    JOBOBJECT_EXTENDED_LIMIT_INFORMATION job{};
    if (QueryInformationJobObject(nullptr, JobObjectExtendedLimitInformation, &job, sizeof job, nullptr) == 0)
        return machine;
    const bool limited = (job.BasicLimitInformation.LimitFlags & JOB_OBJECT_LIMIT_JOB_MEMORY) != 0;
    return limited ? std::min<uint64_t>(machine, job.JobMemoryLimit) : machine;
}

uint64_t free_memory() {
    return machine_memory().ullAvailPhys;
}

bool has_address_space(size_t bytes) {
    void* const room = VirtualAlloc(nullptr, bytes, MEM_RESERVE, PAGE_READWRITE);
    if (room == nullptr) return false;
    VirtualFree(room, 0, MEM_RELEASE);
    return true;
}

void* allocate(size_t size) {
    return std::malloc(size);
}

void release(void* memory) {
    std::free(memory);
}

size_t size_of(void* memory) {
    return _msize(memory);
}

// The size lies before the block, as does the start of all, since mingw-w64 has no function that tells it.
void* allocate_aligned(size_t size, size_t alignment) {
    const size_t before = std::max(alignment, sizeof(AlignedBlock));
    if (size > SIZE_MAX - before) return nullptr;
    auto* const start = static_cast<std::byte*>(_aligned_malloc(before + size, alignment));
    if (start == nullptr) return nullptr;
    std::byte* const memory = start + before;
    *block_of(memory) = {start, size};
    return memory;
}

void release_aligned(void* memory) {
    if (memory != nullptr) _aligned_free(block_of(memory)->start);
}

size_t size_of_aligned(void* memory) {
    return block_of(memory)->size;
}

}  // namespace candela::os
