// A library for LD_PRELOAD that lets the system run out of threads: the first THREAD_FAULT_AFTER calls of
// pthread_create start one, and all later ones fail, as where a user may have no more. Every call adds a line
// to the file THREAD_FAULT_LOG.
#include <atomic>
#include <cerrno>
#include <cstdlib>

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <unistd.h>

using Start = void* (*)(void*);
using Create = int(pthread_t*, const pthread_attr_t*, Start, void*);

extern "C" __attribute__((visibility("default"))) int pthread_create(pthread_t* thread,
                                                                     const pthread_attr_t* attributes,
                                                                     Start start, void* argument) noexcept {
    static Create* const next = reinterpret_cast<Create*>(::dlsym(RTLD_NEXT, "pthread_create"));
    static const long allowed = std::atol(std::getenv("THREAD_FAULT_AFTER"));
    static const int log =
        ::open(std::getenv("THREAD_FAULT_LOG"), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    static std::atomic<long> calls = 0;
    if (::write(log, "thread\n", 7) != 7) std::abort();
    return ++calls > allowed ? EAGAIN : next(thread, attributes, start, argument);
}
