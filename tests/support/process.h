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
};

struct ProcessResult {
    int exit_code = -1;  // -1 if a signal ended the program.
    int signal = 0;      // The signal, or 0.
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

    // Waits until stderr contains `text` that many times. Returns false if the program ended or hung (see
    // PATIENCE) before.
    bool wait_for_err(const std::string& text, int times = 1);
    // What it has written to stderr, as far as that has been read.
    const std::string& err() const { return result_.err; }
    void send(int signal) const;
    // Whether it has ended, though finish() has not been called.
    bool has_ended() const;
    // Whether the program handles this signal itself.
    bool catches(int signal) const;
    // Fills its stderr, a pipe: from now on the program waits for ever when it writes there.
    void block_err() const;
    // Whether it does so at this moment.
    bool waits_for_reader() const;
    // Closes our end of its stderr, as a reader does who has seen enough.
    void close_err();
    // Waits for the end; kills the program if it hangs.
    ProcessResult finish();

  private:
    using Time = std::chrono::steady_clock::time_point;
    bool read_some(Time end);

    pid_t pid_ = -1;
    int out_ = -1;
    int err_ = -1;
    ProcessResult result_;
};

// Runs a program to its end.
ProcessResult run_process(const std::vector<std::string>& arguments, const ProcessOptions& options = {});

}  // namespace candela
