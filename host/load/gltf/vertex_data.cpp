// Ref: Khronos, "KHR_draco_mesh_compression".
#include "load/gltf/vertex_data.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/memory_limit.h"
#include "base/text.h"
#include "load/gltf/primitive_triangles.h"
#include "load/gltf/values.h"

namespace candela::gltf {
namespace {

constexpr const char* EXTENSION = "KHR_draco_mesh_compression";

// Whether an accessor that the compressed data stand for has no data of its own.
bool needs_draco(const File& file, const Node& primitive, const Node& extension) {
    const auto lacks_data = [&](const Node& reference) {
        return !file.resolve("accessors", reference).find("bufferView");
    };
    const auto indices = primitive.find("indices");
    if (indices && lacks_data(*indices)) return true;
    const auto attributes = primitive.find("attributes");
    const auto compressed = extension.find("attributes");
    if (!attributes || !compressed) return false;
    for (const Node& id : compressed->members()) {
        const auto reference = attributes->find(id.key());
        if (reference && lacks_data(*reference)) return true;
    }
    return false;
}

AccessorType accessor_type(File& file, const Node& reference, std::initializer_list<std::string_view> types) {
    return read_accessor_type(file, file.resolve("accessors", reference), types);
}

DracoLimits limits_of(File& file, const Node& primitive) {
    const uint32_t mode = mode_of(primitive);
    if (mode > MODE_TRIANGLE_STRIP)
        primitive.require("mode").fail("Draco holds triangles or strips, and no fans; export the file again");
    const auto indices = primitive.find("indices");
    if (!indices)
        primitive.fail(concat("a primitive with ", EXTENSION, " needs indices; export the file again"));
    const uint32_t corners = accessor_type(file, *indices, {"SCALAR"}).count;
    const Node position = primitive.require("attributes").require("POSITION");
    // A strip is stored as its triangles.
    return {accessor_type(file, position, {"VEC3"}).count, mode == MODE_TRIANGLES ? corners / 3 : corners};
}

DracoMesh decode_primitive(File& file, const Node& primitive, const Node& extension) {
    const DracoLimits limits = limits_of(file, primitive);
    const Node attributes = primitive.require("attributes");
    std::vector<DracoAttribute> wanted;
    for (const Node& id : extension.require("attributes").members()) {
        const auto reference = attributes.find(id.key());
        if (!reference) continue;
        const AccessorType type = accessor_type(file, *reference, {"SCALAR", "VEC2", "VEC3", "VEC4"});
        wanted.push_back({std::string(id.key()), id.integer(0, UINT32_MAX), type.component, type.width});
    }
    const auto bytes = file.view_bytes(file.resolve("bufferViews", extension.require("bufferView")));
    return with_memory_for(
        "the mesh that Draco has compressed", [&] { return extension.place(); },
        [&] { return decode_draco(extension, bytes, limits, wanted); });
}

size_t size_of(const DracoMesh& mesh) {
    size_t size = mesh.corners.size() * sizeof mesh.corners[0];
    for (const auto& [name, bytes] : mesh.attributes)
        size += bytes.size();
    return size;
}

}  // namespace

const DracoMesh* draco_of(File& file, const Node& primitive) {
    const auto extension = extension_of(primitive, EXTENSION);
    if (!extension || !needs_draco(file, primitive, *extension)) return nullptr;
    const std::string place = extension->place();
    const DracoMesh& mesh = file.contents().keep(
        "mesh of " + place, [&] { return decode_primitive(file, primitive, *extension); });
    file.count_decoded(place, size_of(mesh));
    const DracoLimits limits = limits_of(file, primitive);
    const bool is_strip = mode_of(primitive) != MODE_TRIANGLES;
    if (mesh.vertices < limits.vertices || (!is_strip && mesh.corners.size() / 3 < limits.triangles)) {
        file.warn(*extension,
                  concat("the data hold ", mesh.vertices, " vertices and ", mesh.corners.size() / 3,
                         " triangles, fewer than the primitive's accessors, which state ", limits.vertices,
                         " and ", limits.triangles));
    }
    return &mesh;
}

Accessor vertex_accessor(File& file, const Node& primitive, const Node& reference,
                         std::initializer_list<std::string_view> types) {
    if (const DracoMesh* mesh = draco_of(file, primitive)) {
        const auto found = mesh->attributes.find(reference.key());
        if (found != mesh->attributes.end()) return Accessor(file, reference, types, found->second);
    }
    return Accessor(file, reference, types);
}

}  // namespace candela::gltf
