// The renderer's kernels as SPIR-V, compiled from shaders/kernels at build time.
#pragma once

#include <cstdint>
#include <span>

namespace candela::kernels {

extern const std::span<const uint32_t> render, position, first_hits, first_points;
extern const std::span<const uint32_t> render_layered;  // For scenes with principled materials.
// The same with all functions inlined: lavapipe compiles them in half the time, but other compilers keep more
// values alive.
extern const std::span<const uint32_t> render_inlined, render_layered_inlined;
extern const std::span<const uint32_t> display;  // Reads no scene.
extern const std::span<const uint32_t> denoise;  // Neither does this.

}  // namespace candela::kernels
