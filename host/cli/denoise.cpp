// `candela denoise`: denoises an image that was rendered before, by candela or another renderer.
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cli/command.h"
#include "cli/command_files.h"
#include "cli/console.h"
#include "cli/image_options.h"
#include "cli/outputs.h"
#include "cli/vulkan.h"
#include "denoise/denoise_image.h"
#include "image/image_io.h"

namespace candela {
namespace {

struct DenoiseArguments {
    std::string image;
    ImageOutputs outputs;
    std::optional<std::string> device;
};

ExitCode run(DenoiseArguments& arguments, const std::string& command_line) {
    ImageOutputs& outputs = arguments.outputs;
    CommandFiles files;
    files.read("IMAGE", arguments.image);
    for (const auto& [option, path] : outputs.outputs())
        files.write(option, path);
    if (const auto background = outputs.screen.background_file()) files.read("--background", *background);
    check_outputs(outputs);
    outputs.screen.load();
    LazyDevice device(arguments.device);
    outputs.denoising.load([&]() -> const vk::Device& { return device.open(); });
    Image image = read_exr(arguments.image);
    const std::string guides = describe_guides(image);
    const DenoisingRecord record =
        outputs.denoising.denoise(image, outputs.shows_alpha(image), arguments.image);
    device.check();
    image.attributes["candela.commandLine"] = command_line;
    write_images(outputs, std::move(image));
    const std::string note = "denoised by " + record.description + ' ' + guides;
    if (outputs.uses_stdout()) {
        print_note(note);
    } else {
        std::printf("%s\n", note.c_str());
        flush_results();
    }
    return ExitCode::done;
}

}  // namespace

Command add_denoise_command(CLI::App& app, const std::string& command_line) {
    CLI::App* const command = app.add_subcommand("denoise", "Denoise an EXR image");
    const auto arguments = std::make_shared<DenoiseArguments>();
    command->add_option("IMAGE", arguments->image, "Image by candela render or another renderer (.exr)")
        ->required()
        ->type_name("");
    arguments->outputs.add_to(*command);
    arguments->outputs.denoising.add_required_to(*command);
    command
        ->add_option("--device", arguments->device,
                     "Index or part of the name, for variance (default: the best)")
        ->type_name("D");
    command->footer(
        "Example:\n"
        "  candela render box.json -o box.exr --spp 16 --aov albedo,n,variance,denoising\n"
        "  candela denoise box.exr -o box.png\n\n"
        "The layers DenoisingAlbedo and DenoisingNormal (--aov denoising) or, without them, Albedo and N "
        "guide\n"
        "it; without any, colour alone does. With the layer Variance, the result is blended with the noisy "
        "picture.\nAn EXR keeps all layers, and gets Denoised.R, G and B.\n"
        "A denoised crop is not the crop of a denoised picture: what is near its edge is not known.");
    return {command, [arguments, command_line] { return run(*arguments, command_line); }};
}

}  // namespace candela
