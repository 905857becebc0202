// One overload of add() per geometry.
#include "gpu_scene/flatten.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <glm/packing.hpp>

#include "gpu_scene/material_arrays.h"
#include "gpu_scene/ray_error.h"
#include "gpu_scene/triangle_pairs.h"
#include "scene/materials.h"
#include "scene/mesh.h"
#include "shared/light.h"

namespace candela {
namespace {

// Of the triangles a b c and a c d.
double pair_error(vec3 a, vec3 b, vec3 c, vec3 d) {
    return std::max(triangle_error(a, b, c), triangle_error(a, c, d));
}

// The values at four vertices; `absent` if the mesh has none.
template <class Value>
std::array<Value, 4> corner_values(const std::vector<Value>& values, uvec4 v, const Value& absent) {
    if (values.empty()) return {absent, absent, absent, absent};
    return {values[v.x], values[v.y], values[v.z], values[v.w]};
}

// Four numbers in [0, 65504] as half floats.
uvec2 pack_halves(vec4 v) {
    return {glm::packHalf2x16(vec2(v.x, v.y)), glm::packHalf2x16(vec2(v.z, v.w))};
}

PieceUv piece_uv(vec2 a, vec2 b, vec2 c) {
    return {a, b - a, c - a};
}

// The triangles of an emitter are lights of their own, so they are not paired.
std::vector<TrianglePair> primitives_of(const TriangleMesh& mesh, bool emits) {
    return emits ? single_triangles(mesh) : pair_triangles(mesh);
}

class Flattener {
  public:
    Flattener(const Scene& scene, const SceneFrame& frame, uint attributes, bool has_normals)
        : scene_(scene), frame_(frame), attributes_(attributes), has_normals_(has_normals) {}

    void reserve(size_t primitives) {
        flat_.primitives.reserve(primitives);
        flat_.surfaces.reserve(primitives);
        if (has_normals_) flat_.normals.reserve(primitives);
        flat_.attributes.reserve(primitives * attribute_words(attributes_));
    }

    void add(const Shape& shape, uint index, bool passable) {
        index_ = index;
        passable_ = passable ? 1 : 0;
        flat_.shape_ids.push_back({flat_.id_count, index, 0});
        std::visit([&](const auto& geometry) { add(shape, geometry); }, shape.geometry);
    }

    FlatScene take() { return std::move(flat_); }

  private:
    void add(const Shape& shape, const MeshInstance& instance) {
        TriangleMesh mesh = placed(scene_.meshes[instance.mesh], instance.transform, frame_);
        flat_.triangles += mesh.triangles.size();
        flat_.coarse += count_coarse_triangles(mesh);
        flat_.flattened += drop_flat_triangles(mesh);
        const uint first_id = flat_.id_count;
        flat_.id_count += uint(mesh.triangles.size());
        add_groups(mesh.groups, first_id);
        const bool smooth = !mesh.normals.empty();
        const std::vector<vec3>& p = mesh.positions;
        const std::vector<vec3>& n = mesh.normals;
        for (const auto& [v, first, second] : primitives_of(mesh, shape.emission.has_value())) {
            const double error = pair_error(p[v.x], p[v.y], p[v.z], p[v.w]);
            const uint light = add_flat_piece(shape, LIGHT_TRIANGLE, p[v.x], p[v.y] - p[v.x], p[v.z] - p[v.x],
                                              error, emission_uv(shape, mesh, v));
            add_primitive({PRIMITIVE_TRIANGLES, p[v.x], p[v.y], p[v.z], p[v.w]},
                          {first_id + uvec2(first, second), shape.material, smooth, light,
                           power_of_two_above(error), passable_});
            if (smooth) flat_.normals.back() = pack_normals(n[v.x], n[v.y], n[v.z], n[v.w]);
            add_attributes(corner_values(mesh.uv0, v, vec2(0.0f)), corner_values(mesh.uv1, v, vec2(0.0f)),
                           corner_values(mesh.colors, v, vec4(1.0f)),
                           corner_values(mesh.tangents, v, vec4(1.0f, 0.0f, 0.0f, 1.0f)));
        }
    }

    // Notes which ids belong to which groups of a mesh; the first of them is noted as that of group 0.
    void add_groups(const std::vector<uint32_t>& groups, uint first_id) {
        for (uint i = 0; i < groups.size(); ++i) {
            ShapeIds& last = flat_.shape_ids.back();
            if (groups[i] == last.group) continue;
            if (i == 0) {
                last.group = groups[i];
            } else {
                flat_.shape_ids.push_back({first_id + i, index_, groups[i]});
            }
        }
    }

    // Two triangles; if the corners span a parallelogram, one light for both, so that its samples are
    // stratified over the whole.
    void add(const Shape& shape, const Quad& quad) {
        vec3 c[4];
        for (size_t i = 0; i < 4; ++i)
            c[i] = frame_.point(quad.corners[i]);
        const vec3 e1 = c[1] - c[0];
        const vec3 e2 = c[3] - c[0];
        const vec3 diagonal = c[2] - c[0];
        const float rounding = 4e-7f * (length(c[0]) + length(e1) + length(e2));
        const uint id = flat_.id_count;
        flat_.id_count += 2;
        const double error = pair_error(c[0], c[1], c[2], c[3]);
        const float origin_error = power_of_two_above(error);
        const auto& uv = quad.uvs;
        // Where u grows; the corners are those of a square in (u, v), turned, mirrored or both.
        const vec2 side = uv[1] - uv[0], other = uv[3] - uv[0];
        const vec3 along_u = side.x != 0.0f ? side.x * e1 : other.x * e2;
        const float handedness = side.x * other.y - side.y * other.x > 0.0f ? 1.0f : -1.0f;
        if (!shape.emission || length(c[0] + e1 + e2 - c[2]) <= rounding) {
            const uint light = add_flat_piece(shape, LIGHT_PARALLELOGRAM, c[0], e1, e2, error,
                                              piece_uv(uv[0], uv[1], uv[3]));
            add_primitive({PRIMITIVE_TRIANGLES, c[0], c[1], c[2], c[3]},
                          {uvec2(id, id + 1), shape.material, 0, light, origin_error, passable_});
            add_uvs({uv[0], uv[1], uv[2], uv[3]}, vec4(along_u, handedness));
        } else {
            uint light = add_flat_piece(shape, LIGHT_TRIANGLE, c[0], e1, diagonal, error,
                                        piece_uv(uv[0], uv[1], uv[2]));
            add_primitive({PRIMITIVE_TRIANGLES, c[0], c[1], c[2], c[2]},
                          {uvec2(id), shape.material, 0, light, origin_error, passable_});
            add_uvs({uv[0], uv[1], uv[2], uv[2]}, vec4(along_u, handedness));
            light = add_flat_piece(shape, LIGHT_TRIANGLE, c[0], diagonal, e2, error,
                                   piece_uv(uv[0], uv[2], uv[3]));
            add_primitive({PRIMITIVE_TRIANGLES, c[0], c[2], c[3], c[3]},
                          {uvec2(id + 1), shape.material, 0, light, origin_error, passable_});
            add_uvs({uv[0], uv[2], uv[3], uv[3]}, vec4(along_u, handedness));
        }
    }

    void add(const Shape& shape, const Sphere& sphere) {
        const vec3 center = frame_.point(sphere.center);
        const vec3 radius(frame_.length(sphere.radius), 0.0f, 0.0f);
        const double error = sphere_error(center, radius.x);
        constexpr double COARSE = 0.03;  // Of the radius.
        ++flat_.spheres;
        flat_.coarse_spheres += error > COARSE * double(radius.x);
        // All around and from pole to pole; where the poles get too much, that only makes the choice of
        // lights worse.
        const uint light = add_piece(shape, shape.beam.cone ? LIGHT_BEAM : LIGHT_SPHERE, error,
                                     piece_uv(vec2(0, 0), vec2(1, 0), vec2(0, 1)));
        add_primitive(
            {PRIMITIVE_SPHERE, center, radius, vec3(0.0f), vec3(0.0f)},
            {uvec2(flat_.id_count++), shape.material, 0, light, power_of_two_above(error), passable_});
        add_uvs({}, vec4(1, 0, 0, 1));  // All computed from the normal.
    }

    void add(const Shape& shape, const Disk& disk) {
        const vec3 center = frame_.point(disk.center);
        const vec3 e1 = frame_.vector(disk.e1);
        const vec3 e2 = frame_.vector(disk.e2);
        const double error = disk_error(center, e1, e2);
        const uint light = add_flat_piece(shape, LIGHT_DISK, center, e1, e2, error,
                                          piece_uv(disk.uvs[0], disk.uvs[1], disk.uvs[2]));
        add_primitive(
            {PRIMITIVE_DISK, center, e1, e2, vec3(0.0f)},
            {uvec2(flat_.id_count++), shape.material, 0, light, power_of_two_above(error), passable_});
        const bool swapped = disk.uvs[1].x < disk.uvs[2].x;
        add_uvs({disk.uvs[0], disk.uvs[1], disk.uvs[2], disk.uvs[2]}, swapped ? vec4(e2, -1) : vec4(e1, 1));
    }

    void add_primitive(const Primitive& primitive, const Surface& surface) {
        flat_.primitives.push_back(primitive);
        flat_.surfaces.push_back(surface);
        if (has_normals_) flat_.normals.push_back({});
    }

    // The attributes of a primitive's corners.
    void add_attributes(const std::array<vec2, 4>& uv0, const std::array<vec2, 4>& uv1,
                        const std::array<vec4, 4>& colors, const std::array<vec4, 4>& tangents) {
        if ((attributes_ & ATTRIBUTE_UV0) != 0) add_pairs(uv0);
        if ((attributes_ & ATTRIBUTE_UV1) != 0) add_pairs(uv1);
        for (size_t i = 0; (attributes_ & ATTRIBUTE_COLOR) != 0 && i < 4; i += 2) {
            const uvec2 a = pack_halves(colors[i]), b = pack_halves(colors[i + 1]);
            flat_.attributes.emplace_back(a.x, a.y, b.x, b.y);
        }
        if ((attributes_ & ATTRIBUTE_TANGENT) == 0) return;
        flat_.attributes.emplace_back(pack_tangent(tangents[0]), pack_tangent(tangents[1]),
                                      pack_tangent(tangents[2]), pack_tangent(tangents[3]));
    }

    // The attributes of a primitive of one colour and one tangent, of any length.
    void add_uvs(const std::array<vec2, 4>& uv, vec4 along_u) {
        constexpr vec4 WHITE(1.0f);
        const vec4 tangent(normalize(vec3(along_u.x, along_u.y, along_u.z)), along_u.w);
        add_attributes(uv, uv, {WHITE, WHITE, WHITE, WHITE}, {tangent, tangent, tangent, tangent});
    }

    void add_pairs(const std::array<vec2, 4>& v) {
        for (size_t i = 0; i < 4; i += 2) {
            flat_.attributes.push_back(std::bit_cast<uvec4>(vec4(v[i].x, v[i].y, v[i + 1].x, v[i + 1].y)));
        }
    }

    // The index of a new piece, or NO_LIGHT if the shape does not emit: the part of a flat shape that is
    // p + b1 e1 + b2 e2.
    uint add_flat_piece(const Shape& shape, uint kind, vec3 p, vec3 e1, vec3 e2, double error,
                        const PieceUv& uv) {
        if (!shape.emission) return NO_LIGHT;
        return add_piece(shape, kind, error + flat_light_error(p, e1, e2), uv);
    }

    uint add_piece(const Shape& shape, uint kind, double error, const PieceUv& uv) {
        if (!shape.emission) return NO_LIGHT;
        flat_.pieces.push_back({uint(flat_.primitives.size()), index_, kind, error, uv});
        return uint(flat_.pieces.size() - 1);
    }

    // The texture coordinates of the first of the triangles at these vertices, as the shape's emission looks
    // them up.
    static PieceUv emission_uv(const Shape& shape, const TriangleMesh& mesh, uvec4 v) {
        if (!shape.emission || !shape.emission->radiance.texture) return {};
        const std::vector<vec2>& uv = shape.emission->radiance.texture->uv_set == 0 ? mesh.uv0 : mesh.uv1;
        return uv.empty() ? PieceUv{} : piece_uv(uv[v.x], uv[v.y], uv[v.z]);
    }

    const Scene& scene_;
    const SceneFrame& frame_;
    uint attributes_;
    bool has_normals_;
    uint passable_ = 0;  // Of the shape that is added,
    uint index_ = 0;     // and which one it is.
    FlatScene flat_;
};

}  // namespace

FlatScene flatten(const Scene& scene, const SceneFrame& frame, uint attributes,
                  const std::vector<bool>& left_out) {
    const auto is_left_out = [&](size_t i) { return !left_out.empty() && left_out[i]; };
    size_t count = 0;
    for (size_t i = 0; i < scene.shapes.size(); ++i) {
        if (is_left_out(i)) continue;
        const auto* instance = std::get_if<MeshInstance>(&scene.shapes[i].geometry);
        count +=
            instance != nullptr ? scene.meshes[instance->mesh].triangles.size() : 2;  // A quad may be two.
    }
    Flattener flattener(scene, frame, attributes, has_shading_normals(scene));
    flattener.reserve(count);
    for (size_t i = 0; i < scene.shapes.size(); ++i) {
        if (!is_left_out(i)) flattener.add(scene.shapes[i], uint(i), lets_rays_pass(scene, scene.shapes[i]));
    }
    return flattener.take();
}

FlatScene flatten_mesh(const Scene& scene, const ShownMesh& shown, bool passable, const SceneFrame& frame,
                       uint attributes, bool has_normals) {
    Flattener flattener(scene, frame, attributes, has_normals);
    flattener.reserve(scene.meshes[shown.mesh].triangles.size());
    Shape shape{.geometry = MeshInstance{.mesh = shown.mesh}, .material = 0, .emission = {}};
    if (shown.emitter != NO_EMITTER) shape.emission = scene.shapes[shown.emitter].emission;
    flattener.add(shape, shown.emitter, passable);
    return flattener.take();
}

std::vector<uvec3> corners_by_id(const TriangleMesh& mesh, const Transform& transform,
                                 const SceneFrame& frame, bool emits) {
    TriangleMesh bare = placed(
        {.origin = mesh.origin, .positions = mesh.positions, .triangles = mesh.triangles}, transform, frame);
    drop_flat_triangles(bare);
    std::vector<uvec3> corners(bare.triangles.size());
    for (const auto& [v, first, second] : primitives_of(bare, emits)) {
        corners[second] = {v.x, v.z, v.w};
        corners[first] = {v.x, v.y, v.z};
    }
    return corners;
}

bool has_shading_normals(const Scene& scene) {
    return std::ranges::any_of(scene.shapes, [&](const Shape& shape) {
        const auto* instance = std::get_if<MeshInstance>(&shape.geometry);
        return instance != nullptr && !scene.meshes[instance->mesh].normals.empty();
    });
}

Box bounds(const Primitive& p) {
    Box box;
    switch (p.kind) {
        case PRIMITIVE_SPHERE:
            box.extend(p.a - vec3(p.b.x));
            box.extend(p.a + vec3(p.b.x));
            break;
        case PRIMITIVE_DISK: {
            const vec3 reach = sqrt(p.b * p.b + p.c * p.c);
            box.extend(p.a - reach);
            box.extend(p.a + reach);
            break;
        }
        default:
            box.extend(p.a);
            box.extend(p.b);
            box.extend(p.c);
            box.extend(p.d);
    }
    return box;
}

std::vector<Box> boxes_of(const std::vector<Primitive>& primitives) {
    std::vector<Box> boxes;
    boxes.reserve(primitives.size());
    for (const Primitive& primitive : primitives)
        boxes.push_back(bounds(primitive));
    return boxes;
}

}  // namespace candela
