// candela's side of the benchmark of rays; see tracer.h.
#include <algorithm>
#include <array>

#include "bench/tracer.h"
#include "probe/probe.h"
#include "probe/probes.h"
#include "shared/constants.h"
#include "vk/commands.h"
#include "vk/transfer.h"

namespace candela {
namespace {

constexpr uint32_t WORDS_PER_RAY = sizeof(BenchRay) / sizeof(uvec4);

// The most rays that a texel buffer and one dimension of a dispatch may have on the device.
size_t largest_batch(const vk::DeviceLimits& limits) {
    return std::min<uint64_t>(limits.max_texel_buffer_elements / WORDS_PER_RAY,
                              uint64_t{limits.max_compute_work_group_count[0]} * PROBE_GROUP);
}

class DeviceTracer : public RayTracer {
  public:
    DeviceTracer(const vk::Device& device, const GpuScene& scene, SceneAccess access, size_t batch)
        : device_(&device),
          batch_(std::min(batch, largest_batch(device.limits()))),
          scene_(device, scene, access),
          closest_(make_probe(device, kernels::closest_hit, traversal_constants(scene), &scene_, "bench")),
          any_(make_probe(device, kernels::any_hit, traversal_constants(scene), &scene_, "bench")),
          commands_(device) {}

    void prepare(const RaySet& set) override {
        set_ = &set;
        batches_.clear();
        for (size_t first = 0; first < set.rays.size(); first += batch_) {
            const auto some = std::span(set.rays).subspan(first, std::min(batch_, set.rays.size() - first));
            batches_.push_back(
                {uint32_t(some.size()),
                 {*device_, some.size_bytes(), vk::BufferUsage::texel, "rays"},
                 {*device_, some.size() * sizeof(uint32_t), vk::BufferUsage::storage, "hits"}});
            vk::upload(batches_.back().rays, std::as_bytes(some));
        }
    }

    Clocks trace(uint32_t repeats) override {
        vk::Kernel& kernel = set_->any_hit ? any_ : closest_;
        const Stopwatch watch;
        double device_seconds = 0.0;
        for (const Batch& batch : batches_) {
            kernel.bind(BINDING_ITEMS, batch.rays);
            kernel.bind(BINDING_RESULTS, batch.hits);
            const ProbeCounts counts{batch.count, scene_.primitive_count()};
            for (uint32_t i = 0; i < repeats; ++i) {
                commands_.dispatch(kernel, std::as_bytes(std::span(&counts, 1)),
                                   {(batch.count + PROBE_GROUP - 1) / PROBE_GROUP, 1, 1});
            }
            device_seconds += commands_.submit_and_wait();
        }
        return {watch.elapsed().cpu, device_seconds};
    }

    std::vector<uint32_t> results() const override {
        std::vector<uint32_t> ids(set_->rays.size());
        auto rest = std::span(ids);
        for (const Batch& batch : batches_) {
            vk::download(batch.hits, std::as_writable_bytes(rest.first(batch.count)));
            rest = rest.subspan(batch.count);
        }
        return ids;
    }

  private:
    struct Batch {
        uint32_t count;  // Rays.
        vk::Buffer rays;
        vk::Buffer hits;
    };

    const vk::Device* device_;
    size_t batch_;  // The most rays of a dispatch.
    DeviceScene scene_;
    vk::Kernel closest_, any_;
    vk::Commands commands_;
    const RaySet* set_ = nullptr;
    std::vector<Batch> batches_;
};

}  // namespace

std::unique_ptr<RayTracer> make_device_tracer(const vk::Device& device, const GpuScene& scene,
                                              SceneAccess access, size_t batch) {
    return std::make_unique<DeviceTracer>(device, scene, access, batch);
}

}  // namespace candela
