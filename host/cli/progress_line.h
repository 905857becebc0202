// Where progress is printed, and how often: a live line on a terminal, plain lines at intervals elsewhere, or
// lines of JSON for programs; all on stderr.
#pragma once

#include <chrono>
#include <string>

#include "cli/message_options.h"

namespace candela {

class ProgressLine {
  public:
    // The clock starts here, with a fraction `done` of the work already complete.
    ProgressLine(ProgressStyle style, double done);
    // Clears the live line, if there is one.
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    // Whether it is time to print, with a fraction `done` of the work complete, in [0, 1].
    bool is_due(double done) const;
    bool is_json() const { return output_ == Output::json; }
    bool is_live() const { return output_ == Output::live; }
    // Prints the text, which replaces the live line.
    void print(const std::string& text, double done);
    // Clears the live line, so that others can print.
    void clear();
    // Wall time since the start [s].
    double seconds() const;

  private:
    enum class Output { none, plain, live, json };
    static Output choose(ProgressStyle style);

    Output output_;
    std::chrono::steady_clock::time_point start_;
    double printed_done_;  // At the last line printed.
    double printed_seconds_ = 0.0;
};

}  // namespace candela
