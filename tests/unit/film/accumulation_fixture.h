// What the tests of accumulation states share: a state whose samples are known.
#pragma once

#include <vector>

#include "film/accumulation.h"
#include "probe/random.h"

namespace candela {

// A state of 3 x 2 pixels of a crop, pixel i with i samples, each with a random L, and the samples
// themselves.
struct Sampled {
    Accumulation state;
    std::vector<std::vector<vec3>> samples;
};

// Fills the layers as the device does, but in double precision: the sum as float, what is missing as
// compensation.
inline void set_sum(Accumulation& state, uint32_t layer, size_t i, int component, double sum) {
    const size_t at = (layer * state.pixel_count() + i) * 4 + size_t(component);
    state.values[at] = float(sum);
    state.values[at + state.pixel_count() * 4] = float(double(float(sum)) - sum);
}

inline Sampled sampled(uint32_t layer_count) {
    Sampled s;
    s.state = {.full = uvec2(40, 30),
               .rect = {10, 20, 13, 22},
               .seed = 0xFFFFFFFEu,
               .first_sample = 64,
               .layer_count = layer_count,
               .values = {},
               .counters = {.rays = 123456789012, .nonfinite_samples = 3, .depth_limit_hits = 4}};
    s.state.values.resize(layer_count * s.state.pixel_count() * 4);
    s.samples.resize(s.state.pixel_count());
    Random random(70);
    for (size_t i = 0; i < s.state.pixel_count(); ++i) {
        for (size_t n = 0; n < i; ++n)
            s.samples[i].push_back(10.0f + random.cube());
        for (int c = 0; c < 3; ++c) {
            double sum = 0.0, squares = 0.0;
            for (const vec3 L : s.samples[i]) {
                sum += L[c];
                squares += double(L[c]) * L[c];
            }
            set_sum(s.state, LAYER_L, i, c, sum);
            set_sum(s.state, LAYER_SQUARE, i, c, squares);
            if (layer_count == LAYER_COUNT_AOVS) {
                set_sum(s.state, LAYER_ALBEDO, i, c, 0.25 * double(i));
                set_sum(s.state, LAYER_NORMAL, i, c, -0.5 * double(i));
            }
        }
        s.state.values[(LAYER_L * s.state.pixel_count() + i) * 4 + 3] = float(i / 2);
        s.state.values[(LAYER_L_COMPENSATION * s.state.pixel_count() + i) * 4 + 3] = float(i);
    }
    return s;
}

}  // namespace candela
