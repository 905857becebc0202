// A library for LD_PRELOAD that makes one call on files fail. Calls of open, write, fsync, rename, unlink and
// mmap (in all their variants) count from 1 on if they concern a path below the folder FILE_FAULT_FOLDER, or
// a descriptor of a file there. Call FILE_FAULT_AT fails with the errno FILE_FAULT_ERRNO; with
// FILE_FAULT_ERRNO=0 a write writes half of its bytes instead, and other calls succeed. If
// FILE_FAULT_BECOMES_FOLDER names a file, that becomes a folder just before, and the file, if there is one,
// is called NAME.was. Every call that counts adds a line "NUMBER CALL PATH" to the file FILE_FAULT_LOG, in
// another folder.
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

namespace {

// The function that ours hides.
template <class Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? "" : value;
}

std::string path_of(int descriptor) {
    char path[PATH_MAX] = "";
    const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
    return ::readlink(link.c_str(), path, sizeof path - 1) < 0 ? "" : path;
}

// The absolute path, with neither links nor dots resolved, except for the way through an open folder.
std::string absolute(int folder, const char* path) {
    constexpr const char* OPEN = "/proc/self/fd/";
    if (std::strncmp(path, OPEN, std::strlen(OPEN)) == 0) {
        char* rest = nullptr;
        const long descriptor = std::strtol(path + std::strlen(OPEN), &rest, 10);
        return path_of(int(descriptor)) + rest;
    }
    if (path[0] == '/') return path;
    char base[PATH_MAX] = "";
    if (folder == AT_FDCWD && ::getcwd(base, sizeof base) == nullptr) return "";
    return (folder == AT_FDCWD ? std::string(base) : path_of(folder)) + '/' + path;
}

// Puts a folder where somebody else might, by system calls, which are not counted.
void make_folder() {
    static const std::string place = variable("FILE_FAULT_BECOMES_FOLDER");
    if (place.empty()) return;
    ::syscall(SYS_renameat, AT_FDCWD, place.c_str(), AT_FDCWD, (place + ".was").c_str());
    ::syscall(SYS_mkdirat, AT_FDCWD, place.c_str(), 0700);
}

// Counts a call. Returns whether it is the one that fails.
bool is_chosen(const char* call, const std::string& path) {
    static const std::string folder = variable("FILE_FAULT_FOLDER") + '/';
    static const long chosen = std::atol(variable("FILE_FAULT_AT").c_str());
    // Opened by system calls, which are not counted.
    static const int log = int(::syscall(SYS_openat, AT_FDCWD, variable("FILE_FAULT_LOG").c_str(),
                                         O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600));
    static std::atomic<long> calls = 0;
    if (path.compare(0, folder.size(), folder) != 0) return false;
    const long number = ++calls;
    const std::string line = std::to_string(number) + ' ' + call + ' ' + path + '\n';
    ::syscall(SYS_write, log, line.data(), line.size());
    if (number == chosen) make_folder();
    return number == chosen;
}

// As is_chosen(), for calls that cannot do half of their work; sets errno if the call is to fail.
bool fails(const char* call, const std::string& path) {
    static const int error = std::atoi(variable("FILE_FAULT_ERRNO").c_str());
    if (!is_chosen(call, path) || error == 0) return false;
    errno = error;
    return true;
}

// The number of bytes to write, `size` at most, or -1 if the call is to fail.
ssize_t bytes_to_write(int file, size_t size) {
    static const int error = std::atoi(variable("FILE_FAULT_ERRNO").c_str());
    if (!is_chosen("write", path_of(file))) return ssize_t(size);
    errno = error;
    return error == 0 ? ssize_t(size > 1 ? size / 2 : size) : -1;
}

}  // namespace

#define PUBLIC extern "C" __attribute__((visibility("default")))

#define OPEN(name)                                                         \
    PUBLIC int name(const char* path, int flags, ...) {                    \
        va_list arguments;                                                 \
        va_start(arguments, flags);                                        \
        const mode_t mode = va_arg(arguments, mode_t);                     \
        va_end(arguments);                                                 \
        if (fails("open", absolute(AT_FDCWD, path))) return -1;            \
        return next<int(const char*, int, ...)>(#name)(path, flags, mode); \
    }
OPEN(open)
OPEN(open64)

#define OPENAT(name)                                                                    \
    PUBLIC int name(int folder, const char* path, int flags, ...) {                     \
        va_list arguments;                                                              \
        va_start(arguments, flags);                                                     \
        const mode_t mode = va_arg(arguments, mode_t);                                  \
        va_end(arguments);                                                              \
        if (fails("open", absolute(folder, path))) return -1;                           \
        return next<int(int, const char*, int, ...)>(#name)(folder, path, flags, mode); \
    }
OPENAT(openat)
OPENAT(openat64)

#define FOPEN(name)                                                      \
    PUBLIC FILE* name(const char* path, const char* mode) {              \
        if (fails("open", absolute(AT_FDCWD, path))) return nullptr;     \
        return next<FILE*(const char*, const char*)>(#name)(path, mode); \
    }
FOPEN(fopen)
FOPEN(fopen64)

PUBLIC ssize_t write(int file, const void* bytes, size_t size) {
    const ssize_t some = bytes_to_write(file, size);
    return some < 0 ? -1 : next<ssize_t(int, const void*, size_t)>("write")(file, bytes, size_t(some));
}

#define PWRITE(name)                                                                                     \
    PUBLIC ssize_t name(int file, const void* bytes, size_t size, off_t offset) {                        \
        const ssize_t some = bytes_to_write(file, size);                                                 \
        if (some < 0) return -1;                                                                         \
        return next<ssize_t(int, const void*, size_t, off_t)>(#name)(file, bytes, size_t(some), offset); \
    }
PWRITE(pwrite)
PWRITE(pwrite64)

// A short count concerns the first part only.
PUBLIC ssize_t writev(int file, const iovec* parts, int count) {
    if (count == 0) return 0;
    const ssize_t some = bytes_to_write(file, parts[0].iov_len);
    if (some < 0) return -1;
    if (size_t(some) < parts[0].iov_len)
        return next<ssize_t(int, const void*, size_t)>("write")(file, parts[0].iov_base, size_t(some));
    return next<ssize_t(int, const iovec*, int)>("writev")(file, parts, count);
}

#define FSYNC(name)                                   \
    PUBLIC int name(int file) {                       \
        if (fails("fsync", path_of(file))) return -1; \
        return next<int(int)>(#name)(file);           \
    }
FSYNC(fsync)
FSYNC(fdatasync)

// A rename concerns the file that gets a new name.
PUBLIC int rename(const char* from, const char* to) noexcept {
    if (fails("rename", absolute(AT_FDCWD, to))) return -1;
    return next<int(const char*, const char*)>("rename")(from, to);
}

PUBLIC int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
    if (fails("rename", absolute(to_folder, to))) return -1;
    return next<int(int, const char*, int, const char*)>("renameat")(from_folder, from, to_folder, to);
}

PUBLIC int renameat2(int from_folder, const char* from, int to_folder, const char* to,
                     unsigned flags) noexcept {
    if (fails("rename", absolute(to_folder, to))) return -1;
    return next<int(int, const char*, int, const char*, unsigned)>("renameat2")(from_folder, from, to_folder,
                                                                                to, flags);
}

PUBLIC int unlink(const char* path) noexcept {
    if (fails("unlink", absolute(AT_FDCWD, path))) return -1;
    return next<int(const char*)>("unlink")(path);
}

PUBLIC int unlinkat(int folder, const char* path, int flags) noexcept {
    if (fails("unlink", absolute(folder, path))) return -1;
    return next<int(int, const char*, int)>("unlinkat")(folder, path, flags);
}

PUBLIC int remove(const char* path) noexcept {
    if (fails("unlink", absolute(AT_FDCWD, path))) return -1;
    return next<int(const char*)>("remove")(path);
}

#define MMAP(name)                                                                                         \
    PUBLIC void* name(void* at, size_t size, int protection, int flags, int file, off_t offset) noexcept { \
        if (file >= 0 && fails("mmap", path_of(file))) return MAP_FAILED;                                  \
        return next<void*(void*, size_t, int, int, int, off_t)>(#name)(at, size, protection, flags, file,  \
                                                                       offset);                            \
    }
MMAP(mmap)
MMAP(mmap64)
