// See coplanar_lights.h.
#include "gpu_scene/coplanar_lights.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "base/text.h"
#include "gpu_scene/nesting.h"
#include "scene/geometry.h"

namespace candela {
namespace {

// A convex polygon, in world space; for a disk, eight points of its edge.
struct FlatPiece {
    size_t shape;
    std::vector<dvec3> corners;
    DoubleBox box{};
    dvec3 n{};  // Of unit length.
};

// Whether two boxes overlap or touch.
bool meet(const DoubleBox& a, const DoubleBox& b) {
    return glm::all(glm::lessThanEqual(max(a.lo, b.lo), min(a.hi, b.hi)));
}

// Calls visit(piece) for the flat pieces of a shape that have an area; for a mesh, only for pieces that may
// reach into the box `within`.
template <class Visit>
void for_each_piece(const Scene& scene, size_t shape, const DoubleBox& within, const Visit& visit) {
    const auto add = [&](std::vector<dvec3> corners) {
        FlatPiece piece{shape, std::move(corners)};
        const dvec3 scaled =
            glm::cross(piece.corners[1] - piece.corners[0], piece.corners[2] - piece.corners[0]);
        if (scaled == dvec3(0.0)) return;
        piece.n = normalize(scaled);
        for (const dvec3 corner : piece.corners)
            piece.box.extend(corner);
        visit(std::move(piece));
    };
    const auto& geometry = scene.shapes[shape].geometry;
    if (const auto* quad = std::get_if<Quad>(&geometry))
        add({std::begin(quad->corners), std::end(quad->corners)});
    if (const auto* disk = std::get_if<Disk>(&geometry)) {
        std::vector<dvec3> edge;
        for (int i = 0; i < 8; ++i) {
            const double angle = i * double(PI) / 4.0;
            edge.push_back(disk->center + std::cos(angle) * disk->e1 + std::sin(angle) * disk->e2);
        }
        add(std::move(edge));
    }
    if (const auto* instance = std::get_if<MeshInstance>(&geometry)) {
        const TriangleMesh& mesh = scene.meshes[instance->mesh];
        for (const uvec3 t : mesh.triangles) {
            const auto corner = [&](uint32_t i) {
                return instance->transform.point(mesh.origin + dvec3(mesh.positions[i]));
            };
            const dvec3 a = corner(t.x), b = corner(t.y), c = corner(t.z);
            if (meet(within, {min(a, min(b, c)), max(a, max(b, c))})) add({a, b, c});
        }
    }
}

bool lies_in_plane(const FlatPiece& piece, const FlatPiece& plane, double tolerance) {
    return std::ranges::all_of(piece.corners, [&](dvec3 corner) {
        return std::abs(dot(plane.n, corner - plane.corners[0])) <= tolerance;
    });
}

// Whether two pieces of one plane share more than an edge: no line along an edge of either lies between them.
bool share_an_area(const FlatPiece& a, const FlatPiece& b, double tolerance) {
    for (const FlatPiece* piece : {&a, &b}) {
        for (size_t i = 0; i < piece->corners.size(); ++i) {
            const dvec3 from = piece->corners[i], to = piece->corners[(i + 1) % piece->corners.size()];
            if (from == to) continue;
            const dvec3 across = normalize(glm::cross(piece->n, to - from));
            const auto range = [&](const FlatPiece& of) {
                return std::ranges::minmax(of.corners, {}, [&](dvec3 p) { return dot(across, p); });
            };
            const auto [a_min, a_max] = range(a);
            const auto [b_min, b_max] = range(b);
            const double shared = std::min(dot(across, a_max), dot(across, b_max)) -
                                  std::max(dot(across, a_min), dot(across, b_min));
            if (shared <= tolerance) return false;
        }
    }
    return true;
}

std::vector<FlatPiece> find_lights(const Scene& scene) {
    constexpr size_t MAX_LIGHTS = 100;
    const DoubleBox everywhere{dvec3(-double(INFINITE)), dvec3(double(INFINITE))};
    std::vector<FlatPiece> lights;
    for (size_t i = 0; i < scene.shapes.size() && lights.size() < MAX_LIGHTS; ++i) {
        if (!scene.shapes[i].emission) continue;
        for_each_piece(scene, i, everywhere, [&](FlatPiece&& piece) {
            if (lights.size() < MAX_LIGHTS) lights.push_back(std::move(piece));
        });
    }
    return lights;
}

}  // namespace

std::optional<std::string> warn_of_coplanar_lights(const Scene& scene) {
    std::vector<FlatPiece> lights = find_lights(scene);
    if (lights.empty()) return std::nullopt;
    const dvec3 extent = bounds(scene).extent();
    const double tolerance = 0x1p-22 * std::max({extent.x, extent.y, extent.z});  // Four steps of floats.
    for (FlatPiece& light : lights)
        light.box = {light.box.lo - tolerance, light.box.hi + tolerance};
    std::map<size_t, size_t> hidden;  // By the shape of the light, the first shape in whose plane it is.
    const ShapeBounds bounds_of(scene);
    for (size_t i = 0; i < scene.shapes.size() && !lights.empty(); ++i) {
        const DoubleBox box = bounds_of(scene.shapes[i]);
        std::vector<const FlatPiece*> close;
        DoubleBox around;
        for (const FlatPiece& light : lights) {
            if (light.shape == i || !meet(light.box, box)) continue;
            close.push_back(&light);
            around.extend(light.box);
        }
        if (close.empty()) continue;
        for_each_piece(scene, i, around, [&](const FlatPiece& piece) {
            for (const FlatPiece* light : close) {
                if (meet(light->box, piece.box) &&
                    (lies_in_plane(*light, piece, tolerance) || lies_in_plane(piece, *light, tolerance)) &&
                    share_an_area(*light, piece, tolerance)) {
                    hidden.try_emplace(light->shape, i);
                }
            }
        });
        std::erase_if(lights, [&](const FlatPiece& light) { return hidden.contains(light.shape); });
    }
    if (hidden.empty()) return std::nullopt;
    const auto [light, other] = *hidden.begin();
    return concat(name_of_shape(scene, light), ": the light lies in the plane of ",
                  name_of_shape(scene, other), ", so either may hide the other; move it off that plane",
                  hidden.size() == 1 ? "" : concat(" (and ", hidden.size() - 1, " more)"));
}

}  // namespace candela
