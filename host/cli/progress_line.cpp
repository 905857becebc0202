// See progress_line.h.
#include "cli/progress_line.h"

#include <cstdio>

#include "cli/console.h"
#include "os/program.h"

namespace candela {

// A live line is renewed ten times per second, JSON is printed twice per second, and a plain line after both
// a tenth of the work and ten seconds.
static constexpr double LIVE_SECONDS = 0.1;
static constexpr double JSON_SECONDS = 0.5;
static constexpr double PLAIN_SECONDS = 10.0;
static constexpr double PLAIN_FRACTION = 0.1;

ProgressLine::Output ProgressLine::choose(ProgressStyle style) {
    switch (style) {
        case ProgressStyle::json:
            return Output::json;
        case ProgressStyle::none:
            return Output::none;
        default:
            return os::stderr_is_terminal() ? Output::live : Output::plain;
    }
}

ProgressLine::ProgressLine(ProgressStyle style, double done)
    : output_(choose(style)), start_(std::chrono::steady_clock::now()), printed_done_(done) {}

ProgressLine::~ProgressLine() {
    clear();
}

double ProgressLine::seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

bool ProgressLine::is_due(double done) const {
    const double since = seconds() - printed_seconds_;
    switch (output_) {
        case Output::live:
            return since >= LIVE_SECONDS;
        case Output::plain:
            return since >= PLAIN_SECONDS && done - printed_done_ >= PLAIN_FRACTION;
        case Output::json:
            return since >= JSON_SECONDS;
        case Output::none:
            break;
    }
    return false;
}

void ProgressLine::print(const std::string& text, double done) {
    // \r goes back to the start of the line, \x1b[K clears it.
    std::fprintf(stderr, output_ == Output::live ? "\r\x1b[K%s" : "%s\n", text.c_str());
    printed_done_ = done;
    printed_seconds_ = seconds();
}

void ProgressLine::clear() {
    if (output_ == Output::live && printed_seconds_ > 0.0) std::fputs("\r\x1b[K", stderr);
    printed_seconds_ = 0.0;
}

}  // namespace candela
