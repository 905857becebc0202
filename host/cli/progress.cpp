// Prints the progress line.
#include "cli/progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "cli/console.h"

namespace candela {

// A live line is renewed ten times per second, JSON is printed twice per second, and a plain line after both
// a tenth of the work and ten seconds.
static constexpr double LIVE_SECONDS = 0.1;
static constexpr double JSON_SECONDS = 0.5;
static constexpr double PLAIN_SECONDS = 10.0;
static constexpr double PLAIN_SHARE = 0.1;

Progress::Output Progress::choose(ProgressStyle style) {
    switch (style) {
        case ProgressStyle::json:
            return Output::json;
        case ProgressStyle::none:
            return Output::none;
        default:
            return stderr_is_terminal() ? Output::live : Output::plain;
    }
}

Progress::Progress(uint64_t pixels, uint32_t spp, double done, std::optional<double> time_limit,
                   ProgressStyle style)
    : pixels_(pixels),
      spp_(spp),
      done_before_(done),
      time_limit_(time_limit),
      output_(choose(style)),
      start_(std::chrono::steady_clock::now()),
      now_{.done = done},
      printed_{.done = done} {}

Progress::~Progress() {
    clear();
}

void Progress::clear() {
    if (output_ == Output::live && printed_.seconds > 0.0) std::fputs("\r\x1b[K", stderr);
    printed_.seconds = 0.0;
}

double Progress::seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

// Whole samples per pixel; the share may fall short of one by rounding.
uint32_t Progress::spp_done() const {
    return uint32_t(now_.done * spp_ + 1e-3);
}

// Samples per second.
double Progress::rate() const {
    const double samples = std::max(0.0, now_.done - done_before_) * double(spp_) * double(pixels_);
    return samples / std::max(now_.seconds, 1e-9);
}

double Progress::seconds_left() const {
    const double newly = now_.done - done_before_;
    const double left = newly > 0.0 ? now_.seconds * (1.0 - now_.done) / newly : 0.0;
    return time_limit_ ? std::min(left, std::max(0.0, *time_limit_ - now_.seconds)) : left;
}

// `12 %, 31 of 256 spp, 1.52 Msamples/s, 38.2 s left, error 0.031`
std::string Progress::line() const {
    return fixed(std::floor(100.0 * now_.done), 0) + " %, " + std::to_string(spp_done()) + " of " +
           std::to_string(spp_) + " spp, " + fixed(rate() / 1e6, 2) + " Msamples/s, " +
           duration_text(seconds_left()) + " left" +
           (now_.error ? ", error " + fixed(*now_.error, 4) : std::string());
}

std::string Progress::json_line(const std::string& state) const {
    using Json = nlohmann::ordered_json;
    return Json{{"state", state},
                {"spp", spp_done()},
                {"target_spp", spp_},
                {"seconds", now_.seconds},
                {"samples_per_second", rate()},
                {"seconds_left", seconds_left()},
                {"estimated_error", now_.error ? Json(*now_.error) : Json()}}
        .dump();
}

void Progress::update(double done, std::optional<double> error) {
    now_ = {.done = done, .seconds = seconds(), .error = error};
    const double since = now_.seconds - printed_.seconds;
    switch (output_) {
        case Output::live:
            if (since < LIVE_SECONDS) return;
            // \r goes back to the start of the line, \x1b[K clears it.
            std::fprintf(stderr, "\r\x1b[K%s", line().c_str());
            break;
        case Output::plain:
            if (since < PLAIN_SECONDS || done - printed_.done < PLAIN_SHARE) return;
            std::fprintf(stderr, "%s\n", line().c_str());
            break;
        case Output::json:
            if (since < JSON_SECONDS) return;
            std::fprintf(stderr, "%s\n", json_line("rendering").c_str());
            break;
        case Output::none:
            return;
    }
    printed_ = now_;
}

void Progress::end(const std::string& state) const {
    if (output_ == Output::json) std::fprintf(stderr, "%s\n", json_line(state).c_str());
}

}  // namespace candela
