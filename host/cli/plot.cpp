// `candela plot`: convergence curves from the reports of `candela render --reference`.
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/file.h"
#include "cli/command.h"
#include "cli/command_files.h"
#include "cli/curve_chart.h"
#include "cli/report_curve.h"

namespace candela {
namespace {

struct PlotArguments {
    std::vector<std::string> reports;
    std::string output;
};

ExitCode run(const PlotArguments& arguments) {
    if (std::filesystem::path(arguments.output).extension() != ".svg") {
        throw Error("-o: cannot use \"" + arguments.output + "\"; expected a file name ending in .svg",
                    ErrorKind::request);
    }
    CommandFiles files;
    for (const std::string& path : arguments.reports)
        files.read("REPORT", path);
    files.write("-o", arguments.output);
    check_writable(arguments.output);
    std::vector<Curve> curves;
    for (const std::string& path : arguments.reports)
        curves.push_back(curve_of_report(read_file(path), path));
    write_finished_work(arguments.output, draw_curves(curves));
    return ExitCode::done;
}

}  // namespace

Command add_plot_command(CLI::App& app) {
    CLI::App* const command = app.add_subcommand("plot", "Plot error over time, from reports");
    const auto arguments = std::make_shared<PlotArguments>();
    command
        ->add_option("REPORT", arguments->reports,
                     "Reports of candela render --reference (.json), one per curve")
        ->required()
        ->type_name("");
    command->add_option("-o,--output", arguments->output, "Drawing to write (.svg)")
        ->required()
        ->type_name("FILE")
        ->take_last();
    command->footer(
        "Example:\n"
        "  candela render box.json -o reference.exr --spp 16384 --seed 1\n"
        "  candela render box.json -o a.exr --reference reference.exr --report sobol.json\n"
        "  candela render box.json -o a.exr --reference reference.exr --report stratified.json "
        "--sampler stratified\n"
        "  candela plot sobol.json stratified.json -o curves.svg\n\n"
        "Both axes are logarithmic; the legend names the files. The reference must have far more samples "
        "and\n"
        "another seed; otherwise the error appears to fall too fast.");
    return {command, [arguments] { return run(*arguments); }};
}

}  // namespace candela
