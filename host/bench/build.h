// The benchmark of building trees: candela's builder, and Embree's where it is there, on the same boxes.
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

// For displaced_scene()s of options.triangles: the speed of building [Mtriangles/s], by CPU time of all cores
// with that of wall time beside it; the SAH cost (see bvh/measure.h; less is better); and the bytes that a
// triangle takes on a device, smooth normals and all. Embree's medium-quality builder takes turns with ours
// and is measured twice: "finer rival", which splits down to single triangles wherever that lowers the cost,
// at more nodes; and "like leaves", which makes a leaf of any BVH_LEAF_SIZE triangles as ours does.
// Throws Error as build_gpu_scene() does.
std::vector<Row> bench_build(const BenchOptions& options);

// A tree and what building it took.
struct TimedBvh {
    Bvh bvh;
    Clocks clocks;
};

// The tree that rtcBuildBVH makes of `boxes` (at least one) in medium quality with BVH_WIDTH children a node,
// leaves of up to `leaf_size` (1 .. BVH_COUNT_MASK) and the costs of bvh/measure.h, in records of ours, which
// are no part of the time; ranges of up to `whole` primitives are never split. Its depth has no limit. None
// in a program that was built without Embree.
std::optional<TimedBvh> build_with_embree(std::span<const Box> boxes, uint32_t whole, uint32_t leaf_size);

}  // namespace candela
