// `candela compare`: whether two renderings of the same picture differ by more than their noise.
#include "image/compare.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "base/file.h"
#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/command_files.h"
#include "cli/console.h"
#include "image/image_io.h"

namespace candela {
namespace {

struct CompareArguments {
    std::string a;
    std::string b;
    std::optional<double> relmse;
    std::optional<double> alpha;
    std::optional<std::string> heatmap;
};

std::optional<double> parse_limit(const std::string& text) {
    const auto value = parse_number(text);
    return value && *value >= 0.0 ? value : std::nullopt;
}

std::optional<double> parse_alpha(const std::string& text) {
    const auto value = parse_number(text);
    return value && *value > 0.0 && *value < 1.0 ? value : std::nullopt;
}

const char* verdict(bool passed) {
    return passed ? "pass" : "FAIL";
}

void print(const char* what, const WorstDeviation& worst) {
    const PixelRect& place = worst.place;
    std::printf("%-8s worst z %+.2f in %c of %u,%u,%u,%u (at most %.2f): %s\n", what, worst.z, worst.channel,
                place.x0, place.y0, place.x1, place.y1, worst.critical, verdict(worst.passed()));
}

void print(const Comparison& comparison, const CompareOptions& options) {
    const bool relmse_decides = options.relmse || !comparison.tests;
    std::printf("relMSE   %.6g", comparison.relmse);
    if (relmse_decides) {
        std::printf(" (at most %g): %s", options.relmse.value_or(DEFAULT_RELMSE), verdict(comparison.passed));
    }
    std::printf("\n");
    if (!comparison.tests) {
        std::printf("z        not tested: the images do not both have Variance\n");
        return;
    }
    const ZTests& tests = *comparison.tests;
    std::printf("pixels   %.3f %% within |z| %.2f (at least %.2f %%), worst z %+.2f in %c of %u,%u: %s\n",
                100.0 * tests.passing_pixels, tests.pixel.critical, 100.0 * REQUIRED_PIXEL_FRACTION,
                tests.pixel.z, tests.pixel.channel, tests.pixel.place.x0, tests.pixel.place.y0,
                verdict(tests.passing_pixels >= REQUIRED_PIXEL_FRACTION));
    print("blocks", tests.block);
    print("mean", tests.mean);
    if (relmse_decides) std::printf("--relmse decides, not the z-tests\n");
}

ExitCode run(const CompareArguments& arguments) {
    if (arguments.heatmap) {
        if (image_format(*arguments.heatmap) != ImageFormat::png) {
            throw Error(
                "--heatmap: cannot use \"" + *arguments.heatmap + "\"; expected a file name ending in .png",
                ErrorKind::request);
        }
        CommandFiles files;
        files.read("A", arguments.a);
        files.read("B", arguments.b);
        files.write("--heatmap", *arguments.heatmap);
        check_writable(*arguments.heatmap);
    }
    const ImageLimits compared{.channels = {"R", "G", "B", "Variance.R", "Variance.G", "Variance.B"}};
    const Image a = read_exr(arguments.a, compared);
    const Image b = read_exr(arguments.b, compared);
    const CompareOptions options{.alpha = arguments.alpha.value_or(CompareOptions{}.alpha),
                                 .relmse = arguments.relmse};
    const Comparison comparison = compare(a, b, options);
    if (arguments.alpha && !comparison.tests) {
        throw Error(
            "--z: the images do not both have Variance; render both with --aov variance, or use --relmse");
    }
    if (arguments.heatmap) {
        write_png(*arguments.heatmap, a.data.width(), a.data.height(), heatmap(a, b, options),
                  write_finished_work);
    }
    print(comparison, options);
    std::printf("%s\n", comparison.passed ? "the images agree" : "the images DIFFER");
    flush_results();
    return comparison.passed ? ExitCode::done : ExitCode::comparison_failed;
}

}  // namespace

Command add_compare_command(CLI::App& app) {
    CLI::App* const command = app.add_subcommand("compare", "Compare two EXR images of the same picture");
    const auto arguments = std::make_shared<CompareArguments>();
    command->add_option("A", arguments->a, "Image to judge (.exr)")->required()->type_name("");
    command->add_option("B", arguments->b, "Reference (.exr)")->required()->type_name("");
    CLI::Option* const relmse =
        add_value(*command, "--relmse", arguments->relmse, parse_limit, "a number, 0 or more",
                  "Judge by the relative mean squared error: at most X (without Variance: 1e-3)")
            ->type_name("X");
    add_value(*command, "--z", arguments->alpha, parse_alpha, "a probability between 0 and 1",
              "Probability that a z-test rejects equal images (default: 0.01); needs Variance")
        ->type_name("ALPHA")
        ->excludes(relmse);
    command->add_option("--heatmap", arguments->heatmap, "Write a picture of the differences (.png)")
        ->type_name("FILE");
    command->footer(
        "Where both images have Variance, z-tests of pixels, blocks of 8x8 pixels and the mean decide,\n"
        "else the relative mean squared error. Exit code: 0 if the images agree, 6 if not.");
    return {command, [arguments] { return run(*arguments); }};
}

}  // namespace candela
