// Work that recurs during a rendering.
#pragma once

#include <chrono>

namespace candela {

class Interval {
  public:
    // `seconds`: from the end of a piece of work to the next. The first interval begins here.
    explicit Interval(double seconds) : seconds_(seconds) {}

    bool over() const { return std::chrono::steady_clock::now() - start_ >= seconds_; }
    // Begins the next interval.
    void restart() { start_ = std::chrono::steady_clock::now(); }

  private:
    std::chrono::duration<double> seconds_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace candela
