// The mean of a texture over a piece of a surface: the light of a textured emitter.
#pragma once

#include <span>
#include <vector>

#include "scene/texture.h"

namespace candela {

// The colours of an image, decoded, at all levels of a pyramid.
class ImagePyramid {
  public:
    ImagePyramid(const TexelImage& image, TextureEncoding encoding);

    // The approximate mean of `texture`, which looks up this image, over places (u, v) that are spread evenly
    // over a piece of a surface, with gaps of at most `spacing`. It is positive in every channel in which the
    // texture is not 0 all over the piece.
    vec3 mean(const Texture& texture, std::span<const vec2> places, float spacing) const;

  private:
    struct Level {
        uvec2 size;
        std::vector<vec3> texels;
    };

    // Interpolated linearly between the centres of texels, on that level.
    vec3 look_up(size_t number, const Texture& texture, vec2 place) const;

    std::vector<Level> levels_;  // The image, and halved repeatedly, down to one texel.
};

// The linear red, green and blue of texel i, row-major from the top.
vec3 texel_color(const TexelImage& image, TextureEncoding encoding, size_t i);

}  // namespace candela
