// Renderer::positions() and distances(): where the rays through the middles of pixels hit.
#include <algorithm>
#include <vector>

#include "render/kernels.h"
#include "render/renderer.h"
#include "vk/transfer.h"

namespace candela {

// Pixels per submission of the position kernel: at one ray each, far below a watchdog's limit.
static constexpr uint32_t POSITION_PIXELS = 1u << 20;

std::vector<float> Renderer::positions_in_frame() {
    const uvec2 size = image_size();
    const vk::StorageImage image = vk::make_storage_image(*device_, size.x, size.y, 1, "position");
    vk::Kernel kernel = scene_kernel(RenderKernel::position);
    kernel.bind(BINDING_IMAGE, image);
    const uint32_t rows = std::max(1u, POSITION_PIXELS / size.x);
    for (uint32_t y = 0; y < size.y; y += rows) {
        const uvec2 tile(size.x, std::min(rows, size.y - y));
        record(kernel,
               {.origin = {0, y}, .size = tile, .stride = {1, 1}, .target_samples = 0, .lane = LANES});
        commands_.submit_and_wait();
    }
    return vk::download(image, 0, 1);
}

std::vector<float> Renderer::positions() {
    std::vector<float> values = positions_in_frame();
    for (size_t i = 0; i < values.size(); i += 4) {
        if (values[i + 3] == INFINITE) continue;  // No hit.
        const dvec3 p = frame_.world(vec3(values[i], values[i + 1], values[i + 2]));
        for (glm::length_t c = 0; c < 3; ++c)
            values[i + size_t(c)] = float(p[c]);
        values[i + 3] *= float(frame_.unit);
    }
    return values;
}

std::vector<float> Renderer::distances() {
    const std::vector<float> values = positions_in_frame();
    const bool parallel = constants_[CONSTANT_CAMERA] == CAMERA_ORTHOGRAPHIC;
    std::vector<float> distances(values.size() / 4, INFINITE);
    for (size_t i = 0; i < distances.size(); ++i) {
        const float* const at = &values[4 * i];
        if (at[3] == INFINITE) continue;  // No hit.
        const double distance = parallel ? double(at[3]) : length(dvec3(at[0], at[1], at[2]) - dvec3(eye_));
        distances[i] = float(distance * frame_.unit);
    }
    return distances;
}

}  // namespace candela
