// Declares the options of `candela bench`.
#include "cli/bench_options.h"

#include <algorithm>

namespace candela {
namespace {

constexpr uint32_t MAX_RUNS = 1000;
constexpr uint32_t MIN_RAYS = 64, MAX_CAMERA_RAYS = 1u << 24;
constexpr uint32_t MIN_TRIANGLES = 72, MAX_TRIANGLES = 100'000'000;
constexpr uint32_t MAX_TREES = 40'000;  // 4 G triangles: ids have 32 bits.
constexpr uint32_t MIN_INSTANCES = 2'000, MAX_INSTANCES = 10'000'000;

// The values of a comma-separated list, if parse() accepts all of them.
template <class T>
std::optional<std::vector<T>> parse_list(const std::string& text,
                                         std::optional<T> (*parse)(const std::string&)) {
    std::vector<T> values;
    for (const std::string& part : split(text, ',')) {
        const std::optional<T> value = parse(part);
        if (!value) return std::nullopt;
        values.push_back(*value);
    }
    return values;
}

std::optional<BenchGroup> parse_group(const std::string& text) {
    const auto* const found =
        std::ranges::find(BENCH_GROUP_NAMES, text, &std::pair<std::string_view, BenchGroup>::first);
    return found == BENCH_GROUP_NAMES.end() ? std::nullopt : std::optional(found->second);
}

// "190000", "190k" or "1M".
std::optional<uint32_t> parse_triangles(const std::string& text) {
    const char unit = text.empty() ? '\0' : text.back();
    const uint32_t scale = unit == 'k' ? 1000 : unit == 'M' ? 1'000'000 : 1;
    const std::string digits = scale == 1 ? text : text.substr(0, text.size() - 1);
    const auto count = parse_uint(digits, 0, MAX_TRIANGLES / scale);
    return count && *count * scale >= MIN_TRIANGLES ? std::optional(*count * scale) : std::nullopt;
}

}  // namespace

void BenchArguments::add_to(CLI::App& app) {
    app.add_option("SCENE", scenes, "Scene files to render (default: the Cornell box)")->type_name("");
    app.option_defaults()->take_last();
    add_value(
        app, "--only", only, [](const std::string& text) { return parse_list(text, parse_group); },
        "a list of traversal, instances, build, render and first-pixel",
        "What to measure: a list (default: all)")
        ->type_name("traversal,instances,build,render,first-pixel");
    add_value(
        app, "--runs", bench.runs, [](const std::string& text) { return parse_uint(text, 1, MAX_RUNS); },
        "a whole number from 1 to 1000", "Runs of everything (default: 5)")
        ->type_name("N");
    app.add_option("--json", json,
                   "Write each run as JSON; - writes it to standard output, instead of the table")
        ->type_name("FILE|-");
    app.option_defaults()->group("Traversal, instances and build");
    add_value(
        app, "--triangles", bench.triangles,
        [](const std::string& text) { return parse_list(text, parse_triangles); },
        "a list of numbers such as 190k, 1M, 10M, each from 72 to 100M",
        "Approximate sizes of the meshes (default: 190k,1M)")
        ->type_name("N,...");
    add_value(
        app, "--trees", bench.trees, [](const std::string& text) { return parse_uint(text, 1, MAX_TREES); },
        "a whole number from 1 to 40000", "Instances of trees in the forest (default: 10000)")
        ->type_name("N");
    add_value(
        app, "--instances", bench.instances,
        [](const std::string& text) { return parse_uint(text, MIN_INSTANCES, MAX_INSTANCES); },
        "a whole number from 2000 to 10000000", "Instances of a small mesh to build (default: 1000000)")
        ->type_name("N");
    add_value(
        app, "--rays", bench.rays,
        [](const std::string& text) { return parse_uint(text, MIN_RAYS, MAX_CAMERA_RAYS); },
        "a whole number from 64 to 16777216", "Approximate number of camera rays (default: 1048576)")
        ->type_name("N");
    app.option_defaults()->group("Render");
    add_value(app, "--seconds", seconds, parse_duration, "a duration such as 5, 5s or 1.5m",
              "Length of a run: CPU time per core, or a GPU's own time (default: 3 unless --spp is given)")
        ->type_name("TIME");
    app.add_option("--reference", reference, "Converged image of the one scene, to report the relMSE as well")
        ->type_name("FILE.exr");
    rendering.add_to(app);
}

}  // namespace candela
