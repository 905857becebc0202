// See viewer.h. The files that the viewer writes.
#include "base/error.h"
#include "base/file.h"
#include "denoise/denoise_image.h"
#include "image/develop.h"
#include "image/image_io.h"
#include "session/record.h"
#include "view/camera_control.h"
#include "window/viewer.h"

namespace candela {

// `positions` may be empty: then the image lacks P and Z, which need a device.
void Viewer::write_radiance(const std::filesystem::path& path, const Accumulation& state,
                            const std::vector<float>& positions) {
    const bool placed = !positions.empty();
    Image image = make_image(state, {true, true, placed, placed, true, true}, positions);
    RenderRecord record = make_record(scene_, gpu_scene_, {.camera = camera_, .settings = settings_});
    record.command_line = options_.command_line;
    record.maker = make_maker(options_.device);
    record.render_seconds = render_seconds_;
    record.spp = state.min_samples();
    record.max_spp = state.max_samples();
    add_attributes(image, record);
    write_exr(path, image, write_finished_work);
}

void Viewer::save(const std::filesystem::path& path) {
    const Accumulation state = renderer_->download();
    if (image_format(path) == ImageFormat::exr) {
        write_radiance(path, state, renderer_->positions());
    } else {
        const Development development{.curve = state_.tonemap, .exposure_ev = state_.exposure_ev};
        Image image = state_.denoise ? denoiser_.denoised(state) : make_image(state, {}, {});
        const DenoisedView denoised(image);
        write_picture(path, develop(image, development), {}, write_finished_work);
    }
}

void Viewer::save_copy() {
    if (!copy_.state() || restart_) return;
    save_as_next(".exr", [this](const std::string& path) { write_radiance(path, *copy_.state(), {}); });
}

void Viewer::save_as_asked(const ViewRequests& requests) {
    if (requests.save_png) save_as_next(".png", [this](const std::string& path) { save(path); });
    if (requests.save_exr) save_as_next(".exr", [this](const std::string& path) { save(path); });
    if (requests.save_camera) {
        save_as_next("-camera.json", [this](const std::string& path) {
            write_finished_work(path, camera_json(state_.camera, "view", state_.settings.size));
        });
    }
}

// Writes to the first file NAME-1, NAME-2, ... that does not exist yet. Tells the user of a failure, who may
// try again.
void Viewer::save_as_next(const std::string& extension,
                          const std::function<void(const std::string&)>& write) {
    std::string path;
    uint32_t number = 0;
    do {
        path = options_.name + "-" + std::to_string(++number) + extension;
    } while (std::filesystem::exists(path));
    try {
        write(path);
        tell("wrote " + path);
    } catch (const Error& error) {
        tell(error.what());
    }
}

}  // namespace candela
