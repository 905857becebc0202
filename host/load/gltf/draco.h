// Meshes that Draco has compressed (KHR_draco_mesh_compression): all that comes out is checked as if it stood
// in the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "load/gltf/accessor.h"
#include "load/gltf/gltf_file.h"

namespace candela::gltf {

// An attribute to be decoded: the elements of an accessor.
struct DracoAttribute {
    std::string name;
    uint32_t id = 0;  // Within the compressed data.
    Component component = Component::float32;
    uint32_t width = 0;
};

struct DracoMesh {
    uint32_t vertices = 0;
    std::vector<uint32_t> corners;  // Of triangles; each below `vertices`.
    // By name, the elements of an accessor, one after the other.
    std::map<std::string, std::vector<std::byte>, std::less<>> attributes{};
};

// The most that the data may hold, by the file's accessors.
struct DracoLimits {
    uint32_t vertices = 0;
    uint32_t triangles = 0;
};

// Decodes a mesh. Throws Error at `place` if the data are damaged, hold more than these limits allow, or lack
// one of these attributes.
DracoMesh decode_draco(const Node& place, std::span<const std::byte> bytes, const DracoLimits& limits,
                       const std::vector<DracoAttribute>& attributes);

}  // namespace candela::gltf
