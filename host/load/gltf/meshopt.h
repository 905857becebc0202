// Views of buffers that meshoptimizer has compressed: EXT_meshopt_compression, and streams of
// KHR_meshopt_compression that the library knows.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "load/gltf/gltf_file.h"

namespace candela::gltf {

// The extension of a bufferView or a buffer, by either name.
std::optional<Node> meshopt_of(const Node& element);

struct DecodedBytes {
    std::shared_ptr<const std::byte[]> first{};
    size_t count = 0;
};

// The bytes of a view that has this extension, from the `compressed` bytes. Throws Error if they are damaged,
// are of another version, or do not give as many bytes as the view has.
DecodedBytes decode_meshopt(const Node& view, const Node& extension, std::span<const std::byte> compressed);

}  // namespace candela::gltf
