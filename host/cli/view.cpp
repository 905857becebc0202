// `candela view`: a window that shows how a scene's picture accumulates.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/file.h"
#include "base/printable.h"
#include "cli/arguments.h"
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
#include "probe/scenes.h"
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
    scene.add_file_to(app)->required(false)->description(std::string(SCENE_FILES) +
                                                         "; without it, drop one onto the window");
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
    if (frames && scene.file.empty()) {
        throw Error("--frames: also name the SCENE that is shown", ErrorKind::request);
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

// A scene, and how its window shows it at first.
struct Opened {
    Scene scene;
    ViewState state;
    std::string name;          // For the title, and for files.
    std::string command_line;  // For the attributes of EXRs.
    bool start_page = false;   // It stands behind the start page.
};

Opened opened(const ViewArguments& arguments, Scene scene, const std::string& name, const Camera& camera,
              const std::string& command_line) {
    const RenderSettings settings = arguments.rendering.settings(scene, camera);
    print_warnings(warnings_of_unseen_lights(scene, settings.estimator));
    return {.scene = std::move(scene),
            .state = {.camera = camera,
                      .home = camera,
                      .settings = settings,
                      .exposure_ev = float(arguments.development.exposure.ev),
                      .tonemap = arguments.development.tonemap,
                      .denoise = arguments.denoising.is_on()},
            .name = name,
            .command_line = command_line};
}

Opened opened_file(const ViewArguments& arguments, const std::string& file, Scene scene,
                   const std::string& command_line) {
    const Camera camera = arguments.scene.choose_camera(scene);
    const std::string name = std::filesystem::path(file).stem().string();
    return opened(arguments, std::move(scene), name, camera, command_line);
}

// What is shown first: the scene, or what stands behind the start page.
Opened open_first(const ViewArguments& arguments, const std::string& command_line) {
    const std::string& file = arguments.scene.file;
    CommandFiles files;
    if (!file.empty()) files.read("SCENE", file);
    for (const std::string& path : arguments.screenshots)
        files.write("--screenshot", path);
    arguments.check();
    if (file.empty()) {
        Scene scene = cornell_box();
        const Camera camera = scene.cameras.front();
        Opened start = opened(arguments, std::move(scene), "candela", camera, command_line);
        start.start_page = true;
        return start;
    }
    Scene scene = load_with_progress(file, arguments.rendering.loading);
    files.read_all("the scene's file", scene.files);
    return opened_file(arguments, file, std::move(scene), command_line);
}

// A file that was dropped onto the window, which waits for it.
Opened open_dropped(const ViewArguments& arguments, Window& window, const std::string& file,
                    const std::string& command_line) {
    const std::string name = std::filesystem::path(file).filename().string();
    window.set_title("loading " + printable(name, MAX_NAME_BYTES));
    Scene scene = load_quietly(file, arguments.rendering.loading);
    print_warnings(scene.warnings);
    return opened_file(arguments, file, std::move(scene), command_line + " " + shell_quoted(file));
}

ExitCode view(const ViewArguments& arguments, const std::string& command_line) {
    const RenderingOptions& rendering = arguments.rendering;
    std::optional<Opened> next = open_first(arguments, command_line);
    Window window(next->state.settings.size, !arguments.frames, printable(next->name, MAX_NAME_BYTES));
    vk::Instance::Options instance_wishes = instance_options();
    instance_wishes.extensions = window.instance_extensions();
    const vk::Instance instance(instance_wishes);
    const vk::DeviceInfo device = choose_device(instance, window, rendering.device.name);
    DeviceSlot denoising_device(instance, device, pipeline_cache_folder());
    const std::shared_ptr<Denoiser> denoiser = arguments.denoising.make(
        [&denoising_device]() -> const vk::Device& { return denoising_device.open(); });
    const os::Interrupts interrupts;
    ViewerOptions options{.device = device,
                          .pipeline_cache_folder = pipeline_cache_folder(),
                          .name = {},
                          .command_line = {},
                          .target = arguments.frames.value_or(rendering.sampling.spp.value_or(MAX_SPP)),
                          .close_at_target = arguments.frames.has_value(),
                          .stopped = [&interrupts] { return interrupts.noted(); },
                          .say = print_note,
                          .denoiser = denoiser};
    bool complete = false;
    std::optional<Opened> before;  // What the window showed when a file was dropped onto it.
    std::string failure;           // Why it shows that again.
    while (next) {
        Opened shown = *std::exchange(next, std::nullopt);
        options.name = shown.name;
        options.command_line = shown.command_line;
        options.start_page = shown.start_page;
        std::optional<Viewer> viewer;
        try {
            viewer.emplace(window, instance, std::move(shown.scene), shown.state, options);
        } catch (const Error& error) {
            if (!before) throw;
            next = std::exchange(before, std::nullopt);
            failure = error.what();
            continue;
        }
        before.reset();
        if (!failure.empty()) viewer->tell(std::exchange(failure, {}));
        complete = viewer->run();
        while (const std::optional<std::string> file = window.take_dropped()) {
            if (arguments.frames || window.closing()) break;
            try {
                next = open_dropped(arguments, window, *file, command_line);
            } catch (const Error& error) {
                viewer->tell(error.what());
                complete = viewer->run();
            }
        }
        Attempts attempts;
        for (const std::string& path : arguments.screenshots) {
            if (complete) attempts.attempt([&] { viewer->save(path); });
        }
        attempts.finish();
        if (next) {
            std::tie(shown.scene, shown.state) = std::move(*viewer).leave();
            before = std::move(shown);
        }
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
