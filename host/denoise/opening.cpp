// See opening.h.
#include "denoise/opening.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace candela {
namespace {

// For each pixel, `choose` of all values that are up to `radius` pixels from it in the direction.
template <class Choose>
std::vector<float> along(const std::vector<float>& plane, uvec2 size, glm::ivec2 direction, uint32_t radius,
                         const Choose& choose) {
    std::vector<float> result = plane;
    for (int i = -int(radius); i <= int(radius); ++i) {
        const glm::ivec2 step = i * direction;
        const glm::ivec2 first = max(-step, 0), last = glm::ivec2(size) - max(step, 0);
        for (int y = first.y; y < last.y; ++y) {
            float* const to = &result[size_t(y) * size.x];
            const float* const from = &plane[size_t(y + step.y) * size.x];
            for (int x = first.x; x < last.x; ++x)
                to[x] = choose(to[x], from[x + step.x]);
        }
    }
    return result;
}

}  // namespace

std::vector<float> opened_by_lines(const std::vector<float>& plane, uvec2 size, uint32_t radius) {
    assert(plane.size() == size_t(size.x) * size.y);
    const auto lower = [](float a, float b) { return std::min(a, b); };
    const auto higher = [](float a, float b) { return std::max(a, b); };
    std::vector<float> result;
    for (const glm::ivec2 direction :
         std::array{glm::ivec2(1, 0), glm::ivec2(0, 1), glm::ivec2(1, 1), glm::ivec2(1, -1)}) {
        const std::vector<float> line =
            along(along(plane, size, direction, radius, lower), size, direction, radius, higher);
        if (result.empty()) {
            result = line;
        } else {
            std::ranges::transform(result, line, result.begin(), higher);
        }
    }
    return result;
}

}  // namespace candela
