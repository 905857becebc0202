// Renderer::coverage(): from the words of the kernel of first hits to what pixels show.
#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <span>

#include "render/part_of_word.h"
#include "render/renderer.h"

namespace candela {
namespace {

// Pixels of a submission: at 64 rays each, far below a watchdog's limit, and a fraction of a second on a CPU.
constexpr uint32_t RUN_PIXELS = 1u << 13;

}  // namespace

Coverage Renderer::coverage(const GpuScene& scene, const std::function<bool()>& keep_going) {
    // Only this sampler has one of the first 64 samples in each cell of an 8 x 8 grid, and their lens points
    // as even.
    KernelConstants constants = constants_;
    constants[CONSTANT_SAMPLER] = SAMPLER_SOBOL;
    vk::Kernel kernel = make_kernel(*device_, RenderKernel::first_hits, constants);
    scene_.bind_to(kernel);
    const uint32_t pixels = settings_.crop.width() * settings_.crop.height();
    const uint32_t at_once = std::min(pixels, RUN_PIXELS);
    const vk::Buffer words(*device_, uint64_t{at_once} * FIRST_HITS * sizeof(uint32_t),
                           vk::BufferUsage::readback, "first hits");
    kernel.bind(BINDING_FIRST_HITS, words);

    Coverage coverage(pixels);
    PartOfWord part_of(scene);
    std::array<uint32_t, FIRST_HITS> of_pixel;
    std::array<ShapePart, FIRST_HITS> shown;
    for (uint32_t first = 0; first < pixels && keep_going(); first += at_once) {
        const PixelRun run{first, settings_.crop.width()};
        const uint32_t count = std::min(at_once, pixels - first);
        commands_.dispatch(kernel, std::as_bytes(std::span(&run, 1)), {count, 1, 1});
        commands_.submit_and_wait();
        for (uint32_t i = 0; i < count; ++i) {
            std::memcpy(of_pixel.data(), words.mapped() + i * sizeof of_pixel, sizeof of_pixel);
            std::ranges::transform(of_pixel, shown.begin(), std::ref(part_of));
            coverage.add(shown);
        }
    }
    shown.fill(NO_PART);
    while (coverage.pixel_count() < pixels)
        coverage.add(shown);
    return coverage;
}

}  // namespace candela
