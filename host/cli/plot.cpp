// `candela plot`: convergence curves from the reports of `candela render --reference`.
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/file.h"
#include "cli/command.h"
#include "cli/command_files.h"
#include "cli/curve_chart.h"

namespace candela {
namespace {

using Json = nlohmann::ordered_json;

struct PlotArguments {
    std::vector<std::string> reports;
    std::string output;
};

// The points of a report that have a place in the chart. Throws Error if it is no report or has none.
Curve read_curve(const std::string& path) {
    const auto refuse = [&](const std::string& why) {
        throw Error("cannot plot \"" + path + "\": " + why +
                    "; give a report of candela render --reference REF.exr --report FILE");
    };
    Curve curve{.name = std::filesystem::path(path).stem().string(), .points = {}};
    const Json report = Json::parse(read_file(path), nullptr, false);
    if (!report.is_object()) refuse("it is no report");
    if (!report.contains("convergence") || !report.contains("reference"))
        refuse("it has no errors against a reference");
    try {
        for (const Json& point : report["convergence"]) {
            const double seconds = point.at("seconds"), relmse = point.at("relmse");
            if (seconds > 0.0 && relmse > 0.0) curve.points.push_back({seconds, std::sqrt(relmse)});
        }
    } catch (const Json::exception&) {
        refuse("its points are damaged");
    }
    if (curve.points.empty()) refuse("none of its points has both a time and an error above 0");
    return curve;
}

ExitCode run(const PlotArguments& arguments) {
    if (std::filesystem::path(arguments.output).extension() != ".svg") {
        throw Error("-o: cannot use \"" + arguments.output + "\"; expected a file name ending in .svg",
                    ExitCode::usage);
    }
    CommandFiles files;
    for (const std::string& path : arguments.reports)
        files.read("REPORT", path);
    files.write("-o", arguments.output);
    std::vector<Curve> curves;
    for (const std::string& path : arguments.reports)
        curves.push_back(read_curve(path));
    write_file_atomically(arguments.output, draw_curves(curves));
    return ExitCode::done;
}

}  // namespace

Command add_plot_command(CLI::App& app) {
    CLI::App* const command = app.add_subcommand("plot", "Draw how errors fell, from reports");
    const auto arguments = std::make_shared<PlotArguments>();
    command
        ->add_option("REPORT", arguments->reports,
                     "Reports of candela render --reference (.json), a curve each")
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
        "Both axes are logarithmic; the legend names the files. A reference must have far more samples, and "
        "another\n"
        "seed: else the error seems to fall too fast.");
    return {command, [arguments] { return run(*arguments); }};
}

}  // namespace candela
