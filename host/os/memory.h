// The machine's memory, and blocks of it that know their size.
#pragma once

#include <cstddef>
#include <cstdint>

namespace candela::os {

// Bytes of RAM that this program may use: the machine's, or what its group of programs is allowed, if that is
// less.
uint64_t allowed_memory();

// Bytes of RAM that programs can still allocate; all of the RAM if the system does not tell.
uint64_t free_memory();

// Whether that many bytes of writable memory can be promised to the program, used or not.
bool has_address_space(size_t bytes);

// As malloc() and aligned_alloc(): nullptr if there is no memory. Blocks of the one kind must not be released
// or measured as the other.
void* allocate(size_t size);
void release(void* memory);
size_t size_of(void* memory);
void* allocate_aligned(size_t size, size_t alignment);
void release_aligned(void* memory);
size_t size_of_aligned(void* memory);

}  // namespace candela::os
