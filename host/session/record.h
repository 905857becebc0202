// The record of a rendering, and the attributes of images that are made from it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "film/identity.h"
#include "gpu_scene/gpu_scene.h"
#include "image/image.h"
#include "render/renderer.h"
#include "scene/scene.h"
#include "session/convergence.h"
#include "session/job.h"
#include "vk/device_info.h"

namespace candela {

// What was rendered, and how it went.
struct RenderRecord {
    std::string command_line{};
    std::string scene_file{};
    std::vector<std::pair<std::string, std::string>> scene_attributes{};  // As Scene::attributes.
    Maker maker{};
    Identity identity{};
    bool adaptive = false;
    Camera camera{};
    RenderSettings settings{};
    ArrayMap array_map{};  // How the scene was read.
    uint32_t primitives = 0;
    uint32_t lights = 0;
    double load_seconds = 0.0;          // Wall time to read the scene file.
    double bvh_seconds = 0.0;           // Wall time to build the BVH.
    double pipeline_seconds = 0.0;      // Wall time to compile kernels, including a first, empty dispatch.
    double pipeline_cpu_seconds = 0.0;  // CPU time of the same in the thread that asks for it.
    uint32_t kernels_compiled = 0;      // Those that no picture before had on this device.
    double render_seconds = 0.0;        // Wall time to render, including before it was resumed.
    double cpu_seconds = 0.0;           // CPU time of the process while rendering, since it was resumed.
    bool complete = false;              // All samples are there, or as many as the target error needs.
    uint32_t spp = 0;                   // Samples that every pixel has; on average if adaptive.
    uint32_t max_spp = 0;               // The largest number that a pixel has.
    uint64_t samples = 0;               // Samples of all pixels together.
    uint64_t resumed_samples = 0;       // The part of `samples` that came from a checkpoint.
    std::optional<double> target_error{};
    std::optional<std::string> reference{};       // The name of its file.
    std::vector<ConvergencePoint> convergence{};  // If a target error or a reference asks for it.
    std::optional<double> estimated_error{};      // The last one known.
    RenderCounters counters{};
    uint32_t device_failures = 0;  // Failures of the device that rendering survived.
    uint64_t device_bytes = 0;
    size_t validation_messages = 0;
};

// The record before rendering begins, from scene and job.
RenderRecord make_record(const Scene& scene, const GpuScene& gpu_scene, const RenderJob& job);
// The same for one of the pictures that share the scene, with hash_arrays() of it.
RenderRecord make_record(const Scene& scene, const GpuScene& gpu_scene, uint64_t arrays_hash,
                         const RenderJob& job);

// This version of candela on a device.
Maker make_maker(const vk::DeviceInfo& device);

// The range of samples that some pixel has, such as "0..64".
std::string samples_text(const RenderRecord& record);

// Adds an image's attributes, from the record: the camera, the samples, their time, maker, identity and
// command line.
void add_attributes(Image& image, const RenderRecord& record);

}  // namespace candela
