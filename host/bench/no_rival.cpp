// The rivals of `candela bench` if the program is built without them: tests/bench/rivals has them.
#ifndef CANDELA_EMBREE

#include "bench/build.h"
#include "bench/tracer.h"

namespace candela {

std::unique_ptr<RayTracer> make_embree_tracer(const BenchTriangles&) {
    return nullptr;
}

std::optional<std::string> embree_version() {
    return std::nullopt;
}

std::optional<TimedBvh> build_with_embree(std::span<const Box>) {
    return std::nullopt;
}

}  // namespace candela

#endif
