// The benchmark of building trees: candela's builder, and Embree's if the program has it, on the same boxes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bench/clocks.h"
#include "bench/options.h"
#include "bench/report.h"
#include "bvh/bvh.h"

namespace candela {

// For displaced_scene()s of options.triangles, whose triangles are paired first: the speed of pairing and
// building, compared with Embree's over the triangles themselves [Mtriangles/s]; the speed of both builders
// over the pairs, and the SAH cost of these trees (see bvh/measure.h; less is better); and the bytes of a
// triangle on a device, including smooth normals. Speeds are by CPU time of all cores, with speeds by wall
// time beside them. Embree's medium-quality builder takes turns with ours. Throws Error as build_gpu_scene()
// does.
std::vector<Row> bench_build(const BenchOptions& options);

// A tree and the time to build it.
struct TimedBvh {
    Bvh bvh;
    Clocks clocks;
};

// The tree that rtcBuildBVH makes of `boxes` (at least one) in medium quality, with BVH_WIDTH children per
// node, one primitive per leaf and the costs of bvh/measure.h, converted to our records. The conversion is
// not timed. Its depth has no limit. Nothing if the program was built without Embree.
std::optional<TimedBvh> build_with_embree(std::span<const Box> boxes);

}  // namespace candela
