// See os/library.h.
#include "os/library.h"

#include <dlfcn.h>

namespace candela::os {

Library::Library(const std::filesystem::path& file)
    : handle_(::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE)) {
    if (is_loaded()) return;
    const char* const message = ::dlerror();
    error_ = message == nullptr ? "the system gives no reason" : message;
}

void* Library::address_of(const char* name) const {
    return ::dlsym(handle_, name);
}

}  // namespace candela::os
