// The progress of a rendering on stderr: a live line on a terminal, now and then a plain line elsewhere.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace candela {

class Progress {
  public:
    // `pixels` get `spp` samples each, of which the share `done` is there already, unless `time_limit` [s],
    // if given, is over before. The clock starts here.
    Progress(uint64_t pixels, uint32_t spp, double done, std::optional<double> time_limit, bool quiet);
    // Clears the live line, if there is one.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // Says that the share `done`, in [0, 1], of all samples is there; prints at most as often as fits the
    // output.
    void update(double done);
    // Wall time since the start [s].
    double seconds() const;

  private:
    std::string line(double done, double now) const;

    enum class Output { none, plain, live };

    uint64_t pixels_;
    uint32_t spp_;
    double done_before_;
    std::optional<double> time_limit_;
    Output output_;
    std::chrono::steady_clock::time_point start_;
    double printed_done_;           // When something was printed last: the share done ...
    double printed_seconds_ = 0.0;  // ... and the time.
};

}  // namespace candela
