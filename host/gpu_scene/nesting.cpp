// See nesting.h.
#include "gpu_scene/nesting.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>
#include <vector>

#include "base/text.h"
#include "gpu_scene/material_arrays.h"
#include "gpu_scene/material_record.h"
#include "gpu_scene/mesh_solids.h"
#include "scene/geometry.h"

namespace candela {
namespace {

// A solid that encloses a medium.
struct Solid {
    DoubleBox box;
    Interior inside;
    size_t shape;        // The first, of several.
    bool walls = false;  // The quads and disks of one medium that do not form a box.
    // For a box, twice its volume and its surface.
    double volume2 = 0.0, area = 0.0;
};

// The parts of the meshes that enclose media, by mesh.
using MeshSolids = std::map<uint32_t, std::vector<MeshSolid>>;

// For each shape that is the side of a box, the first side of that box. Quads of one material that share
// corners belong together, and six or more of them are treated as a box.
std::vector<std::optional<size_t>> find_boxes(const Scene& scene) {
    std::vector<size_t> first(scene.shapes.size());
    std::iota(first.begin(), first.end(), size_t(0));
    const auto root_of = [&](size_t i) {
        while (first[i] != i)
            i = first[i] = first[first[i]];
        return i;
    };
    std::map<std::tuple<uint32_t, double, double, double>, size_t> owners;  // First side at each corner.
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
    std::map<size_t, size_t> known_boxes;  // Boxes among the solids, by their first sides.
    std::vector<size_t> known_walls;       // Walls among the solids, one for each medium.
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
        if (!boxes[i]) continue;
        const auto& c = std::get<Quad>(shape.geometry).corners;
        const dvec3 start = std::get<Quad>(scene.shapes[place->shape].geometry).corners[0];
        const dvec3 area = 0.5 * glm::cross(c[2] - c[0], c[3] - c[1]);
        place->volume2 += 2.0 / 3.0 * dot(c[0] - start, area);
        place->area += length(area);
    }
    return solids;
}

// The least thickness of a mesh's parts: volume over half the surface, as for a pane.
double min_thickness(const TriangleMesh& mesh, const std::vector<MeshSolid>& parts,
                     const Transform& transform) {
    double min = std::numeric_limits<double>::infinity();
    for (const MeshSolid& part : parts) {
        if (!part.closed) continue;
        double area = 0.0;
        for (const uint32_t i : part.triangles) {
            const uvec3 t = mesh.triangles[i];
            const dvec3 a(mesh.positions[t.x]);
            area += 0.5 * length(glm::cross(transform.vector(dvec3(mesh.positions[t.y]) - a),
                                            transform.vector(dvec3(mesh.positions[t.z]) - a)));
        }
        const double volume = std::abs(part.volume * determinant(transform.linear()));
        if (area > 0.0) min = std::min(min, 2.0 * volume / area);
    }
    return min;
}

double thickness(const Scene& scene, const Solid& solid, const MeshSolids& parts) {
    const auto* instance = std::get_if<MeshInstance>(&scene.shapes[solid.shape].geometry);
    if (instance != nullptr)
        return min_thickness(scene.meshes[instance->mesh], parts.at(instance->mesh), instance->transform);
    return solid.area > 0.0 ? std::abs(solid.volume2) / solid.area : std::numeric_limits<double>::infinity();
}

// The extent of the scene and its cameras.
double reach_of(const Scene& scene) {
    DoubleBox box = bounds(scene);
    for (const Camera& camera : scene.cameras)
        box.extend(camera.position);
    const dvec3 extent = box.extent();
    return std::max({extent.x, extent.y, extent.z});
}

bool overlap(const DoubleBox& a, const DoubleBox& b) {
    return all(lessThan(max(a.lo, b.lo), min(a.hi, b.hi)));
}

bool contains(const DoubleBox& outer, const DoubleBox& inner) {
    return all(lessThanEqual(outer.lo, inner.lo)) && all(greaterThanEqual(outer.hi, inner.hi));
}

// Calls each(i, j) for every two solids whose boxes overlap, until it returns false. The solids are sorted by
// the least x of their boxes. Gives up, and returns false, if that would take seconds.
template <class Each>
bool for_each_overlap(const std::vector<Solid>& solids, const Each& each) {
    constexpr size_t MAX_LOOKS = size_t(1) << 26;
    size_t looks = 0;
    for (size_t i = 0; i < solids.size(); ++i) {
        for (size_t j = i + 1; j < solids.size() && solids[j].box.lo.x < solids[i].box.hi.x; ++j) {
            if (++looks > MAX_LOOKS) return false;
            if (overlap(solids[i].box, solids[j].box) && !each(i, j)) return true;
        }
    }
    return true;
}

MeshSolids find_parts(const Scene& scene, const std::vector<Solid>& solids) {
    MeshSolids parts;
    for (const Solid& solid : solids) {
        const auto* instance = std::get_if<MeshInstance>(&scene.shapes[solid.shape].geometry);
        if (instance != nullptr && !parts.contains(instance->mesh))
            parts[instance->mesh] = find_mesh_solids(scene.meshes[instance->mesh]);
    }
    return parts;
}

// Whether closed parts of a mesh, other than cavities, have boxes that overlap; also true if there are too
// many parts to find out quickly.
bool parts_overlap(const std::vector<MeshSolid>& parts) {
    constexpr uint64_t MAX_PAIRS = 1u << 24u;
    std::vector<Box> boxes;
    for (const MeshSolid& part : parts) {
        if (part.closed && part.volume > 0.0) boxes.push_back(part.box);
    }
    std::ranges::sort(boxes, {}, [](const Box& box) { return box.lo.x; });
    uint64_t pairs = 0;
    for (size_t i = 0; i < boxes.size(); ++i) {
        for (size_t j = i + 1; j < boxes.size() && boxes[j].lo.x < boxes[i].hi.x; ++j) {
            const bool apart =
                glm::any(glm::greaterThanEqual(max(boxes[i].lo, boxes[j].lo), min(boxes[i].hi, boxes[j].hi)));
            if (!apart || ++pairs > MAX_PAIRS) return true;
        }
    }
    return false;
}

// Finds solids that are so thin that rays from across the scene may miss a side of them. Returns the warning
// about them, if there are any.
std::optional<std::string> warn_of_thin(const Scene& scene, const std::vector<Solid>& solids,
                                        const MeshSolids& parts) {
    constexpr double STEPS = 16.0;
    const double reach = reach_of(scene);
    const Solid* thinnest = nullptr;
    double min = STEPS * 0x1p-23 * reach;
    size_t count = 0;
    for (const Solid& solid : solids) {
        const double d = thickness(scene, solid, parts);
        if (d >= STEPS * 0x1p-23 * reach) continue;
        ++count;
        if (d >= min) continue;
        min = d;
        thinnest = &solid;
    }
    if (thinnest == nullptr) return std::nullopt;
    return concat(name_of_shape(scene, thinnest->shape), ": the solid is ", number_text(min, 3),
                  " m thick, less than 16 steps of 32-bit coordinates over the ", number_text(reach, 3),
                  " m of the scene and its cameras, so rays may miss one of its sides; make it thicker, or "
                  "use a thin wall",
                  count == 1 ? "" : concat(" (and ", count - 1, " more)"));
}

// The places of the lights that have one.
std::vector<DoubleBox> places_of_lights(const Scene& scene) {
    std::vector<DoubleBox> places;
    const ShapeBounds bounds_of(scene);
    for (const Shape& shape : scene.shapes) {
        if (shape.emission) places.push_back(bounds_of(shape));
    }
    for (const Light& light : scene.lights) {
        std::visit(
            [&](const auto& model) {
                if constexpr (requires { model.position; })
                    places.push_back({model.position, model.position});
            },
            light.model);
    }
    return places;
}

bool is_interface(const Material& material) {
    return std::holds_alternative<InterfaceMaterial>(material.model);
}

// See Nesting::sealed. Solids of any kind count, since one may join the inside of another. Light that comes
// by an opening is only lost if it has no surface that a path could hit.
bool is_sealed(const Scene& scene, const std::vector<Solid>& solids, const MeshSolids& parts, bool nested) {
    if (nested && std::ranges::any_of(scene.materials, is_interface)) return false;
    const std::vector<DoubleBox> lights = places_of_lights(scene);
    bool any_scatters = false;
    for (const Solid& solid : solids) {
        const Shape& shape = scene.shapes[solid.shape];
        if (is_interface(scene.materials[shape.material])) continue;
        const bool scatters = solid.inside.medium.scattering != vec3(0);
        any_scatters = any_scatters || scatters;
        if (scatters) {
            const auto* instance = std::get_if<MeshInstance>(&shape.geometry);
            const bool open =
                solid.walls ||
                (instance != nullptr && !std::ranges::all_of(parts.at(instance->mesh), &MeshSolid::closed));
            if (lets_rays_pass(scene, shape) || (open && !scene.lights.empty())) return false;
        }
        const auto touches = [&](const DoubleBox& light) {
            return all(lessThanEqual(light.lo, solid.box.hi)) &&
                   all(greaterThanEqual(light.hi, solid.box.lo));
        };
        if ((nested || scatters) && std::ranges::any_of(lights, touches)) return false;
    }
    return any_scatters;
}

}  // namespace

std::string name_of_shape(const Scene& scene, size_t i) {
    const std::string& material = scene.materials[scene.shapes[i].material].name;
    return "shape " + std::to_string(i) + (material.empty() ? "" : concat(" (material \"", material, "\")"));
}

Nesting find_nesting(const Scene& scene) {
    Nesting result;
    std::vector<Solid> solids = find_solids(scene);
    std::ranges::sort(solids, {}, [](const Solid& solid) { return solid.box.lo.x; });
    if (!for_each_overlap(solids, [&](size_t, size_t) { return !(result.nested = true); }))
        result.nested = true;  // Unknown; if wrong, kernels are only slower.
    const MeshSolids parts = find_parts(scene, solids);
    for (const auto& [mesh, mesh_parts] : parts)
        result.nested = result.nested || parts_overlap(mesh_parts);
    // If rays miss a side, a path that tracks its media at least gains no light.
    if (const auto warning = warn_of_thin(scene, solids, parts)) {
        result.nested = true;
        result.warnings.push_back(*warning);
    }

    result.sealed = is_sealed(scene, solids, parts, result.nested);

    for (const Solid& solid : solids) {
        const auto* instance = std::get_if<MeshInstance>(&scene.shapes[solid.shape].geometry);
        if (instance == nullptr || !(result.nested || solid.inside.medium != Medium{})) continue;
        if (!std::ranges::all_of(parts.at(instance->mesh), &MeshSolid::closed)) {
            result.warnings.push_back(name_of_shape(scene, solid.shape) +
                                      ": the mesh is not closed, so rays may leave the medium without "
                                      "crossing its surface, and remain in it; close the mesh");
        }
    }

    std::vector<uint32_t> around(solids.size(), 1);  // How many solids' boxes contain each, including itself.
    for_each_overlap(solids, [&](size_t i, size_t j) {
        around[i] += contains(solids[j].box, solids[i].box);
        around[j] += contains(solids[i].box, solids[j].box);
        return true;
    });
    const auto max = std::ranges::max_element(around);
    if (max != around.end() && *max > MEDIA_AT_ONCE) {
        result.warnings.push_back(
            concat(name_of_shape(scene, solids[size_t(max - around.begin())].shape), " may lie within ",
                   *max - 1, " other solids; a path can track ", MEDIA_AT_ONCE,
                   " media, and drops the one with the lowest priority that it entered first"));
    }
    return result;
}

}  // namespace candela
