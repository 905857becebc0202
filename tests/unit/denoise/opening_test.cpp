// Openings by lines, against their definition.
#include "denoise/opening.h"

#include <algorithm>
#include <utility>

#include <gtest/gtest.h>

#include "probe/random.h"

namespace candela {
namespace {

// Of each pixel, the greatest value that all pixels of a line through it reach, whose part beyond the plane
// is as high as any.
std::vector<float> opened_by_definition(const std::vector<float>& plane, uvec2 size, int radius) {
    const auto value = [&](int x, int y) {
        const bool inside = x >= 0 && y >= 0 && x < int(size.x) && y < int(size.y);
        return inside ? plane[size_t(y) * size.x + size_t(x)] : INFINITE;
    };
    std::vector<float> result;
    for (int y = 0; y < int(size.y); ++y) {
        for (int x = 0; x < int(size.x); ++x) {
            float greatest = 0.0f;
            for (const auto& [dx, dy] :
                 {std::pair(1, 0), std::pair(0, 1), std::pair(1, 1), std::pair(1, -1)}) {
                for (int middle = -radius; middle <= radius; ++middle) {
                    if (value(x + middle * dx, y + middle * dy) == INFINITE) continue;
                    float least = INFINITE;
                    for (int i = middle - radius; i <= middle + radius; ++i)
                        least = std::min(least, value(x + i * dx, y + i * dy));
                    greatest = std::max(greatest, least);
                }
            }
            result.push_back(greatest);
        }
    }
    return result;
}

TEST(Opening, IsWhatItsDefinitionSays) {
    Random random(3);
    for (const uvec2 size : {uvec2(1, 1), uvec2(2, 5), uvec2(31, 1), uvec2(40, 23)}) {
        std::vector<float> plane(size_t{size.x} * size.y);
        for (float& value : plane)
            value = random.unit();
        for (const uint32_t radius : {0u, 1u, 3u})
            EXPECT_EQ(opened_by_lines(plane, size, radius), opened_by_definition(plane, size, int(radius)));
    }
}

}  // namespace
}  // namespace candela
