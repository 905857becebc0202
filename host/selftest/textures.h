// Tests the look-up of textures on the device against one in double precision.
#pragma once

#include <vector>

#include "probe/probe.h"
#include "selftest/evidence.h"

namespace candela {

// A scene whose materials have colours from images of every kind of texel and of several sizes: material i
// has texture i, with every combination of wrap, filter, encoding, channel and transform.
Scene texture_scene();

// One look-up: a texture and a place.
struct TextureItem {
    uint32_t texture = 0;
    vec2 uv{0};
    uint32_t unused = 0;
};
struct TextureValue {
    vec4 rgba;
    float number;
};

// `count` look-ups of all textures of a scene: anywhere within some periods of 0, at the centres and edges of
// texels, at whole numbers and next to them.
std::vector<TextureItem> texture_items(const Scene& scene, size_t count);

std::vector<TextureValue> run_textures(const vk::Device& device, const GpuScene& gpu, SceneAccess access,
                                       const std::vector<TextureItem>& items);

// The possible results of a look-up: the value in double precision, with bounds for the rounding of its
// place.
struct TextureBounds {
    glm::dvec4 lo, hi;
};

// The scene's textures in double precision.
class TextureReference {
  public:
    // The scene, one of texture_scene()'s kind, must outlive the reference.
    explicit TextureReference(const Scene& scene);

    const Texture& texture(uint32_t i) const;
    TextureBounds at(uint32_t texture, vec2 uv) const;

  private:
    const Scene& scene_;
    std::vector<std::vector<glm::dvec4>> texels_[2];  // Texels of each image, by encoding: linear, sRGB.
};

// `count` look-ups.
Evidence test_textures(const vk::Device& device, SceneAccess access, size_t count);

}  // namespace candela
