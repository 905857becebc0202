// Prints the progress line.
#include "cli/progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cli/console.h"

namespace candela {

// A live line is renewed ten times a second; a plain one comes after both a tenth of the work and ten
// seconds.
static constexpr double LIVE_SECONDS = 0.1;
static constexpr double PLAIN_SECONDS = 10.0;
static constexpr double PLAIN_SHARE = 0.1;

Progress::Progress(uint64_t pixels, uint32_t spp, double done, std::optional<double> time_limit, bool quiet)
    : pixels_(pixels),
      spp_(spp),
      done_before_(done),
      time_limit_(time_limit),
      output_(quiet ? Output::none : (stderr_is_terminal() ? Output::live : Output::plain)),
      start_(std::chrono::steady_clock::now()),
      printed_done_(done) {}

Progress::~Progress() {
    if (output_ == Output::live && printed_seconds_ > 0.0) std::fputs("\r\x1b[K", stderr);
}

double Progress::seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

// `12 %, 31 of 256 spp, 1.52 Msamples/s, 38.2 s left`
std::string Progress::line(double done, double now) const {
    const double newly = std::max(0.0, done - done_before_);
    const double samples = newly * double(spp_) * double(pixels_);
    double left = newly > 0.0 ? now * (1.0 - done) / newly : 0.0;
    if (time_limit_) left = std::min(left, std::max(0.0, *time_limit_ - now));
    return fixed(std::floor(100.0 * done), 0) + " %, " + fixed(std::floor(done * spp_), 0) + " of " +
           std::to_string(spp_) + " spp, " + fixed(samples / std::max(now, 1e-9) / 1e6, 2) + " Msamples/s, " +
           duration_text(left) + " left";
}

void Progress::update(double done) {
    const double now = seconds();
    const double since = now - printed_seconds_;
    const bool due = output_ == Output::live ? since >= LIVE_SECONDS
                                             : since >= PLAIN_SECONDS && done - printed_done_ >= PLAIN_SHARE;
    if (output_ == Output::none || !due) return;
    printed_done_ = done;
    printed_seconds_ = now;
    if (output_ == Output::live) {
        // \r goes back to the start of the line, \x1b[K clears it.
        std::fprintf(stderr, "\r\x1b[K%s", line(done, now).c_str());
    } else {
        std::fprintf(stderr, "%s\n", line(done, now).c_str());
    }
}

}  // namespace candela
