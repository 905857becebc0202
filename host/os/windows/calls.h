// What all calls of Windows need: its header, errors, and texts and paths in its form.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#define WIN32_LEAN_AND_MEAN
#include <windows.h>

namespace candela::os {

// Closes a handle at the end.
class Handle {
  public:
    explicit Handle(HANDLE handle) : handle_(handle) {}
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    ~Handle() {
        if (*this) CloseHandle(handle_);
    }

    explicit operator bool() const { return handle_ != INVALID_HANDLE_VALUE && handle_ != nullptr; }
    HANDLE get() const { return handle_; }

  private:
    HANDLE handle_;
};

// An error of Windows, by default that of the last call, as one of std::generic_category().
std::error_code error_of(DWORD code = GetLastError());
[[noreturn]] void fail(const char* call);

std::wstring wide(std::string_view utf8);
std::string utf8(std::wstring_view wide);

// The path for calls of Windows, which take more than 260 characters only in a form of their own.
std::wstring native(const std::filesystem::path& path);

}  // namespace candela::os
