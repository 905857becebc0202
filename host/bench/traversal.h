// The benchmark of rays alone: candela's traversal, and Embree's if the program has it, on the same rays.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bench/options.h"
#include "bench/report.h"
#include "bench/tracer.h"
#include "vk/device.h"

namespace candela {

// Speed [Mrays/s] of primary rays, first and second bounce and shadow rays (see rays.h) in the Cornell box
// and in displaced_scene()s of options.triangles, and how many in a million rays have a different hit in
// Embree. The two tracers take turns. On a CPU device both speeds are by CPU time of all cores, with speeds
// by wall time beside them; on a GPU both are by wall time. Throws Error as build_gpu_scene() and
// map_arrays() do, and if the two tracers disagree.
std::vector<Row> bench_traversal(const vk::Device& device, const BenchOptions& options);

// The same, with Embree's own instances, in a forest_scene() of options.trees, and its bytes on the device;
// then the time to make the records of a scattered_scene() of options.instances, in seconds, and their size,
// in bytes per instance.
std::vector<Row> bench_instances(const vk::Device& device, const BenchOptions& options);

// The row of one set: the two take turns, `runs` times, after each has traced the set twice to warm up. A run
// repeats the set for about a tenth of a second. `rival` may be null.
Row time_rays(const std::string& subject, const RaySet& set, RayTracer& ours, RayTracer* rival, uint32_t runs,
              bool by_cpu_time);

// Throws Error if `differing`, the number of rays that have different hits in the two tracers, is above 1 +
// `rays` / 1000. Rays that graze edges do not explain so many, and comparing speeds would be meaningless.
// `what` names the set in the message.
void check_same_hits(const std::string& what, size_t differing, size_t rays);

}  // namespace candela
