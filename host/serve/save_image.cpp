// See save_image.h.
#include "serve/save_image.h"

#include "denoise/denoise_image.h"
#include "image/background.h"
#include "image/develop.h"
#include "session/picture_file.h"

namespace candela::serve {

SaveRequest read_save(const Node& parameters) {
    parameters.allow_only({"image", "file", "exposure", "tonemap"});
    SaveRequest request{.file = parameters.require("file").file_name()};
    request.format = image_format(request.file);
    if (const auto curve = parameters.find("tonemap")) request.curve = curve->choice(TONEMAP_NAMES);
    if (const auto exposure = parameters.find("exposure")) {
        request.automatic_exposure = exposure->is_string() && exposure->string() == "auto";
        if (!request.automatic_exposure)
            request.exposure_ev = exposure->number(-MAX_EXPOSURE_EV, MAX_EXPOSURE_EV);
    }
    return request;
}

void save_image(Image image, const SaveRequest& request) {
    if (request.format == ImageFormat::exr) {
        write_exr(request.file, image);
        return;
    }
    static const Background transparent = Transparent{};
    const bool before_nothing = image.find(FIRST_HIT_ALPHA) != nullptr;
    const float exposure = request.automatic_exposure ? auto_exposure(image) : request.exposure_ev;
    const DenoisedView denoised(image);
    write_picture(request.file,
                  develop(image, {.curve = request.curve,
                                  .exposure_ev = exposure,
                                  .background = before_nothing ? &transparent : default_background(image)}),
                  picture_notes(image));
}

}  // namespace candela::serve
