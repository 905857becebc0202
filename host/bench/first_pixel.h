// The benchmark of the shortest possible rendering: from the start of the program to an image on disk.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/options.h"
#include "bench/report.h"

namespace candela {

// CPU time and wall time [s] of `program render SCENE_FILE --spp 1` at 64x64 pixels, the whole process: cold,
// with neither our cache of compiled kernels nor Mesa's, and warm, when it has run before. `program` is
// candela's executable; without a `scene_file` it renders the Cornell box; `device` is the value of --device.
// CPU time is the process's, even on a GPU, where wall time matters. Throws Error if the program cannot be
// started or fails; it prints the reason itself on stderr.
std::vector<Row> bench_first_pixel(const BenchOptions& options, const std::filesystem::path& program,
                                   const std::optional<std::filesystem::path>& scene_file,
                                   const std::optional<std::string>& device);

}  // namespace candela
