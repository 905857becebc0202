// See gpu_scene.h.
#include "render/gpu_scene.h"

#include <chrono>
#include <numeric>

#include "bvh/bvh.h"
#include "render/alias_table.h"
#include "shared/bvh_node.h"
#include "shared/material.h"
#include "shared/primitive.h"

namespace candela {
namespace {

template <class Record>
void append(std::vector<uvec4>& out, const Record& record) {
    out.insert(out.end(), record.begin(), record.end());
}

float luminance(vec3 rgb) {
    return dot(rgb, vec3(0.2126f, 0.7152f, 0.0722f));
}

// The scene in its own order, before the BVH decides on another.
struct Flat {
    std::vector<Primitive> primitives;
    std::vector<std::array<uvec4, NORMALS_WORDS>> normals;  // One per triangle, or none if all are flat.
    std::vector<Light> lights;
    std::vector<double> powers;  // Of each light, up to a common factor.
};

class Flattener {
  public:
    explicit Flattener(const Scene& scene) {
        for (const Shape& shape : scene.shapes) {
            const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
            has_normals_ = has_normals_ || (mesh != nullptr && !mesh->normals.empty());
        }
        for (const Shape& shape : scene.shapes) {
            std::visit([&](const auto& geometry) { add(shape, geometry); }, shape.geometry);
        }
    }

    Flat take() {
        const double total = std::accumulate(flat_.powers.begin(), flat_.powers.end(), 0.0);
        for (size_t i = 0; i < flat_.lights.size(); ++i) {
            flat_.lights[i].pdf_area = float(flat_.powers[i] / total / areas_[i]);
        }
        return std::move(flat_);
    }

  private:
    void add(const Shape& shape, const TriangleMesh& mesh) {
        for (const uvec3 t : mesh.triangles) {
            const vec3 v0 = mesh.positions[t.x];
            const vec3 v1 = mesh.positions[t.y];
            const vec3 v2 = mesh.positions[t.z];
            add_triangle(shape, v0, v1, v2, add_light(shape, LIGHT_TRIANGLE, v0, v1 - v0, v2 - v0));
            if (!mesh.normals.empty()) {
                flat_.normals.back() = pack_normals(mesh.normals[t.x], mesh.normals[t.y], mesh.normals[t.z]);
            }
        }
    }

    // Two triangles; where the corners span a parallelogram, one light for both, so that its samples are
    // stratified over the whole.
    void add(const Shape& shape, const Quad& quad) {
        const auto& c = quad.corners;
        const vec3 e1 = c[1] - c[0];
        const vec3 e2 = c[3] - c[0];
        const float rounding = 4e-7f * (length(c[0]) + length(e1) + length(e2));
        if (length(c[0] + e1 + e2 - c[2]) <= rounding) {
            const uint light = add_light(shape, LIGHT_PARALLELOGRAM, c[0], e1, e2);
            add_triangle(shape, c[0], c[1], c[2], light);
            add_triangle(shape, c[0], c[2], c[3], light);
        } else {
            add_triangle(shape, c[0], c[1], c[2], add_light(shape, LIGHT_TRIANGLE, c[0], e1, c[2] - c[0]));
            add_triangle(shape, c[0], c[2], c[3], add_light(shape, LIGHT_TRIANGLE, c[0], c[2] - c[0], e2));
        }
    }

    void add_triangle(const Shape& shape, vec3 v0, vec3 v1, vec3 v2, uint light) {
        flat_.primitives.push_back(
            {PRIMITIVE_TRIANGLE, v0, v1, v2, uint(flat_.primitives.size()), shape.material, light});
        if (has_normals_) flat_.normals.push_back({});
    }

    // The index of a new light, or NO_LIGHT if the piece sends out nothing.
    uint add_light(const Shape& shape, uint kind, vec3 p, vec3 e1, vec3 e2) {
        if (!shape.emission) return NO_LIGHT;
        const Emission& emission = *shape.emission;
        const double area =
            length(cross(glm::dvec3(e1), glm::dvec3(e2))) * (kind == LIGHT_TRIANGLE ? 0.5 : 1.0);
        const double power = area * luminance(emission.radiance) * (emission.two_sided ? 2.0 : 1.0);
        if (power == 0.0) return NO_LIGHT;
        flat_.lights.push_back({kind, p, e1, e2, emission.radiance, emission.two_sided ? 1u : 0u, 0.0f});
        flat_.powers.push_back(power);
        areas_.push_back(area);
        return uint(flat_.lights.size() - 1);
    }

    bool has_normals_ = false;
    Flat flat_;
    std::vector<double> areas_;  // Of each light [m^2].
};

MaterialRecord record(const DiffuseMaterial& m) {
    return {MATERIAL_DIFFUSE, m.reflectance};
}

Bvh build_bvh_over(const std::vector<Primitive>& primitives) {
    std::vector<Box> boxes(primitives.size());
    for (size_t i = 0; i < primitives.size(); ++i) {
        boxes[i].extend(primitives[i].a);
        boxes[i].extend(primitives[i].b);
        boxes[i].extend(primitives[i].c);
    }
    return build_bvh(boxes);
}

}  // namespace

GpuScene build_gpu_scene(const Scene& scene) {
    const Flat flat = Flattener(scene).take();
    GpuScene gpu;
    gpu.primitive_count = uint32_t(flat.primitives.size());
    gpu.light_count = uint32_t(flat.lights.size());
    gpu.has_normals = !flat.normals.empty();

    const auto start = std::chrono::steady_clock::now();
    const Bvh bvh = build_bvh_over(flat.primitives);
    gpu.bvh_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    gpu.bvh_depth = bvh.depth;
    gpu.bvh_sah_cost = bvh.sah_cost;

    gpu.nodes.reserve(bvh.nodes.size() * BVH_NODE_WORDS);
    for (const auto& node : bvh.nodes)
        append(gpu.nodes, node);
    gpu.primitives.reserve(flat.primitives.size() * PRIMITIVE_WORDS);
    for (const uint32_t i : bvh.order)
        append(gpu.primitives, pack(flat.primitives[i]));

    const auto begin_table = [&](glm::length_t table) { gpu.table_starts[table] = uint(gpu.tables.size()); };
    begin_table(0);
    if (gpu.has_normals) {
        for (const uint32_t i : bvh.order)
            append(gpu.tables, flat.normals[i]);
    }
    begin_table(1);
    for (const Material& material : scene.materials) {
        append(gpu.tables, pack(std::visit([](const auto& model) { return record(model); }, material.model)));
    }
    begin_table(2);
    for (const Light& light : flat.lights)
        append(gpu.tables, pack(light));
    begin_table(3);
    if (gpu.light_count > 0) {
        for (const AliasEntry& entry : build_alias_table(flat.powers))
            append(gpu.tables, pack(entry));
    }
    return gpu;
}

}  // namespace candela
