// Files of a picture that has been rendered.
#pragma once

#include <filesystem>

#include "image/image.h"
#include "image/image_io.h"
#include "image/tonemap.h"
#include "load/node.h"

namespace candela::serve {

struct SaveRequest {
    std::filesystem::path file;
    ImageFormat format = ImageFormat::exr;
    // For pictures for the screen:
    Tonemap curve = Tonemap::linear;
    float exposure_ev = 0.0f;
    bool automatic_exposure = false;
};

// The parameters of `save`. Throws Error for what makes no sense.
SaveRequest read_save(const Node& parameters);

// Writes what `candela render` would: an EXR file with all layers, or a picture for the screen. One that was
// rendered before nothing is transparent. Throws Error if that fails.
void save_image(Image image, const SaveRequest& request);

}  // namespace candela::serve
