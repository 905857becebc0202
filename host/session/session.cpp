// See session.h.
#include "session/session.h"

#include <cstddef>
#include <utility>

#include "base/error.h"
#include "film/sample_range.h"
#include "load/load.h"
#include "session/live_picture.h"
#include "vk/instance.h"

namespace candela {

class Session::Impl {
  public:
    explicit Impl(SessionOptions options)
        : options_(std::move(options)),
          instance_({.validation = options_.validation}),
          device_(instance_,
                  vk::select_device(instance_.devices(),
                                    options_.device.empty() ? std::nullopt : std::optional(options_.device)),
                  options_.kernel_cache),
          picture_(device_) {}

    void load(const SceneFile& file) {
        LoadOptions options;
        options.gltf.time = file.time;
        options.gltf.animation = file.animation;
        options.reach.folders = file.folders;
        scene().load(file.path, options);
        request_ = {};
        warn(scene().take_warnings());
    }

    void change(std::string_view json) {
        require_scene();
        scene().change(json);
        warn(scene().take_warnings());
    }

    void pose(std::optional<double> time, std::optional<std::string> animation) {
        require_scene();
        scene().pose(time, std::move(animation));
        warn(scene().take_warnings());
    }

    void choose(const PictureRequest& picture) {
        require_scene();
        job_for(picture, 1);
        request_ = picture;
    }

    bool render(uint32_t spp, const std::function<bool(double)>& keep_going) {
        require_scene();
        RenderJob job = job_for(request_, spp);
        picture_.update();
        warn(scene().take_warnings());
        const std::optional<Error> failure = picture_.render(
            std::move(job), {.progress = [&](double done, std::optional<double>) { done_ = done; },
                             .keep_going = [&] { return !keep_going || keep_going(done_); },
                             .warn = [this](const std::string& warning) { warn({warning}); },
                             .device_failed =
                                 [this](const Error& error, uint32_t, double) {
                                     warn({std::string(error.what()) + "; reopening the device"});
                                 },
                             .write = {}});
        for (const std::vector<std::string> messages = instance_.validation_messages();
             validation_messages_ < messages.size(); ++validation_messages_)
            warn({messages[validation_messages_]});
        if (failure) throw Error(*failure);
        return picture_.rendered().record().complete;
    }

    // What was rendered last.
    Rendering& rendered() const {
        if (!picture_.has_picture()) throw Error("nothing has been rendered yet; call render() first");
        return picture_.rendered();
    }

  private:
    LiveScene& scene() { return picture_.scene(); }
    const LiveScene& scene() const { return picture_.scene(); }

    void require_scene() const {
        if (scene().scene().cameras.empty()) throw Error("no scene has been loaded yet; call load() first");
    }

    void warn(const std::vector<std::string>& warnings) const {
        for (const std::string& warning : warnings) {
            if (options_.warn) options_.warn(warning);
        }
    }

    RenderJob job_for(const PictureRequest& picture, uint32_t spp) const {
        if (spp == 0 || spp > MAX_SPP) {
            throw Error("cannot render " + std::to_string(spp) + " samples per pixel; give 1 to " +
                        std::to_string(MAX_SPP));
        }
        const Camera& camera = choose_camera(scene().scene(), picture.camera, "");
        RenderSettings settings = proposed_settings(scene().scene(), camera);
        settings.size = {picture.width.value_or(settings.size.x), picture.height.value_or(settings.size.y)};
        if (settings.size.x == 0 || settings.size.y == 0)
            throw Error("a picture without width or height cannot be rendered; give at least 1 for each");
        settings.crop = {0, 0, settings.size.x, settings.size.y};
        settings.seed = picture.seed.value_or(settings.seed);
        settings.aovs = picture.all_layers;
        const bool all = picture.all_layers;
        return {
            .camera = camera, .settings = settings, .target = spp, .aovs = {all, all, all, all, all, all}};
    }

    SessionOptions options_;
    vk::Instance instance_;
    DeviceSlot device_;
    LivePicture picture_;
    PictureRequest request_;
    double done_ = 0.0;
    size_t validation_messages_ = 0;  // Those already given to warn().
};

Session::Session(SessionOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}
Session::~Session() = default;

void Session::load(const SceneFile& file) {
    impl_->load(file);
}

void Session::change(std::string_view json) {
    impl_->change(json);
}

void Session::pose(std::optional<double> time, std::optional<std::string> animation) {
    impl_->pose(time, std::move(animation));
}

void Session::choose(const PictureRequest& picture) {
    impl_->choose(picture);
}

bool Session::render(uint32_t spp, const std::function<bool(double)>& keep_going) {
    return impl_->render(spp, keep_going);
}

uint32_t Session::width() const {
    return impl_->rendered().record().settings.crop.width();
}

uint32_t Session::height() const {
    return impl_->rendered().record().settings.crop.height();
}

std::vector<PictureLayer> Session::layers() const {
    std::vector<PictureLayer> layers;
    for (Channel& channel : impl_->rendered().image().channels)
        layers.push_back({std::move(channel.name), std::move(channel.values)});
    return layers;
}

}  // namespace candela
