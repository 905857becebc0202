// The renderer's kernels as SPIR-V, compiled from shaders/kernels at build time. NAME reads the scene through
// texel buffers, NAME_storage through storage buffers.
#pragma once

#include <cstdint>
#include <span>

namespace candela::kernels {

extern const std::span<const uint32_t> render;
extern const std::span<const uint32_t> render_storage;
extern const std::span<const uint32_t> position;
extern const std::span<const uint32_t> position_storage;
extern const std::span<const uint32_t> display;  // Reads no scene.

}  // namespace candela::kernels
