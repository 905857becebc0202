// See os/process.h.
#include "os/process.h"

#include <algorithm>
#include <array>
#include <vector>

#include <tlhelp32.h>

#include "os/windows/calls.h"

namespace candela::os {
namespace {

// A word of a command line, as the C run-time library of the program takes it apart.
// Ref: Microsoft, "Parsing C command-line arguments".
std::wstring quoted_word(const std::wstring& word) {
    if (!word.empty() && word.find_first_of(L" \t\n\v\"") == std::wstring::npos) return word;
    std::wstring result = L"\"";
    size_t backslashes = 0;
    for (const wchar_t c : word) {
        if (c == L'"') result.append(backslashes + 1, L'\\');  // Doubles those before it, and adds its own.
        backslashes = c == L'\\' ? backslashes + 1 : 0;
        result += c;
    }
    return result.append(backslashes, L'\\') + L'"';
}

std::wstring name_of(const std::wstring& variable) {
    std::wstring name = variable.substr(0, variable.find(L'=', 1));
    std::ranges::transform(name, name.begin(), [](wchar_t c) { return wchar_t(towupper(c)); });
    return name;
}

// Our environment with these variables ("NAME=value") added or replaced, sorted and in the form of Windows.
std::wstring environment_with(const std::vector<std::string>& variables) {
    std::vector<std::wstring> all;
    for (const std::string& variable : variables)
        all.push_back(wide(variable));
    const size_t given = all.size();
    wchar_t* const ours = GetEnvironmentStringsW();
    for (const wchar_t* old = ours; *old != L'\0'; old += std::wstring_view(old).size() + 1) {
        const auto same_name = [&](const std::wstring& s) { return name_of(s) == name_of(old); };
        if (std::none_of(all.begin(), all.begin() + ptrdiff_t(given), same_name)) all.emplace_back(old);
    }
    FreeEnvironmentStringsW(ours);
    std::ranges::sort(all, {}, name_of);
    std::wstring block;
    for (const std::wstring& variable : all)
        block.append(variable) += L'\0';
    return block += L'\0';
}

double seconds(const FILETIME& time) {
    return 1e-7 * double(uint64_t(time.dwHighDateTime) << 32 | time.dwLowDateTime);
}

}  // namespace

int process_id() {
    return int(GetCurrentProcessId());
}

int parent_process_id() {
    const Handle snapshot(CreateToolhelp32Snapshot(TH32CS_SNAPPROCESS, 0));
    PROCESSENTRY32W entry{};
    entry.dwSize = sizeof entry;
    for (BOOL more = Process32FirstW(snapshot.get(), &entry); more != 0;
         more = Process32NextW(snapshot.get(), &entry)) {
        if (entry.th32ProcessID == GetCurrentProcessId()) return int(entry.th32ParentProcessID);
    }
    return 0;
}

bool may_run(int process) {
    const Handle opened(OpenProcess(SYNCHRONIZE, FALSE, DWORD(process)));
    if (!opened) return GetLastError() != ERROR_INVALID_PARAMETER;
    return WaitForSingleObject(opened.get(), 0) == WAIT_TIMEOUT;
}

// Its name alone: a file that a program keeps open stays locked, whatever the program's number.
std::string computer_since_start() {
    std::array<wchar_t, MAX_COMPUTERNAME_LENGTH + 1> name{};
    auto size = DWORD(name.size());
    return GetComputerNameW(name.data(), &size) != 0 ? utf8({name.data(), size}) : "";
}

std::filesystem::path program_file() {
    std::wstring name(32768, L'\0');  // Longer than any path.
    name.resize(GetModuleFileNameW(nullptr, name.data(), DWORD(name.size())));
    return name;
}

ProgramEnd run_program(const ProgramCall& call) {
    std::wstring line;
    for (const std::string& word : call.words)
        line += (line.empty() ? L"" : L" ") + quoted_word(wide(word));
    std::wstring environment = environment_with(call.variables);
    STARTUPINFOW start{};
    start.cb = sizeof start;
    SECURITY_ATTRIBUTES inherited{sizeof(SECURITY_ATTRIBUTES), nullptr, TRUE};
    const Handle output(call.output ? CreateFileW(native(*call.output).c_str(), GENERIC_WRITE,
                                                  FILE_SHARE_READ | FILE_SHARE_DELETE, &inherited,
                                                  CREATE_ALWAYS, FILE_ATTRIBUTE_NORMAL, nullptr)
                                    : INVALID_HANDLE_VALUE);
    if (output) {
        start.dwFlags = STARTF_USESTDHANDLES;
        start.hStdInput = GetStdHandle(STD_INPUT_HANDLE);
        start.hStdOutput = start.hStdError = output.get();
    }
    PROCESS_INFORMATION process{};
    if (CreateProcessW(nullptr, line.data(), nullptr, nullptr, output ? TRUE : FALSE,
                       CREATE_UNICODE_ENVIRONMENT, environment.data(), nullptr, &start, &process) == 0)
        fail("CreateProcess");
    const Handle started(process.hProcess), thread(process.hThread);
    WaitForSingleObject(started.get(), INFINITE);
    DWORD code = 0;
    GetExitCodeProcess(started.get(), &code);
    FILETIME begin{}, end{}, kernel{}, user{};
    GetProcessTimes(started.get(), &begin, &end, &kernel, &user);
    return {.exited = code < 0xc0000000, .code = int(code), .cpu_seconds = seconds(kernel) + seconds(user)};
}

}  // namespace candela::os
