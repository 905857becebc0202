// See os/library.h.
#include "os/library.h"

#include "os/windows/calls.h"

namespace candela::os {

std::string library_file(const std::string& name, int) {
    return name + ".dll";
}

// What it needs is looked for beside it, too.
Library::Library(const std::filesystem::path& file) {
    const bool by_system = !file.has_parent_path();
    const DWORD where = LOAD_LIBRARY_SEARCH_DEFAULT_DIRS | (by_system ? 0 : LOAD_LIBRARY_SEARCH_DLL_LOAD_DIR);
    const std::wstring path = by_system ? file.native() : native(std::filesystem::absolute(file));
    handle_ = LoadLibraryExW(path.c_str(), nullptr, where);
    if (handle_ == nullptr) error_ = std::system_category().message(int(GetLastError()));
}

void* Library::address_of(const char* name) const {
    return reinterpret_cast<void*>(GetProcAddress(static_cast<HMODULE>(handle_), name));
}

}  // namespace candela::os
