// `candela merge`: merges parts of one rendering, each with samples of its own, into the image of all
// samples.
#include "film/merge.h"

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/printable.h"
#include "base/text.h"
#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/command_files.h"
#include "cli/console.h"
#include "cli/image_options.h"
#include "cli/outputs.h"
#include "cli/vulkan.h"
#include "film/sample_range.h"

namespace candela {
namespace {

struct MergeArguments {
    std::vector<std::string> parts;
    std::optional<SampleRange> missing;
    ImageOutputs images;
};

// Prints the samples that no part holds, one range per line.
ExitCode print_missing(const MergeArguments& arguments) {
    const Missing missing =
        missing_samples({arguments.parts.begin(), arguments.parts.end()}, *arguments.missing);
    print_warnings(missing.warnings);
    for (const SampleRange& range : missing.samples)
        std::printf("%s\n", to_text({&range, 1}).c_str());
    flush_results();
    return ExitCode::done;
}

ExitCode run(MergeArguments& arguments, const std::string& command_line) {
    if (arguments.missing) return print_missing(arguments);
    ScreenOptions& screen = arguments.images.screen;
    CommandFiles files;  // The parts are all read before anything is written: one of them may be the output.
    for (const auto& [option, path] : arguments.images.outputs())
        files.write(option, path);
    if (const auto background = screen.background_file()) files.read("--background", *background);
    check_outputs(arguments.images);
    screen.load();
    LazyDevice device;
    arguments.images.denoising.load([&]() -> const vk::Device& { return device.open(); });
    Merged merged = merge_files({arguments.parts.begin(), arguments.parts.end()});
    if (merged.had_denoised && !arguments.images.denoising.is_on()) {
        merged.warnings.emplace_back(
            "the layers Denoised of the parts are left out: the merged picture is denoised anew, by "
            "--denoise");
    }
    print_warnings(merged.warnings);
    merged.image.attributes["candela.commandLine"] = command_line;
    const std::string samples = std::get<std::string>(merged.image.attributes.at("candela.samples"));
    const size_t count = arguments.parts.size();
    arguments.images.denoising.denoise_or_warn(merged.image, arguments.images.shows_alpha(merged.image));
    device.check();
    write_images(arguments.images, std::move(merged.image));
    const std::string note = concat("merged ", count, count == 1 ? " part" : " parts", ": samples ",
                                    printable(samples, MAX_MESSAGE_BYTES));
    if (arguments.images.uses_stdout()) {
        print_note(note);
    } else {
        std::printf("%s\n", note.c_str());
        flush_results();
    }
    return ExitCode::done;
}

}  // namespace

Command add_merge_command(CLI::App& app, const std::string& command_line) {
    CLI::App* const command =
        app.add_subcommand("merge", "Join images of different samples of one rendering");
    const auto arguments = std::make_shared<MergeArguments>();
    command->add_option("PART", arguments->parts, "Images by candela render, usually with --samples (.exr)")
        ->required()
        ->type_name("")
        ->take_all();
    arguments->images.add_to(*command);
    arguments->images.denoising.add_to(*command);
    add_value(
        *command, "--missing", arguments->missing, parse_samples, SAMPLES_EXPECTED,
        "Only print which of these samples no part holds, one range per line; a file that cannot be read "
        "holds none")
        ->type_name("A..B")
        ->excludes(command->get_option("--output"));
    command->footer(
        "Example:\n"
        "  candela render box.json -o a.exr --samples 0..64\n"
        "  candela render box.json -o b.exr --samples 64..128\n"
        "  candela merge a.exr b.exr -o box.exr -o box.png\n"
        "  candela merge --missing 0..256 a.exr b.exr\n\n"
        "Scene, size, crop, camera, seed, sampler, estimator, filter and depths must be the same, and no\n"
        "two parts may hold the same sample. Missing samples cause a warning. The result equals one\n"
        "rendering of all samples, up to rounding (a few units of 2^-24), and can be merged again; parts\n"
        "by --half have three digits.");
    return {command, [arguments, command_line] { return run(*arguments, command_line); }};
}

}  // namespace candela
