// See first_pixel.h.
#include "bench/first_pixel.h"

#include <system_error>

#include "base/error.h"
#include "base/file.h"
#include "base/temporary_folder.h"
#include "base/text.h"
#include "bench/clocks.h"
#include "os/process.h"
#include "probe/embedded.h"

namespace candela {
namespace {

// Runs a program to its end; it must succeed.
Clocks run_program(const std::vector<std::string>& words, const std::vector<std::string>& variables) {
    const Stopwatch watch;
    os::ProgramEnd end;
    try {
        end = os::run_program({.words = words, .variables = variables, .output = std::nullopt});
    } catch (const std::system_error& error) {
        throw Error("cannot start " + words[0] + ": " + error.code().message());
    }
    const double wall = watch.elapsed().wall;
    if (!end.succeeded()) {
        std::string call;
        for (const std::string& word : words)
            call += (call.empty() ? "" : " ") + word;
        throw Error(concat("first-pixel: `", call, "` ", end.exited ? "exited with " : "was ended by signal ",
                           end.code, "; see its messages above"));
    }
    return {end.cpu_seconds, wall};
}

}  // namespace

std::vector<Row> bench_first_pixel(const BenchOptions& options, const std::filesystem::path& program,
                                   const std::optional<std::filesystem::path>& scene_file,
                                   const std::optional<std::string>& device) {
    const std::string name = scene_file ? scene_file->string() : "Cornell box";
    options.progress("first-pixel: " + name);
    const TemporaryFolder scratch("first-pixel");
    const std::filesystem::path file = scene_file.value_or(scratch.path() / "cornell-box.json");
    if (!scene_file) write_file_atomically(file, embedded::cornell_box_json);
    std::vector<std::string> call{
        program.string(), "render", file.string(), "--spp", "1",
        "--size",         "64x64",  "--quiet",     "-o",    (scratch.path() / "first.png").string()};
    if (device) call.insert(call.end(), {"--device", *device});
    const std::vector<std::string> cold{"CANDELA_NO_CACHE=1", "MESA_SHADER_CACHE_DISABLE=true"};
    const std::vector<std::string> warm{"XDG_CACHE_HOME=" + scratch.path().string()};
    run_program(call, warm);  // Fills the caches.

    std::vector<Row> rows;
    rows.push_back({.subject = name, .what = "first image, cold", .unit = "s"});
    rows.push_back({.subject = name, .what = "first image, warm", .unit = "s"});
    for (uint32_t run = 0; run < options.runs; ++run) {
        for (Row& row : rows) {
            const Clocks clocks = run_program(call, &row == &rows[0] ? cold : warm);
            row.ours.push_back(clocks.cpu);
            row.ours_wall.push_back(clocks.wall);
        }
    }
    return rows;
}

}  // namespace candela
