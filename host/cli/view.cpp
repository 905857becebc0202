// `candela view`: a window that shows how a scene's picture accumulates.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/file.h"
#include "base/printable.h"
#include "cli/attempts.h"
#include "cli/command.h"
#include "cli/command_files.h"
#include "cli/console.h"
#include "cli/denoising_options.h"
#include "cli/image_options.h"
#include "cli/interrupt.h"
#include "cli/loading.h"
#include "cli/rendering_options.h"
#include "cli/vulkan.h"
#include "image/image_io.h"
#include "session/device_slot.h"
#include "vk/device.h"
#include "vk/instance.h"
#include "vk/presenter.h"
#include "window/controls.h"
#include "window/viewer.h"

namespace candela {
namespace {

struct ViewArguments {
    SceneOptions scene;
    RenderingOptions rendering;
    DevelopmentOptions development;
    std::optional<uint32_t> frames;
    std::vector<std::string> screenshots;
    DenoisingOptions denoising;

    // Declares all options on `app`; this object must not move.
    void add_to(CLI::App& app);
    // Throws Error (usage) for options that do not go together, or if a screenshot could not be written.
    void check() const;
};

void ViewArguments::add_to(CLI::App& app) {
    app.option_defaults()->take_last();
    scene.add_file_to(app);
    add_value(
        app, "--frames", frames, [](const std::string& text) { return parse_uint(text, 1, MAX_SPP); },
        "a whole number from 1 to " + std::to_string(MAX_SPP),
        "Close after N frames: N samples per pixel of the picture at rest")
        ->type_name("N");
    app.add_option("--screenshot", screenshots, "Write the picture then, .png or .exr; repeat it for several")
        ->type_name("FILE")
        ->take_all()
        ->allow_extra_args(false);
    development.add_to(app, false);
    denoising.add_shown_to(app);
    rendering.add_to(app);
    scene.add_camera_to(app);
    app.get_option("--crop")->group("");  // Hidden; check() refuses it with the reason.
    app.get_option("--spp")->description("Stop accumulating at this many samples per pixel (default: never)");
}

void ViewArguments::check() const {
    if (rendering.picture.crop) {
        throw Error("--crop: a window shows the whole picture; leave it out, or use candela render",
                    ErrorKind::request);
    }
    if (frames && rendering.sampling.spp) {
        throw Error("--frames and --spp both set the number of samples; give only one", ErrorKind::request);
    }
    if (!screenshots.empty() && !frames) {
        throw Error(
            "--screenshot: also give --frames N, after which it is taken; P and X save a picture at any time",
            ErrorKind::request);
    }
    for (const std::string& path : screenshots)
        image_format(path);
    for (const std::string& path : screenshots)
        check_writable(path);
}

#ifdef CANDELA_VIEW

// The device that the options ask for, or the best, with the queue that can show pictures in the window.
vk::DeviceInfo choose_device(const vk::Instance& instance, const Window& window,
                             const std::optional<std::string>& wanted) {
    const vk::Surface surface = window.make_surface(instance.handle());
    std::vector<vk::DeviceInfo> devices = instance.devices();
    for (vk::DeviceInfo& device : devices)
        vk::choose_presenting_queue(device, surface.get());
    return vk::select_device(devices, wanted);
}

ExitCode view(const ViewArguments& arguments, const std::string& command_line) {
    CommandFiles files;
    files.read("SCENE", arguments.scene.file);
    for (const std::string& path : arguments.screenshots)
        files.write("--screenshot", path);
    arguments.check();
    const RenderingOptions& rendering = arguments.rendering;
    Scene scene = load_with_progress(arguments.scene.file, rendering.loading);
    files.read_all("the scene's file", scene.files);
    const Camera& camera = arguments.scene.choose_camera(scene);
    const ViewState state{.camera = camera,
                          .settings = rendering.settings(scene, camera),
                          .exposure_ev = float(arguments.development.exposure.ev),
                          .tonemap = arguments.development.tonemap,
                          .denoise = arguments.denoising.is_on()};

    print_warnings(warnings_of_unseen_lights(scene, state.settings.estimator));
    const std::string name = std::filesystem::path(arguments.scene.file).stem().string();
    Window window(state.settings.size, !arguments.frames, printable(name, MAX_NAME_BYTES));
    vk::Instance::Options instance_wishes = instance_options();
    instance_wishes.extensions = window.instance_extensions();
    const vk::Instance instance(instance_wishes);
    const vk::DeviceInfo device = choose_device(instance, window, rendering.device.name);
    DeviceSlot denoising_device(instance, device, pipeline_cache_folder());
    const std::shared_ptr<Denoiser> denoiser = arguments.denoising.make(
        [&denoising_device]() -> const vk::Device& { return denoising_device.open(); });
    const os::Interrupts interrupts;
    bool complete = false;
    {
        Viewer viewer(window, instance, std::move(scene), state,
                      {.device = device,
                       .pipeline_cache_folder = pipeline_cache_folder(),
                       .name = name,
                       .command_line = command_line,
                       .target = arguments.frames.value_or(rendering.sampling.spp.value_or(MAX_SPP)),
                       .close_at_target = arguments.frames.has_value(),
                       .stopped = [&interrupts] { return interrupts.noted(); },
                       .say = print_note,
                       .denoiser = denoiser});
        complete = viewer.run();
        Attempts attempts;
        for (const std::string& path : arguments.screenshots) {
            if (complete) attempts.attempt([&] { viewer.save(path); });
        }
        attempts.finish();
    }
    check_validation(instance);
    if (interrupts.noted()) return ExitCode::interrupted;
    if (arguments.frames && !complete) {
        throw Error("the window was closed before it had shown " + std::to_string(*arguments.frames) +
                    " frames, so no screenshot was written");
    }
    return ExitCode::done;
}

#else

ExitCode view(const ViewArguments& arguments, const std::string&) {
    arguments.check();
    throw Error(
        "view: this program was built without a window, which needs GLFW and Dear ImGui; install "
        "libglfw3-dev and libimgui-dev and build it with cmake -DCANDELA_VIEW=ON, or use candela render");
}

#endif

}  // namespace

Command add_view_command(CLI::App& app, const std::string& command_line) {
    CLI::App* const command = app.add_subcommand("view", "Watch a picture accumulate in a window");
    const auto arguments = std::make_shared<ViewArguments>();
    arguments->add_to(*command);
    command->footer(
        std::string(
            "The picture has the size of the window. While the camera moves it may be coarser; at rest it\n"
            "accumulates the same bits as `candela render`, up to --spp samples per pixel if given.\n"
            "Files are written to the current folder: SCENE-1.png, SCENE-2.png, ... EXRs are the same as by\n"
            "`candela render`, so that candela merge and compare read them.\n\n"
            "Mouse and keys:\n") +
        CONTROLS_HELP +
        "\n\n"
        "Example:\n"
        "  candela view scenes/cornell-box.json --frames 64 --screenshot box.png");
    return {command, [arguments, command_line] { return view(*arguments, command_line); }};
}

}  // namespace candela
