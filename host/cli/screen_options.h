// How pictures for the screen are made of an image: what they stand before, and how files hold them.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "film/accumulation.h"
#include "image/background.h"
#include "image/develop.h"
#include "image/image_io.h"
#include "render/renderer.h"

namespace candela {

// What the alpha of a picture before a background is 1 minus of.
enum class AlphaConvention {
    transmission,  // How much of the background is seen, also through ideal transmission.
    first_hit,     // The fraction of camera rays that hit nothing.
};

struct ScreenOptions {
    std::optional<std::string> background;  // As on the command line.
    AlphaConvention alpha = AlphaConvention::transmission;
    TexelType type = TexelType::unorm8;  // In a PNG.
    int quality = PictureNotes{}.quality;
    std::shared_ptr<const Background> loaded;  // See load().

    // Declares all but --alpha on `app`; this object must not move.
    void add_to(CLI::App& app);
    void add_alpha_to(CLI::App& app);

    // The background's file, if it is one.
    std::optional<std::string> background_file() const;
    // Reads the background, and prints warnings about its file. Throws Error if it cannot be used.
    void load();

    // How the device must render for that, and what the image then holds.
    Backdrop backdrop() const;
    // The picture in a file of that format, with that exposure and curve. Without a background, one of a
    // scene in a studio that the camera does not see stands before a soft grey.
    TexelImage develop(const Image& image, ImageFormat format, Tonemap curve, float exposure_ev) const;
    // What the file states besides: the image's texts, without the command line and the time, so that files
    // of equal pictures are equal, and name nothing of the computer's folders.
    PictureNotes notes(const Image& image) const;
};

}  // namespace candela
