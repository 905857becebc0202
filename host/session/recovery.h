// Recovery: how often a failed device is reopened.
#pragma once

#include <cstdint>
#include <optional>

#include "base/error.h"

namespace candela {

// A device that is lost or out of memory is reopened, and rendering continues from the host's copy of the
// samples. Recovery gives up at the MAX_FAILURES-th failure in a row without progress of the copy.
class Recovery {
  public:
    static constexpr uint32_t MAX_FAILURES = 5;

    // Notes a failure of a device that was `open`, when the copy held `samples`. Throws the error if it is of
    // another kind; but while the device is being reopened, any error is a failure, since a driver that is
    // not ready may report anything. Returns whether to reopen the device.
    bool survives(const Error& error, bool open, uint64_t samples);
    // Waits before the device is reopened, since its driver needs a moment to reset it: twice as long each
    // time.
    void pause() const;
    // The copy begins again without samples.
    void forget_progress() { samples_ = 0; }

    // The last failure of an open device.
    const Error& cause() const { return *cause_; }
    // All failures so far.
    uint32_t failures() const { return failures_; }

  private:
    std::optional<Error> cause_;
    uint32_t failures_ = 0;
    uint32_t in_a_row_ = 0;  // Failures without progress.
    uint64_t samples_ = 0;   // Those in the copy at the last failure.
};

}  // namespace candela
