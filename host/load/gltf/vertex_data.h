// The accessors of a primitive's vertices and indices, whose elements may be compressed by Draco.
#pragma once

#include <initializer_list>
#include <string_view>

#include "load/gltf/accessor.h"
#include "load/gltf/draco.h"
#include "load/gltf/gltf_file.h"

namespace candela::gltf {

// What Draco holds of a primitive; decoded once for all readings of the file. Null if its accessors have the
// data: those are exact, and are used even if the file has both. Throws Error for data that are damaged.
const DracoMesh* draco_of(File& file, const Node& primitive);

// The accessor of an attribute, which `reference` refers to. Throws Error as Accessor does.
Accessor vertex_accessor(File& file, const Node& primitive, const Node& reference,
                         std::initializer_list<std::string_view> types);

}  // namespace candela::gltf
