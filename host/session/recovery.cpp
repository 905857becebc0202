// See recovery.h.
#include "session/recovery.h"

#include <chrono>
#include <thread>

namespace candela {

static constexpr std::chrono::duration<double> FIRST_PAUSE{0.1};

bool Recovery::survives(const Error& error, bool open, uint64_t samples) {
    if (open && error.kind() != ErrorKind::device_lost && error.kind() != ErrorKind::out_of_memory)
        throw Error(error);
    if (open || !cause_) cause_ = error;
    if (samples > samples_) in_a_row_ = 0;
    samples_ = samples;
    ++failures_;
    return ++in_a_row_ < MAX_FAILURES;
}

void Recovery::pause() const {
    std::this_thread::sleep_for(FIRST_PAUSE * (1u << (in_a_row_ - 1)));
}

}  // namespace candela
