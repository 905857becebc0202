// RayTracer: traces a set of rays and measures the time, with candela's kernels or with the rival.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/clocks.h"
#include "bench/rays.h"
#include "gpu_scene/gpu_scene.h"
#include "render/renderer.h"
#include "vk/device.h"

namespace candela {

class RayTracer {
  public:
    RayTracer() = default;
    RayTracer(const RayTracer&) = delete;
    RayTracer& operator=(const RayTracer&) = delete;
    virtual ~RayTracer() = default;

    // Prepares for tracing that set, which must live until the next call of prepare().
    virtual void prepare(const RaySet& set) = 0;
    // Traces all rays of the set `repeats` times, on the whole device, and returns how long that took.
    virtual Clocks trace(uint32_t repeats) = 0;
    // The results of the last trace(), one per ray: a triangle's id, ANY_HIT or NO_TRIANGLE, as rays.h says.
    virtual std::vector<uint32_t> results() const = 0;
};

// The kernels closest_hit and any_hit of shaders/probes on a scene's records, one ray per invocation. A
// dispatch has as many rays as the device allows, but at most `batch`. Wall time is by the device's clock if
// it has one. `device` must outlive the tracer.
std::unique_ptr<RayTracer> make_device_tracer(const vk::Device& device, const GpuScene& scene,
                                              SceneAccess access, size_t batch = SIZE_MAX);

// Embree's rtcIntersect1 and rtcOccluded1 on triangles and its own instances of meshes, on all cores; null if
// the program was built without Embree. `triangles` must outlive the tracer.
std::unique_ptr<RayTracer> make_embree_tracer(const BenchTriangles& triangles);

// "Embree 3.13.5"; none if the program was built without it.
std::optional<std::string> embree_version();

}  // namespace candela
