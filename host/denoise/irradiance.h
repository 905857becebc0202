// What the kernel of denoising works on: irradiance, its variance and the features of a pixel, and the way
// back.
#pragma once

#include <cstdint>
#include <vector>

#include "base/math.h"
#include "denoise/level.h"
#include "denoise/variance.h"

namespace candela {

class Irradiance {
  public:
    // `picture` must live as long.
    explicit Irradiance(const NoisyPicture& picture);

    // Prepares the pixels of that rectangle; only these may then be asked for.
    void load(const PixelRect& rect);

    // The texel of pixel i in a layer below DENOISE_LAYERS_GIVEN, as shared/denoise.h says.
    vec4 texel(uint32_t layer, size_t i) const;

    // Puts the pixel with that filtered irradiance (rgb) and coverage (a) into `result`: the picture's own
    // values unless it `is_there`.
    void put(size_t i, vec4 filtered, bool is_there, Denoised& result) const;

  private:
    vec3 colour(size_t i) const;
    // Without its noise; 0 if there is none.
    vec3 albedo(size_t i) const;
    // What irradiance is multiplied by.
    vec3 reflected(size_t i) const;
    // The mean albedo of the 3 x 3 pixels around one without.
    vec3 albedo_around(size_t i) const;
    bool has_value(size_t i) const;
    bool has_features(size_t i) const;

    const NoisyPicture* picture_;
    PixelRect rect_;
    std::vector<vec3> albedo_;  // Of the rectangle; empty if the picture has none.
    PictureLevel level_;
};

}  // namespace candela
