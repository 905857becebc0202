// Runs a program as a user would: arguments without a shell, an environment, and what comes back.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include <sys/types.h>

namespace candela {

struct ProcessOptions {
    std::map<std::string, std::string> environment;  // In addition to ours, or instead of it.
    bool terminal = false;                           // stderr is a terminal, not a pipe.
    double timeout = 120.0;                          // After that many seconds the program is killed.
};

struct ProcessResult {
    int exit_code = -1;  // -1 if a signal ended the program.
    int signal = 0;      // Which one, or 0.
    std::string out;
    std::string err;
};

class Process {
  public:
    // Starts `arguments`[0] with the rest as its arguments. Throws std::runtime_error if that fails.
    explicit Process(const std::vector<std::string>& arguments, const ProcessOptions& options = {});
    // Kills the program if it still runs.
    ~Process();
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    // Waits until stderr contains `text` so many times. Returns false if the program ended or ran out of time
    // before.
    bool wait_for_err(const std::string& text, int times = 1);
    // What it has written to stderr as far as that was waited for.
    const std::string& err() const { return result_.err; }
    void send(int signal) const;
    // Waits for the end.
    ProcessResult finish();

  private:
    bool read_some();

    pid_t pid_ = -1;
    int out_ = -1;
    int err_ = -1;
    std::chrono::steady_clock::time_point deadline_;
    ProcessResult result_;
};

// Runs a program to its end.
ProcessResult run_process(const std::vector<std::string>& arguments, const ProcessOptions& options = {});

}  // namespace candela
