// libFuzzer's entry to the target TARGET.
#include <cstddef>
#include <cstdint>

#include "base/error.h"
#include "fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    try {
        candela::fuzz::TARGET({reinterpret_cast<const char*>(data), size});
    } catch (const candela::Error&) {  // What bad input should cause.
    }
    return 0;
}
