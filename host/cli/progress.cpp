// Prints the progress line.
#include "cli/progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <nlohmann/json.hpp>

#include "cli/console.h"
#include "cli/json_text.h"

namespace candela {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

Progress::Progress(uint64_t pixels, uint32_t spp, double done, std::optional<double> time_limit,
                   ProgressStyle style, std::string picture)
    : pixels_(pixels),
      spp_(spp),
      done_before_(done),
      time_limit_(time_limit),
      picture_(std::move(picture)),
      line_(style, done),
      now_{.done = done} {}

// Whole samples per pixel; rounding may leave the fraction slightly below 1.
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
std::string Progress::text() const {
    return fixed(std::floor(100.0 * now_.done), 0) + " %, " + std::to_string(spp_done()) + " of " +
           std::to_string(spp_) + " spp, " + fixed(rate() / 1e6, 2) + " Msamples/s, " +
           duration_text(seconds_left()) + " left" +
           (now_.error ? ", error " + fixed(*now_.error, 4) : std::string());
}

std::string Progress::json_text(const std::string& state) const {
    Json json{{"state", state},
              {"spp", spp_done()},
              {"target_spp", spp_},
              {"seconds", now_.seconds},
              {"samples_per_second", rate()},
              {"seconds_left", seconds_left()},
              {"estimated_error", now_.error ? Json(*now_.error) : Json()}};
    if (!picture_.empty()) json["picture"] = picture_;
    return json_line(json);
}

void Progress::update(double done, std::optional<double> error) {
    const bool is_due = line_.is_due(done);  // Asked first: what is printed is then no earlier.
    now_ = {.done = done, .seconds = seconds(), .error = error};
    if (is_due) line_.print(line_.is_json() ? json_text("rendering") : text(), done);
}

void Progress::end(const std::string& state) const {
    if (line_.is_json()) std::fprintf(stderr, "%s\n", json_text(state).c_str());
}

}  // namespace candela
