// Renderer::coverage(): from the words of the kernel of first hits to the shapes that pixels show.
#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

#include "render/renderer.h"

namespace candela {
namespace {

// Pixels of a submission: at 64 rays each, far below a watchdog's limit.
constexpr uint32_t RUN_PIXELS = 1u << 15;

// Finds the shape of a word. Rays side by side mostly hit the same one, so the last answer is kept.
class ShapeOfWord {
  public:
    explicit ShapeOfWord(const GpuScene& scene) : shapes_(scene.shape_ids) {
        for (const InstancePlace& place : scene.instances)
            instances_.emplace(place.node, place.shape);
    }

    uint32_t operator()(uint32_t word) {
        if (word == 0) return Coverage::NO_SHAPE;
        if (word != last_word_) {
            last_word_ = word;
            last_ = (word & FIRST_HIT_INSTANCE) != 0 ? instances_.at(word & ~FIRST_HIT_INSTANCE)
                                                     : shape_of_id(word - 1);
        }
        return last_;
    }

  private:
    uint32_t shape_of_id(uint32_t id) {
        if (id >= begin_ && id < end_) return found_;
        const auto after = std::ranges::upper_bound(shapes_, id, {}, &ShapeIds::first);
        assert(after != shapes_.begin());
        const ShapeIds& shape = *(after - 1);
        begin_ = shape.first;
        end_ = after == shapes_.end() ? UINT32_MAX : after->first;
        return found_ = shape.shape;
    }

    std::span<const ShapeIds> shapes_;
    std::unordered_map<uint32_t, uint32_t> instances_;  // Shapes, by node.
    uint32_t last_word_ = 0, last_ = Coverage::NO_SHAPE;
    uint32_t begin_ = 0, end_ = 0, found_ = 0;  // The ids of the shape that was found last.
};

}  // namespace

Coverage Renderer::coverage(const GpuScene& scene) {
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

    Coverage coverage;
    ShapeOfWord shape_of(scene);
    std::array<uint32_t, FIRST_HITS> of_pixel;
    for (uint32_t first = 0; first < pixels; first += at_once) {
        const PixelRun run{first, settings_.crop.width()};
        const uint32_t count = std::min(at_once, pixels - first);
        commands_.dispatch(kernel, std::as_bytes(std::span(&run, 1)), {count, 1, 1});
        commands_.submit_and_wait();
        for (uint32_t i = 0; i < count; ++i) {
            std::memcpy(of_pixel.data(), words.mapped() + i * sizeof of_pixel, sizeof of_pixel);
            std::ranges::transform(of_pixel, of_pixel.begin(), std::ref(shape_of));
            coverage.add(of_pixel);
        }
    }
    return coverage;
}

}  // namespace candela
