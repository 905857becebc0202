// The renderer's kernels as SPIR-V, compiled from shaders/kernels at build time.
#pragma once

#include <cstdint>
#include <span>

namespace candela::kernels {

extern const std::span<const uint32_t> render, position;
extern const std::span<const uint32_t> render_layered;  // For scenes with principled materials.
extern const std::span<const uint32_t> display;         // Reads no scene.

}  // namespace candela::kernels
