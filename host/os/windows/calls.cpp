// See calls.h.
#include "os/windows/calls.h"

namespace candela::os {

std::error_code error_of(DWORD code) {
    const std::error_condition known = std::system_category().default_error_condition(int(code));
    if (known.category() == std::generic_category()) return {known.value(), std::generic_category()};
    return std::make_error_code(code == ERROR_DISK_FULL ? std::errc::no_space_on_device
                                                        : std::errc::io_error);
}

void fail(const char* call) {
    throw std::system_error(error_of(), call);
}

std::wstring wide(std::string_view utf8) {
    const int size = MultiByteToWideChar(CP_UTF8, 0, utf8.data(), int(utf8.size()), nullptr, 0);
    std::wstring result(size_t(size), L'\0');
    MultiByteToWideChar(CP_UTF8, 0, utf8.data(), int(utf8.size()), result.data(), size);
    return result;
}

std::string utf8(std::wstring_view wide) {
    const int size =
        WideCharToMultiByte(CP_UTF8, 0, wide.data(), int(wide.size()), nullptr, 0, nullptr, nullptr);
    std::string result(size_t(size), '\0');
    WideCharToMultiByte(CP_UTF8, 0, wide.data(), int(wide.size()), result.data(), size, nullptr, nullptr);
    return result;
}

std::wstring native(const std::filesystem::path& path) {
    constexpr size_t ALWAYS_ALLOWED = 240;
    constexpr std::wstring_view LONG = L"\\\\?\\", SHARE = L"\\\\";
    std::error_code ignored;
    std::filesystem::path absolute = std::filesystem::absolute(path, ignored).lexically_normal();
    absolute.make_preferred();
    const std::wstring& text = absolute.native();
    if (ignored || text.size() < ALWAYS_ALLOWED || text.starts_with(LONG)) return path.native();
    if (text.starts_with(SHARE)) return std::wstring(LONG) + L"UNC\\" + text.substr(SHARE.size());
    return std::wstring(LONG) + text;
}

}  // namespace candela::os
