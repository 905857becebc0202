// Which images a command writes, and how.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/data_outputs.h"
#include "cli/denoising_options.h"
#include "cli/screen_options.h"
#include "film/accumulation.h"
#include "image/image_io.h"
#include "image/tonemap.h"
#include "scene/names.h"
#include "session/picture_file.h"

namespace candela {

struct Exposure {
    double ev = 0.0;
    bool automatic = false;  // `ev` is still to be found, by auto_exposure():
    bool of_first = false;   // of the first of several pictures, for all of them.
};

// How radiance becomes a picture for the screen.
struct DevelopmentOptions {
    Exposure exposure;
    Tonemap tonemap = Tonemap::linear;

    // Declares them on `app`, with an automatic exposure or without; this object must not move.
    void add_to(CLI::App& app, bool with_automatic);
};

// Standard output, among the names of outputs; it gets an EXR file.
inline constexpr const char* STDOUT = "-";

// image_format() of an output.
ImageFormat output_format(const std::string& path);

struct ImageOutputs {
    std::vector<std::string> files;
    DataOutputs data;
    AovSelection aovs{true, true, true, true, true, true};  // In an EXR.
    bool half = false;                                      // EXR: R G B A and Albedo with 16 bits.
    DevelopmentOptions development;
    ScreenOptions screen;
    DenoisingOptions denoising;

    // Declares all but --aov, --alpha and --denoise on `app`; this object must not move.
    void add_to(CLI::App& app);
    void add_aovs_to(CLI::App& app);

    // All files: those of images, and then those of data; and what option names each.
    struct Output {
        const char* option;
        std::string name;
    };
    std::vector<Output> outputs() const;
    // The same outputs with other names, in that order.
    ImageOutputs renamed(const std::vector<std::string>& names) const;
    // Throws Error (usage) if outputs()[i] may not have that name.
    void check_name(size_t i, const std::string& name) const;

    // The images besides R G B A that will be made: those selected, if one of the files is an EXR, and what
    // files of data need.
    AovSelection written_aovs() const;
    // The same, and what the denoiser needs.
    AovSelection rendered_aovs() const;
    // Denoises a rendered image, and removes what only the denoiser needed. A failure is a warning.
    std::optional<DenoisingRecord> denoise(Image& image) const;
    // Whether the image stands before something, so that its alpha is to be denoised, too.
    bool shows_alpha(const Image& image) const;
    // Whether an EXR file goes to standard output.
    bool uses_stdout() const;
    // The same with the exposure for this image, if it is automatic.
    ImageOutputs exposed_for(const Image& image) const;
};

}  // namespace candela
