// Views of buffers that meshoptimizer has compressed: EXT_meshopt_compression, and streams of
// KHR_meshopt_compression that the library knows.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "load/gltf/gltf_file.h"

namespace candela::gltf {

// The extension of a bufferView or a buffer, by either name.
std::optional<Node> meshopt_of(const Node& element);

// The bytes of a view that has this extension, from the `compressed` bytes. Throws Error if they are damaged,
// are of another version, or do not give as many bytes as the view has.
std::vector<std::byte> decode_meshopt(const Node& view, const Node& extension,
                                      std::span<const std::byte> compressed);

}  // namespace candela::gltf
