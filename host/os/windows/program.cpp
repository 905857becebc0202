// See os/program.h.
#include "os/program.h"

#include <cstdlib>

#include <fcntl.h>
#include <io.h>
#include <shellapi.h>

#include "os/windows/calls.h"

namespace candela::os {
namespace {

// The version that RtlGetVersion() tells; others tell the one that a program says it knows.
OSVERSIONINFOW windows_version() {
    OSVERSIONINFOW version{};
    version.dwOSVersionInfoSize = sizeof version;
    using Get = LONG(WINAPI*)(OSVERSIONINFOW*);
    void* const get =
        reinterpret_cast<void*>(GetProcAddress(GetModuleHandleW(L"ntdll.dll"), "RtlGetVersion"));
    if (get != nullptr) reinterpret_cast<Get>(get)(&version);
    return version;
}

}  // namespace

std::vector<std::string> start_program(int, char**) {
    for (const int stream : {0, 1, 2})
        _setmode(stream, _O_BINARY);
    SetConsoleOutputCP(CP_UTF8);
    const HANDLE errors = GetStdHandle(STD_ERROR_HANDLE);
    if (DWORD mode = 0; GetConsoleMode(errors, &mode) != 0)
        SetConsoleMode(errors, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
    int count = 0;
    wchar_t** const words = CommandLineToArgvW(GetCommandLineW(), &count);
    std::vector<std::string> result;
    for (int i = 0; i < count; ++i)
        result.push_back(utf8(words[i]));
    LocalFree(words);
    if (result.empty()) result.emplace_back("candela");
    return result;
}

std::string environment(const char* name) {
    const std::wstring wide_name = wide(name);
    std::wstring value(GetEnvironmentVariableW(wide_name.c_str(), nullptr, 0), L'\0');
    value.resize(GetEnvironmentVariableW(wide_name.c_str(), value.data(), DWORD(value.size())));
    return utf8(value);
}

void set_default_environment(const char* name, const char* value) {
    if (environment(name).empty()) SetEnvironmentVariableW(wide(name).c_str(), wide(value).c_str());
}

std::optional<std::filesystem::path> cache_folder() {
    for (const char* const name : {"XDG_CACHE_HOME", "LOCALAPPDATA"}) {
        const std::filesystem::path folder = environment(name);
        if (folder.is_absolute()) return folder;
    }
    return std::nullopt;
}

bool stderr_is_terminal() {
    DWORD mode = 0;
    return GetConsoleMode(GetStdHandle(STD_ERROR_HANDLE), &mode) != 0 &&
           (mode & ENABLE_VIRTUAL_TERMINAL_PROCESSING) != 0;
}

std::string system_text() {
    const OSVERSIONINFOW version = windows_version();
    return "Windows " + std::to_string(version.dwMajorVersion) + '.' +
           std::to_string(version.dwMinorVersion) + '.' + std::to_string(version.dwBuildNumber) + " x86_64";
}

}  // namespace candela::os
