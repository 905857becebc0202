// Which triangles a glTF primitive has, and which vertices they use.
#pragma once

#include <cstdint>
#include <vector>

#include "load/gltf/gltf_file.h"

namespace candela::gltf {

// Modes of primitives; those below show no surface.
inline constexpr uint32_t MODE_TRIANGLES = 4;
inline constexpr uint32_t MODE_TRIANGLE_STRIP = 5;
inline constexpr uint32_t MODE_TRIANGLE_FAN = 6;  // The last.

uint32_t mode_of(const Node& primitive);

// The triangles of a primitive of that mode, all of whose corners are below `vertices`. Throws Error for
// indices that are not.
std::vector<uvec3> read_triangles(File& file, const Node& primitive, uint32_t mode, uint32_t vertices);

// Renumbers the vertices of triangles so that only used ones remain; returns the old number of each.
std::vector<uint32_t> keep_used(std::vector<uvec3>& triangles, uint32_t vertices);

}  // namespace candela::gltf
