// One overload of add() per geometry.
#include "gpu_scene/flatten.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/color.h"
#include "gpu_scene/ray_error.h"
#include "gpu_scene/triangle_pairs.h"
#include "scene/mesh.h"

namespace candela {
namespace {

// Of the triangles a b c and a c d.
double pair_error(vec3 a, vec3 b, vec3 c, vec3 d) {
    return std::max(triangle_error(a, b, c), triangle_error(a, c, d));
}

class Flattener {
  public:
    Flattener(const Scene& scene, const SceneFrame& frame) : scene_(scene), frame_(frame) {
        size_t count = 0;
        for (const Shape& shape : scene.shapes) {
            const auto* instance = std::get_if<MeshInstance>(&shape.geometry);
            const TriangleMesh* mesh = instance != nullptr ? &scene.meshes[instance->mesh] : nullptr;
            has_normals_ = has_normals_ || (mesh != nullptr && !mesh->normals.empty());
            count += mesh != nullptr ? mesh->triangles.size() : 2;  // A quad may be two.
        }
        flat_.primitives.reserve(count);
        if (has_normals_) flat_.normals.reserve(count);
        for (const Shape& shape : scene.shapes) {
            std::visit([&](const auto& geometry) { add(shape, geometry); }, shape.geometry);
        }
    }

    FlatScene take() { return std::move(flat_); }

  private:
    // The triangles of an emitter are lights of their own, so they are not paired.
    void add(const Shape& shape, const MeshInstance& instance) {
        TriangleMesh mesh = placed(scene_.meshes[instance.mesh], instance.transform, frame_);
        flat_.triangles += mesh.triangles.size();
        flat_.coarse += count_coarse_triangles(mesh);
        flat_.flattened += drop_flat_triangles(mesh);
        const uint first_id = flat_.id_count;
        flat_.id_count += uint(mesh.triangles.size());
        const bool smooth = !mesh.normals.empty();
        const std::vector<vec3>& p = mesh.positions;
        const std::vector<vec3>& n = mesh.normals;
        for (const auto& [v, first, second] :
             shape.emission ? single_triangles(mesh) : pair_triangles(mesh)) {
            const double error = pair_error(p[v.x], p[v.y], p[v.z], p[v.w]);
            const uint light =
                add_flat_light(shape, LIGHT_TRIANGLE, p[v.x], p[v.y] - p[v.x], p[v.z] - p[v.x], error);
            add_primitive(
                {PRIMITIVE_TRIANGLES, p[v.x], p[v.y], p[v.z], p[v.w]},
                {first_id + uvec2(first, second), shape.material, smooth, light, power_of_two_above(error)});
            if (smooth) flat_.normals.back() = pack_normals(n[v.x], n[v.y], n[v.z], n[v.w]);
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
        if (!shape.emission || length(c[0] + e1 + e2 - c[2]) <= rounding) {
            const uint light = add_flat_light(shape, LIGHT_PARALLELOGRAM, c[0], e1, e2, error);
            add_primitive({PRIMITIVE_TRIANGLES, c[0], c[1], c[2], c[3]},
                          {uvec2(id, id + 1), shape.material, 0, light, origin_error});
        } else {
            uint light = add_flat_light(shape, LIGHT_TRIANGLE, c[0], e1, diagonal, error);
            add_primitive({PRIMITIVE_TRIANGLES, c[0], c[1], c[2], c[2]},
                          {uvec2(id), shape.material, 0, light, origin_error});
            light = add_flat_light(shape, LIGHT_TRIANGLE, c[0], diagonal, e2, error);
            add_primitive({PRIMITIVE_TRIANGLES, c[0], c[2], c[3], c[3]},
                          {uvec2(id + 1), shape.material, 0, light, origin_error});
        }
    }

    void add(const Shape& shape, const Sphere& sphere) {
        const vec3 center = frame_.point(sphere.center);
        const vec3 radius(frame_.length(sphere.radius), 0.0f, 0.0f);
        const double area = 4.0 * double(PI) * double(radius.x) * double(radius.x);
        const double error = sphere_error(center, radius.x);
        const uint light = add_light(shape, LIGHT_SPHERE, center, radius, vec3(0.0f), area, error);
        add_primitive({PRIMITIVE_SPHERE, center, radius, vec3(0.0f), vec3(0.0f)},
                      {uvec2(flat_.id_count++), shape.material, 0, light, power_of_two_above(error)});
    }

    void add(const Shape& shape, const Disk& disk) {
        const vec3 center = frame_.point(disk.center);
        const vec3 e1 = frame_.vector(disk.e1);
        const vec3 e2 = frame_.vector(disk.e2);
        const double error = disk_error(center, e1, e2);
        const uint light = add_flat_light(shape, LIGHT_DISK, center, e1, e2, error);
        add_primitive({PRIMITIVE_DISK, center, e1, e2, vec3(0.0f)},
                      {uvec2(flat_.id_count++), shape.material, 0, light, power_of_two_above(error)});
    }

    void add_primitive(const Primitive& primitive, const Surface& surface) {
        flat_.primitives.push_back(primitive);
        flat_.surfaces.push_back(surface);
        if (has_normals_) flat_.normals.push_back({});
    }

    uint add_flat_light(const Shape& shape, uint kind, vec3 p, vec3 e1, vec3 e2, double error) {
        if (!shape.emission) return NO_LIGHT;
        const double share = kind == LIGHT_TRIANGLE ? 0.5 : kind == LIGHT_DISK ? double(PI) : 1.0;
        return add_light(shape, kind, p, e1, e2, share * length(cross(dvec3(e1), dvec3(e2))),
                         error + flat_light_error(p, e1, e2));
    }

    // The index of a new light, or NO_LIGHT if the piece emits nothing.
    uint add_light(const Shape& shape, uint kind, vec3 p, vec3 e1, vec3 e2, double area, double error) {
        if (!shape.emission) return NO_LIGHT;
        const Emission& emission = *shape.emission;
        const double power = area * luminance(emission.radiance) * (emission.two_sided ? 2.0 : 1.0);
        if (power == 0.0) return NO_LIGHT;
        flat_.lights.push_back({kind, p, e1, e2, emission.radiance, emission.two_sided ? 1u : 0u,
                                float(1.0 / area), 0.0f, float(error)});
        flat_.powers.push_back(power);
        return uint(flat_.lights.size() - 1);
    }

    const Scene& scene_;
    const SceneFrame& frame_;
    bool has_normals_ = false;
    FlatScene flat_;
};

}  // namespace

FlatScene flatten(const Scene& scene, const SceneFrame& frame) {
    return Flattener(scene, frame).take();
}

void assign_probabilities(FlatScene& flat) {
    const double total = std::accumulate(flat.powers.begin(), flat.powers.end(), 0.0);
    for (size_t i = 0; i < flat.lights.size(); ++i)
        flat.lights[i].pmf = float(flat.powers[i] / total);
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

}  // namespace candela
