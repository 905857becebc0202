// The files that a rendering leaves behind, and the figures that go into them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/image.h"
#include "cli/render_options.h"
#include "film/identity.h"
#include "render/renderer.h"
#include "session/convergence.h"

namespace candela {

// What a rendering was and how it went.
struct RenderRecord {
    std::string command_line;
    std::string scene_file;
    std::vector<std::pair<std::string, std::string>> scene_attributes{};  // As Scene::attributes.
    Maker maker{};
    Identity identity{};
    bool adaptive = false;
    Camera camera{};
    RenderSettings settings{};
    ArrayMap array_map{};  // How the scene was read.
    uint32_t primitives = 0;
    uint32_t lights = 0;
    double load_seconds = 0.0;      // Wall times: reading the scene file ...
    double bvh_seconds = 0.0;       // ... building the BVH ...
    double pipeline_seconds = 0.0;  // ... compiling kernels, an empty first dispatch included ...
    double render_seconds = 0.0;    // ... and rendering, including before it was resumed.
    double cpu_seconds = 0.0;       // CPU time of the process while rendering, since it was resumed.
    bool complete = false;          // All samples are there, or as many as the target error needs.
    uint32_t spp = 0;               // Samples that every pixel holds at least; on average if adaptive.
    uint32_t most_spp = 0;          // And the most that one holds.
    uint64_t samples = 0;           // Samples of all pixels together ...
    uint64_t resumed_samples = 0;   // ... and those of them that a checkpoint brought.
    std::optional<double> target_error{};
    std::optional<std::string> reference{};       // The name of its file.
    std::vector<ConvergencePoint> convergence{};  // If a target error or a reference asks for it.
    std::optional<double> estimated_error{};      // The last one known.
    RenderCounters counters{};
    uint32_t device_failures = 0;  // That were survived.
    uint64_t device_bytes = 0;
    uint64_t image_hash = 0;
    size_t validation_messages = 0;
};

// Throws Error if an output is missing, has an unknown extension (both: usage) or could not be written. Call
// it before any long work.
void check_outputs(const ImageOutputs& outputs);
// Throws Error if the report could not be written.
void check_report(const std::optional<std::string>& file);

// Adds an image's attributes, from the record: the camera, the samples, their time, maker, identity and
// command line.
void add_attributes(Image& image, const RenderRecord& record);

// Writes all images, as finished work. If one fails, still writes the others, and then throws the Error.
void write_images(const ImageOutputs& outputs, Image image);

// Writes all images, with attributes, during a rendering. A failure is a warning: the file keeps its old
// contents.
void write_current_images(const ImageOutputs& outputs, const RenderRecord& record, Image image);

// Writes all images, with attributes, and the report, if a file is given, as finished work. If one fails,
// still writes the others, and then throws the Error.
void write_outputs(const ImageOutputs& outputs, const std::optional<std::string>& report,
                   const RenderRecord& record, Image image);

}  // namespace candela
