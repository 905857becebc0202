// See primitive_triangles.h.
#include "load/gltf/primitive_triangles.h"

#include <algorithm>

#include "base/text.h"
#include "load/gltf/accessor.h"
#include "load/gltf/vertex_data.h"

namespace candela::gltf {
namespace {

// The indices of all corners, or 0, 1, 2 ... if the primitive has none. Each is below `vertices`.
std::vector<uint32_t> read_corners(File& file, const Node& primitive, uint32_t vertices) {
    const auto reference = primitive.find("indices");
    if (!reference) {
        std::vector<uint32_t> corners(vertices);
        for (uint32_t i = 0; i < vertices; ++i)
            corners[i] = i;
        return corners;
    }
    const Accessor accessor(file, *reference, {"SCALAR"});
    std::vector<uint32_t> corners = accessor.integers();
    const auto wrong = std::ranges::find_if(corners, [&](uint32_t i) { return i >= vertices; });
    if (wrong != corners.end()) {
        accessor.node().fail(concat("index ", wrong - corners.begin(), " is ", *wrong,
                                    ", but the primitive's vertices are 0 to ", vertices - 1,
                                    "; is the file damaged?"));
    }
    const uint32_t restart = accessor.component() == Component::uint8    ? UINT8_MAX
                             : accessor.component() == Component::uint16 ? UINT16_MAX
                                                                         : UINT32_MAX;
    const auto odd = std::ranges::find(corners, restart);
    if (odd != corners.end()) {
        file.warn(accessor.node(), concat("index ", odd - corners.begin(), " is ", restart,
                                          ", which may restart a strip elsewhere; here it is a vertex"));
    }
    return corners;
}

std::vector<uvec3> triangles_of(const std::vector<uint32_t>& corners, uint32_t mode) {
    std::vector<uvec3> triangles;
    if (corners.size() < 3) return triangles;
    if (mode == MODE_TRIANGLES) {
        triangles.reserve(corners.size() / 3);
        for (size_t i = 0; i + 3 <= corners.size(); i += 3)
            triangles.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
        return triangles;
    }
    triangles.reserve(corners.size() - 2);
    for (size_t i = 0; i + 3 <= corners.size(); ++i) {
        if (mode == MODE_TRIANGLE_FAN) {
            triangles.emplace_back(corners[i + 1], corners[i + 2], corners[0]);
        } else {
            triangles.emplace_back(corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]);
        }
    }
    return triangles;
}

}  // namespace

uint32_t mode_of(const Node& primitive) {
    const auto mode = primitive.find("mode");
    return mode ? mode->integer(0, MODE_TRIANGLE_FAN) : MODE_TRIANGLES;
}

std::vector<uvec3> read_triangles(File& file, const Node& primitive, uint32_t mode, uint32_t vertices) {
    if (const DracoMesh* mesh = draco_of(file, primitive)) return triangles_of(mesh->corners, MODE_TRIANGLES);
    return triangles_of(read_corners(file, primitive, vertices), mode);
}

std::vector<uint32_t> keep_used(std::vector<uvec3>& triangles, uint32_t vertices) {
    constexpr uint32_t UNUSED = UINT32_MAX;
    std::vector<uint32_t> number(vertices, UNUSED);
    for (const uvec3 t : triangles) {
        for (glm::length_t i = 0; i < 3; ++i)
            number[t[i]] = 0;
    }
    std::vector<uint32_t> rows;
    for (uint32_t i = 0; i < vertices; ++i) {
        if (number[i] == UNUSED) continue;
        number[i] = uint32_t(rows.size());
        rows.push_back(i);
    }
    for (uvec3& t : triangles)
        t = {number[t.x], number[t.y], number[t.z]};
    return rows;
}

}  // namespace candela::gltf
