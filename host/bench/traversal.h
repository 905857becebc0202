// The benchmark of rays alone: candela's traversal, and Embree's where it is there, on the same rays.
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
// and in displaced_scene()s of options.triangles, and how many in a million rays have another hit by Embree.
// The two tracers take turns. On a CPU device ours is a speed of CPU time of all cores, with that of wall
// time beside it, as the rival's is; on a GPU both are of wall time. Throws Error as build_gpu_scene() and
// map_arrays() do, and if the two tracers disagree.
std::vector<Row> bench_traversal(const vk::Device& device, const BenchOptions& options);

// The row of one set: the two take turns, `runs` times, after each has traced the set twice to warm up. A run
// traces it again and again until a tenth of a second has passed. `rival` may be null.
Row time_rays(const std::string& subject, const RaySet& set, RayTracer& ours, RayTracer* rival, uint32_t runs,
              bool by_cpu_time);

// Throws Error if more than one ray in a thousand, of `rays`, and one more have another hit by one tracer
// than by the other: more than grazing an edge explains, so that a comparison of speeds would mean nothing.
// `what` is the set, for the message.
void check_same_hits(const std::string& what, size_t differing, size_t rays);

}  // namespace candela
