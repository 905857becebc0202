// See os/process.h.
#include "os/process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "os/posix/kernel.h"

extern char** environ;  // Which macOS leaves to the program to declare.

namespace candela::os {
namespace {

double seconds(const timeval& time) {
    return double(time.tv_sec) + 1e-6 * double(time.tv_usec);
}

std::vector<char*> pointers(std::vector<std::string>& words) {
    std::vector<char*> result;
    for (std::string& word : words)
        result.push_back(word.data());
    result.push_back(nullptr);
    return result;
}

// Our environment with these variables ("NAME=value") added or replaced.
std::vector<std::string> environment_with(const std::vector<std::string>& variables) {
    std::vector<std::string> all = variables;
    for (char** variable = environ; *variable != nullptr; ++variable) {
        const std::string_view old(*variable);
        const auto same_name = [&](const std::string& s) {
            return old.starts_with(s.substr(0, s.find('=') + 1));
        };
        if (std::ranges::none_of(variables, same_name)) all.emplace_back(old);
    }
    return all;
}

}  // namespace

int process_id() {
    return ::getpid();
}

int parent_process_id() {
    return ::getppid();
}

bool may_run(int process) {
    return ::kill(process, 0) == 0 || errno != ESRCH;
}

std::string computer_since_start() {
    std::array<char, 256> host{};
    const std::string boot = boot_identity();
    if (boot.empty() || ::gethostname(host.data(), host.size() - 1) != 0) return "";
    return boot + host.data();
}

ProgramEnd run_program(const ProgramCall& call) {
    std::vector<std::string> words = call.words, environment = environment_with(call.variables);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    if (call.output) {
        ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, call.output->c_str(),
                                           O_WRONLY | O_CREAT | O_TRUNC, S_IRUSR | S_IWUSR);
        ::posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    }
    pid_t pid = 0;
    const int error = ::posix_spawnp(&pid, words[0].c_str(), &actions, nullptr, pointers(words).data(),
                                     pointers(environment).data());
    ::posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::system_error(error, std::generic_category(), "posix_spawn");
    int status = 0;
    rusage usage{};
    while (::wait4(pid, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    const bool exited = WIFEXITED(status);
    return {.exited = exited,
            .code = exited ? WEXITSTATUS(status) : WTERMSIG(status),
            .cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime)};
}

}  // namespace candela::os
