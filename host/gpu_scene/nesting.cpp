// See nesting.h.
#include "gpu_scene/nesting.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "base/hash.h"
#include "base/text.h"
#include "gpu_scene/material_record.h"
#include "scene/geometry.h"

namespace candela {
namespace {

// Something that encloses a medium.
struct Solid {
    DoubleBox box;
    Interior inside;
    size_t shape;        // The first, of several.
    bool walls = false;  // Quads and disks of one medium: all that are no boxes.
};

// For each shape that is the side of a box, the first side of that box. Quads of one material that share
// corners belong together, and six or more of them are taken for a box.
std::vector<std::optional<size_t>> find_boxes(const Scene& scene) {
    std::vector<size_t> first(scene.shapes.size());
    std::iota(first.begin(), first.end(), size_t(0));
    const auto root_of = [&](size_t i) {
        while (first[i] != i)
            i = first[i] = first[first[i]];
        return i;
    };
    std::map<std::tuple<uint32_t, double, double, double>, size_t> owners;  // Of corners.
    for (size_t i = 0; i < scene.shapes.size(); ++i) {
        const auto* quad = std::get_if<Quad>(&scene.shapes[i].geometry);
        if (quad == nullptr || !interior(scene.materials[scene.shapes[i].material].model)) continue;
        for (const dvec3& c : quad->corners) {
            const auto [owner, is_new] = owners.try_emplace({scene.shapes[i].material, c.x, c.y, c.z}, i);
            const size_t a = root_of(i), b = root_of(owner->second);
            first[std::max(a, b)] = std::min(a, b);
        }
    }
    constexpr size_t SIDES = 6;
    std::vector<size_t> sides(first.size(), 0);
    for (size_t i = 0; i < first.size(); ++i)
        ++sides[root_of(i)];
    std::vector<std::optional<size_t>> boxes(first.size());
    for (size_t i = 0; i < first.size(); ++i) {
        if (sides[root_of(i)] >= SIDES) boxes[i] = root_of(i);
    }
    return boxes;
}

std::vector<Solid> find_solids(const Scene& scene) {
    std::vector<Solid> solids;
    const ShapeBounds bounds_of(scene);
    const std::vector<std::optional<size_t>> boxes = find_boxes(scene);
    std::map<size_t, size_t> known_boxes;  // Solids, by their first sides.
    std::vector<size_t> known_walls;       // Solids, one for each medium.
    for (size_t i = 0; i < scene.shapes.size(); ++i) {
        const Shape& shape = scene.shapes[i];
        const std::optional<Interior> inside = interior(scene.materials[shape.material].model);
        if (!inside) continue;
        const bool wall = !boxes[i] && (std::holds_alternative<Quad>(shape.geometry) ||
                                        std::holds_alternative<Disk>(shape.geometry));
        auto place = solids.end();
        if (wall) {
            const auto known = std::ranges::find_if(
                known_walls, [&](size_t solid) { return solids[solid].inside == *inside; });
            if (known != known_walls.end()) {
                place = solids.begin() + std::ptrdiff_t(*known);
            } else {
                known_walls.push_back(solids.size());
            }
        } else if (boxes[i]) {
            const auto [known, is_new] = known_boxes.try_emplace(*boxes[i], solids.size());
            if (!is_new) place = solids.begin() + std::ptrdiff_t(known->second);
        }
        if (place == solids.end()) place = solids.insert(place, {{}, *inside, i, wall});
        place->box.extend(bounds_of(shape));
    }
    return solids;
}

bool overlap(const DoubleBox& a, const DoubleBox& b) {
    return all(lessThan(max(a.lo, b.lo), min(a.hi, b.hi)));
}

bool contains(const DoubleBox& outer, const DoubleBox& inner) {
    return all(lessThanEqual(outer.lo, inner.lo)) && all(greaterThanEqual(outer.hi, inner.hi));
}

// Calls each(i, j) for each two of the solids, which are sorted by their boxes' least x, whose boxes overlap,
// until it returns false. Gives up, and returns false, where that would take seconds.
template <class Each>
bool for_each_overlap(const std::vector<Solid>& solids, const Each& each) {
    constexpr size_t MOST_LOOKS = size_t(1) << 26;
    size_t looks = 0;
    for (size_t i = 0; i < solids.size(); ++i) {
        for (size_t j = i + 1; j < solids.size() && solids[j].box.lo.x < solids[i].box.hi.x; ++j) {
            if (++looks > MOST_LOOKS) return false;
            if (overlap(solids[i].box, solids[j].box) && !each(i, j)) return true;
        }
    }
    return true;
}

// Whether each edge of each triangle is also that of another one, in the opposite direction; vertices at the
// same place are one. The sum of hashes, each with its sign, is zero then, and otherwise only by a chance of
// 2^-64.
bool is_closed(const TriangleMesh& mesh) {
    uint64_t sum = 0;
    for (const uvec3 t : mesh.triangles) {
        for (const auto& [from, to] : {std::pair(t.x, t.y), std::pair(t.y, t.z), std::pair(t.z, t.x)}) {
            const std::array<vec3, 2> there{mesh.positions[from] + 0.0f,
                                            mesh.positions[to] + 0.0f};  // No -0.
            const std::array<vec3, 2> back{there[1], there[0]};
            sum += hash_words(std::as_bytes(std::span(there)), FNV1A64_BASIS);
            sum -= hash_words(std::as_bytes(std::span(back)), FNV1A64_BASIS);
        }
    }
    return sum == 0;
}

std::string name_of_shape(const Scene& scene, size_t i) {
    const std::string& material = scene.materials[scene.shapes[i].material].name;
    return "shape " + std::to_string(i) + (material.empty() ? "" : concat(" (material \"", material, "\")"));
}

}  // namespace

Nesting find_nesting(const Scene& scene) {
    Nesting result;
    std::vector<Solid> solids = find_solids(scene);
    std::ranges::sort(solids, {}, [](const Solid& solid) { return solid.box.lo.x; });
    if (!for_each_overlap(solids, [&](size_t, size_t) { return !(result.nested = true); }))
        result.nested = true;  // Perhaps; kernels only take longer.

    for (const Solid& solid : solids) {
        const auto* instance = std::get_if<MeshInstance>(&scene.shapes[solid.shape].geometry);
        if (instance == nullptr || !(result.nested || solid.inside.medium != Medium{})) continue;
        if (!is_closed(scene.meshes[instance->mesh])) {
            result.warnings.push_back(name_of_shape(scene, solid.shape) +
                                      ": the mesh is not closed, so that rays may leave the medium inside "
                                      "without passing its surface, and "
                                      "stay in it; close the mesh");
        }
    }

    std::vector<uint32_t> around(solids.size(), 1);  // How many solids' boxes contain each, itself included.
    for_each_overlap(solids, [&](size_t i, size_t j) {
        around[i] += contains(solids[j].box, solids[i].box);
        around[j] += contains(solids[i].box, solids[j].box);
        return true;
    });
    const auto most = std::ranges::max_element(around);
    if (most != around.end() && *most > MEDIA_AT_ONCE) {
        result.warnings.push_back(
            concat(name_of_shape(scene, solids[size_t(most - around.begin())].shape), " may lie within ",
                   *most - 1, " other solids; a path keeps ", MEDIA_AT_ONCE,
                   " media in mind, and forgets the one with the lowest priority that it entered first"));
    }
    return result;
}

}  // namespace candela
