// The first bytes of a mesh that Draco has compressed: how much it claims to hold, before anything is
// decoded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace candela::gltf {

struct DracoHeader {
    uint32_t faces = 0;
    uint32_t vertices = 0;  // At most as many as there are; those at one place may be counted once.
};

// Reads them. If they are not those of a mesh in version 2.2 of the format, which is glTF's, `problem` says
// why not.
std::optional<DracoHeader> read_draco_header(std::span<const std::byte> bytes, std::string& problem);

}  // namespace candela::gltf
