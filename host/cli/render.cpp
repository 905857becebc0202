// `candela render`: from scene files to image files.
#include <iostream>
#include <memory>
#include <string>

#include "cli/batch.h"
#include "cli/command.h"
#include "cli/picture_plan.h"
#include "cli/render_options.h"
#include "session/checkpoints.h"

namespace candela {
namespace {

ExitCode render(RenderOptions& options, const std::string& command_line) {
    PicturePlan plan(options, std::cin);
    Batch batch(plan, options, command_line);
    check_checkpoint(options.checkpoint);
    options.outputs.images.screen.load();
    options.outputs.images.denoising.load([&]() -> const vk::Device& { return batch.denoising_device(); });
    return batch.run();
}

constexpr const char* FOOTER = R"(Examples:
  candela render scenes/cornell-box.json -o box.exr -o box.png --spp 256 --size 512x512
  candela render models/*.glb -o 'out/{stem}.png' --skip-existing --report out/report.jsonl
  candela render @models.txt --cameras all -o 'out/{stem}/{camera}.exr'
  candela render robot.glb --frames 1..120 --fps 24 -o 'out/{frame:04}.png'

In names of images, {stem} and {name} are the name of the scene's file without and with its extension, {folder}
that of its folder, {camera} that of the camera, {scene} and {variant} what these options say, {view} the number
of the picture among those of its scene, from 0, and {frame} that of the frame; {frame:04} has four digits.
{{ and }} are braces. Folders whose names have fields are made. A list has the path of a scene on each line,
relative to the current folder; empty lines and those that begin with # are left out.
Of several pictures, each that fails is an error, and the others go on. The exit code is 0 if none failed, that
of the errors if they have the same, and otherwise 1. Ctrl-C ends a batch with whole pictures only, and so does
--batch-time, with the exit code 7.

Ctrl-C stops early and writes the image so far (exit code 130); so does closing the terminal, except under
nohup. A second Ctrl-C ends the program at once.

With --checkpoint a rendering survives the end of the program: the same command with --resume continues it,
to the same bits. Scripts can always pass --resume, even the first time.
--target-error compares the image with that of half as many samples, at powers of two from 16 on. This is the
error for --sampler independent, and more than the error for samplers that converge faster. It excludes light
that no sample has found yet. A resumed rendering estimates the error anew, and may need up to twice as many
samples.
--adaptive renders two halves with different seeds. Each puts its samples where the other shows that they
remove the most noise for their time, so there is no bias. The image is their mean, and their difference gives
the estimated error. It keeps four states in memory instead of one, and its images cannot be merged.
--progress json prints an object twice a second, and a last one, whose state is neither "loading" nor
"rendering", when all files are written; after an error there is none.
--samples 0..64 on one computer, --samples 64..128 on another: candela merge joins the parts.)";

}  // namespace

Command add_render_command(CLI::App& app, const std::string& command_line) {
    CLI::App* const command = app.add_subcommand("render", "Render a scene to image files");
    const auto options = std::make_shared<RenderOptions>();
    options->add_to(*command);
    command->footer(FOOTER);
    return {command, [options, command_line] { return render(*options, command_line); }};
}

}  // namespace candela
