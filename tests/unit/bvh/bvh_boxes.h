// Boxes that the tests of the BVH are built over.
#pragma once

#include <random>
#include <vector>

#include "base/math.h"

namespace candela {

// `count` boxes with centres in the unit cube around 0 and edges up to `size`.
inline std::vector<Box> random_boxes(size_t count, float size, uint32_t seed = 1) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(-0.5f, 0.5f);
    const auto vector = [&] {
        const float x = uniform(generator), y = uniform(generator), z = uniform(generator);
        return vec3(x, y, z);
    };
    std::vector<Box> boxes(count);
    for (Box& box : boxes) {
        const vec3 centre = vector();
        box.extend(centre + size * vector());
        box.extend(centre + size * vector());
    }
    return boxes;
}

}  // namespace candela
