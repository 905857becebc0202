// Starts, reads and ends processes through POSIX calls.
#include "support/process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/wait.h"

extern char** environ;

namespace candela {
namespace {

// Two connected descriptors that the child does not inherit unless told to.
struct Channel {
    int ours = -1;
    int theirs = -1;
};

Channel make_pipe() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("cannot create a pipe");
    return {ends[0], ends[1]};
}

Channel make_terminal() {
    const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (master < 0 || ::grantpt(master) != 0 || ::unlockpt(master) != 0) {
        throw std::runtime_error("cannot create a terminal");
    }
    return {master, ::open(::ptsname(master), O_WRONLY | O_NOCTTY | O_CLOEXEC)};
}

std::vector<std::string> merge_environment(std::map<std::string, std::string> variables) {
    for (char** entry = environ; *entry != nullptr; ++entry) {
        const std::string text = *entry;
        const size_t equals = text.find('=');
        variables.emplace(text.substr(0, equals), text.substr(equals + 1));  // Keeps what is there.
    }
    std::vector<std::string> merged;
    for (const auto& [name, value] : variables)
        merged.push_back(name + '=' + value);
    return merged;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
    std::vector<char*> result;
    for (std::string& word : words)
        result.push_back(word.data());
    result.push_back(nullptr);
    return result;
}

}  // namespace

Process::Process(const std::vector<std::string>& arguments, const ProcessOptions& options) {
    const Channel out = make_pipe();
    const Channel err = options.terminal ? make_terminal() : make_pipe();
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, out.theirs, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err.theirs, STDERR_FILENO);

    std::vector<std::string> words = arguments;
    std::vector<std::string> environment = merge_environment(options.environment);
    const int error = ::posix_spawn(&pid_, words[0].c_str(), &actions, nullptr, pointers(words).data(),
                                    pointers(environment).data());
    posix_spawn_file_actions_destroy(&actions);
    ::close(out.theirs);
    ::close(err.theirs);
    out_ = out.ours;
    err_ = err.ours;
    if (error != 0) throw std::runtime_error("cannot start " + words[0]);
}

Process::~Process() {
    if (pid_ > 0) {
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
    }
    if (out_ >= 0) ::close(out_);
    if (err_ >= 0) ::close(err_);
}

// Waits for output and appends it to the result. Returns false when both streams have ended, or if time is
// up.
bool Process::read_some(Time end) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    std::array<pollfd, 2> streams{{{out_, POLLIN, 0}, {err_, POLLIN, 0}}};
    if (out_ < 0 && err_ < 0) return false;
    const int ready = ::poll(streams.data(), streams.size(), int(std::max<int64_t>(left.count(), 0)));
    if (ready == 0) return false;
    const auto read_stream = [](int& fd, std::string& text) {
        std::array<char, 4096> buffer;
        const ssize_t count = ::read(fd, buffer.data(), buffer.size());
        if (count > 0) {
            text.append(buffer.data(), size_t(count));
        } else if (count == 0 || errno != EINTR) {  // A terminal ends with EIO.
            ::close(fd);
            fd = -1;
        }
    };
    if (streams[0].revents != 0) read_stream(out_, result_.out);
    if (streams[1].revents != 0) read_stream(err_, result_.err);
    return true;
}

bool Process::wait_for_err(const std::string& text, int times) {
    const Time end = std::chrono::steady_clock::now() + PATIENCE;
    size_t seen = 0;
    while (times > 0) {
        const size_t found = result_.err.find(text, seen);
        if (found != std::string::npos) {
            seen = found + text.size();
            --times;
        } else if (!read_some(end)) {
            return false;
        }
    }
    return true;
}

void Process::send(int signal) const {
    ::kill(pid_, signal);
}

bool Process::has_ended() const {
    siginfo_t info{};
    return pid_ > 0 && ::waitid(P_PID, id_t(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == pid_;
}

// /proc gives the signals as a mask in hexadecimal digits, with the first signal in its lowest bit.
bool Process::catches(int signal) const {
    std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
    const std::string key = "SigCgt:";
    for (std::string line; std::getline(status, line);) {
        if (line.rfind(key, 0) == 0)
            return (std::stoull(line.substr(key.size()), nullptr, 16) >> (signal - 1) & 1u) != 0;
    }
    return false;
}

void Process::block_err() const {
    const std::string path = "/proc/" + std::to_string(pid_) + "/fd/2";
    const int err = ::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    if (err < 0) throw std::runtime_error("cannot open " + path);
    const std::array<char, 4096> blanks{};
    // Byte by byte at the end, since the last page takes what is shorter than a page.
    for (const size_t size : {blanks.size(), size_t{1}}) {
        while (::write(err, blanks.data(), size) > 0) {
        }
    }
    ::close(err);
}

bool Process::waits_for_reader() const {
    std::ifstream file("/proc/" + std::to_string(pid_) + "/wchan");
    std::string function;  // The kernel's function in which the main thread sleeps.
    return std::getline(file, function) && function.find("pipe_write") != std::string::npos;
}

void Process::close_err() {
    ::close(err_);
    err_ = -1;
}

ProcessResult Process::finish() {
    const Time end = std::chrono::steady_clock::now() + PATIENCE;
    while (read_some(end)) {
    }
    if (out_ >= 0 || err_ >= 0) ::kill(pid_, SIGKILL);  // It hangs.
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    if (WIFEXITED(status)) result_.exit_code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) result_.signal = WTERMSIG(status);
    return result_;
}

ProcessResult run_process(const std::vector<std::string>& arguments, const ProcessOptions& options) {
    return Process(arguments, options).finish();
}

}  // namespace candela
