// See os/posix/kernel.h, os/library.h, os/memory.h and os/process.h.
#include "os/posix/kernel.h"

#include <array>

#include <fcntl.h>
#include <mach-o/dyld.h>
#include <mach/mach.h>
#include <malloc/malloc.h>
#include <sys/param.h>
#include <sys/sysctl.h>
#include <unistd.h>

#include "os/library.h"
#include "os/memory.h"
#include "os/process.h"

namespace candela::os {

namespace fs = std::filesystem;

uint64_t allowed_memory() {
    uint64_t bytes = 0;
    size_t size = sizeof bytes;
    return ::sysctlbyname("hw.memsize", &bytes, &size, nullptr, 0) == 0 ? bytes : UINT64_MAX;
}

uint64_t free_memory() {
    vm_statistics64_data_t statistics{};
    mach_msg_type_number_t size = HOST_VM_INFO64_COUNT;
    if (::host_statistics64(::mach_host_self(), HOST_VM_INFO64, reinterpret_cast<host_info64_t>(&statistics),
                            &size) != KERN_SUCCESS)
        return allowed_memory();
    return (uint64_t(statistics.free_count) + statistics.inactive_count) * uint64_t(::sysconf(_SC_PAGESIZE));
}

fs::path program_file() {
    std::array<char, MAXPATHLEN> path{};
    auto size = uint32_t(path.size());
    std::error_code unknown;
    if (::_NSGetExecutablePath(path.data(), &size) != 0) return {};
    const fs::path file = fs::canonical(path.data(), unknown);
    return unknown ? fs::path() : file;
}

std::string library_file(const std::string& name, int version) {
    return "lib" + name + '.' + std::to_string(version) + ".dylib";
}

bool reserve(int file, uint64_t size) {
    fstore_t room{};
    room.fst_flags = F_ALLOCATEALL;
    room.fst_posmode = F_PEOFPOSMODE;
    room.fst_length = off_t(size);
    return ::fcntl(file, F_PREALLOCATE, &room) == 0 && ::ftruncate(file, off_t(size)) == 0;
}

size_t usable_size(void* memory) {
    return ::malloc_size(memory);
}

std::string boot_identity() {
    std::array<char, 64> identity{};
    size_t size = identity.size() - 1;
    return ::sysctlbyname("kern.bootsessionuuid", identity.data(), &size, nullptr, 0) == 0 ? identity.data()
                                                                                           : "";
}

fs::path path_of_folder(int folder) {
    std::array<char, MAXPATHLEN> path{};
    return ::fcntl(folder, F_GETPATH, path.data()) == 0 ? path.data() : "";
}

}  // namespace candela::os
