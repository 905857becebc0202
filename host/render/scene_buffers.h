// A scene's records on a device, for kernels that include scene/scene_data.glsl.
#pragma once

#include <cstdint>
#include <vector>

#include "render/gpu_scene.h"
#include "shared/constants.h"
#include "shared/parameters.h"
#include "vk/buffer.h"
#include "vk/device.h"
#include "vk/kernel.h"

namespace candela {

// How kernels read the arrays of a scene. Every way gives the same bits.
enum class SceneAccess { automatic, texel_buffers, storage_buffers };

// All bits of the constant STORAGE_ARRAYS.
inline constexpr uint32_t ALL_STORAGE_ARRAYS = (1u << SCENE_ARRAYS) - 1;

// The value of the constant STORAGE_ARRAYS: all arrays as wanted, or, for `automatic`, each as suits the device
// and holds it. Throws Error (out_of_memory) that names the array and the device's limits if nothing does.
uint32_t choose_storage_arrays(const vk::Device& device, const GpuScene& scene, SceneAccess wanted);

class SceneBuffers {
  public:
    // Uploads the scene; `storage_arrays` is what STORAGE_ARRAYS of the kernels will be.
    SceneBuffers(const vk::Device& device, const GpuScene& scene, const Parameters& parameters,
                 uint32_t storage_arrays);

    void set(const Parameters& parameters);

    uint32_t storage_arrays() const { return storage_arrays_; }
    // What a kernel declares, however it reads the arrays.
    static std::vector<vk::Binding> bindings();
    void bind_to(vk::Kernel& kernel) const;

  private:
    uint32_t storage_arrays_;
    std::vector<vk::Buffer> arrays_;  // By BINDING_*.
    // A kernel's bindings must all be bound, those that it does not read as well.
    vk::Buffer unread_texels_, unread_storage_;
    vk::Buffer parameters_;
};

}  // namespace candela
