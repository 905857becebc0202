// The mean of a texture over a piece of a surface: how much light a textured emitter sends out.
#pragma once

#include <span>
#include <vector>

#include "scene/texture.h"

namespace candela {

// The colours of an image, decoded, at all levels of a pyramid.
class ImagePyramid {
  public:
    ImagePyramid(const TexelImage& image, TextureEncoding encoding);

    // The mean of `texture`, which looks up this image, over a convex polygon of places (u, v). A polygon up
    // to some texels wide is integrated on the image, a wider one on a smaller copy of it. If the polygon is
    // too narrow to have an area, the result is the mean along its edges. It is positive in every channel in
    // which the texture is not 0 all over the polygon.
    vec3 mean(const Texture& texture, std::span<const vec2> corners) const;

  private:
    struct Level {
        uvec2 size;
        std::vector<vec3> texels;
    };

    vec3 texel(const Level& level, const Texture& texture, double x, double y) const;

    std::vector<Level> levels_;  // The image, and halved repeatedly, down to one texel.
};

// The linear red, green and blue of texel i, row-major from the top.
vec3 texel_color(const TexelImage& image, TextureEncoding encoding, size_t i);

}  // namespace candela
