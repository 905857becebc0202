// Lights, and the powers by which they are chosen.
#pragma once

#include <vector>

#include "shared/light.h"

namespace candela {

struct PoweredLights {
    std::vector<LightRecord> records;  // Their pmf is not set: it depends on all lights.
    std::vector<double> powers;        // The power of each over pi, by its luminance [W]; above 0.
};

}  // namespace candela
