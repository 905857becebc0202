// The progress of a rendering on stderr.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "cli/progress_line.h"

namespace candela {

class Progress {
  public:
    // Each of `pixels` gets `spp` samples, a fraction `done` of which already exists. A `time_limit` [s] may
    // end rendering earlier. JSON names the `picture`, if that is one among several. The clock starts here.
    Progress(uint64_t pixels, uint32_t spp, double done, std::optional<double> time_limit,
             ProgressStyle style, std::string picture = "");
    // Reports the fraction `done`, in [0, 1], of all samples and the estimated error of the image; prints
    // only as often as suits the output.
    void update(double done, std::optional<double> error);
    // Clears the live line, so that others can print.
    void clear() { line_.clear(); }
    // Prints the last line of JSON, whose "state" says how the rendering ended. Call it when all files are
    // written.
    void end(const std::string& state) const;
    // Wall time since the start [s].
    double seconds() const { return line_.seconds(); }

  private:
    // The progress at an update.
    struct Status {
        double done;
        double seconds = 0.0;
        std::optional<double> error = std::nullopt;
    };
    uint32_t spp_done() const;
    double rate() const;
    double seconds_left() const;
    std::string text() const;
    std::string json_text(const std::string& state) const;

    uint64_t pixels_;
    uint32_t spp_;
    double done_before_;
    std::optional<double> time_limit_;
    std::string picture_;
    ProgressLine line_;
    Status now_;  // At the last update.
};

}  // namespace candela
