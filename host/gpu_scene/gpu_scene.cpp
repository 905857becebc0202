// See gpu_scene.h.
#include "gpu_scene/gpu_scene.h"

#include <utility>

#include "gpu_scene/scene_stages.h"

namespace candela {

Instance instance_at(const GpuScene& scene, const InstancePlace& place) {
    const uvec4* const words = &scene.arrays[ARRAY_NODES][size_t{place.node} * BVH_NODE_WORDS];
    return instance_unpack(words[0], words[1], words[2], words[3]);
}

uint64_t GpuScene::bytes() const {
    uint64_t words = 0;
    for (const Words& array : arrays)
        words += array.size();
    return words * sizeof(uvec4);
}

BufferSet changed_buffers(const GpuScene& before, const GpuScene& now) {
    BufferSet changed;
    for (const SceneArray& array : SCENE_ARRAYS) {
        if (!before.arrays[array.number].is(now.arrays[array.number])) changed.set(array.buffer);
    }
    return changed;
}

GpuScene build_gpu_scene(const Scene& scene) {
    return SceneStages(scene).take();
}

GpuScene build_gpu_scene(const Scene& scene, const SceneFrame& frame, const InstancingRule& rule) {
    return SceneStages(scene, {.frame = frame, .rule = rule}).take();
}

GpuScene build_gpu_scene_freeing_images(Scene& scene) {
    const auto free = [&](size_t i) {
        std::shared_ptr<const TexelImage>& image = scene.images[i].image;
        image = std::make_shared<TexelImage>(
            TexelImage{image->size, image->channels, image->type, {}, image->gamma});
    };
    return SceneStages(scene, {.packed = free}).take();
}

}  // namespace candela
