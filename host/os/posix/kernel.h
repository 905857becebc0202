// What Linux and macOS do differently, of that which os/posix needs. host/os/linux and host/os/macos
// implement it; the interfaces in host/os say what their functions do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace candela::os {

// Gives an empty, open file this many bytes. Returns whether it has the room for good, so that writing to
// them cannot fail.
bool reserve(int file, uint64_t size);

// How many bytes a block of malloc() has, which may be more than were asked for.
size_t usable_size(void* memory);

// Another one after each start of the computer; empty if the system does not say.
std::string boot_identity();

// A path to an open folder, for the names of files in it: on Linux it leads there whatever becomes of the
// folder's name, on macOS to where the folder was when it was asked for.
std::filesystem::path path_of_folder(int folder);

}  // namespace candela::os
