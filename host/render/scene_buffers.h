// A scene's records on a device, for kernels that include scene/scene_data.glsl.
#pragma once

#include <cstdint>
#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "render/array_map.h"
#include "shared/parameters.h"
#include "vk/buffer.h"
#include "vk/device.h"
#include "vk/kernel.h"

namespace candela {

class SceneBuffers {
  public:
    // Uploads the scene. The kernels' constants must agree with `map`.
    SceneBuffers(const vk::Device& device, const GpuScene& scene, const Parameters& parameters,
                 const ArrayMap& map);

    void set(const Parameters& parameters);

    // Copies the arrays of `scene` again that lie in a buffer of `changed`, or elsewhere than before because
    // `map` is another one. Returns how many these are. Kernels must be bound again, and their constants must
    // agree with the new map.
    uint32_t update(const GpuScene& scene, const ArrayMap& map, const BufferSet& changed);

    const ArrayMap& map() const { return map_; }
    // The bindings that a kernel with these constants declares.
    static std::vector<vk::Binding> bindings(const KernelConstants& constants);
    void bind_to(vk::Kernel& kernel) const;

  private:
    ArrayMap map_{};
    std::vector<vk::Buffer> texels_;   // By BUFFER_*.
    std::vector<vk::Buffer> storage_;  // By slot.
    vk::Buffer parameters_;
};

}  // namespace candela
