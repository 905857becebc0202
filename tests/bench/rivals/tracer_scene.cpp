// See tracer_scene.h.
#include "tracer_scene.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "base/color.h"
#include "base/error.h"
#include "gpu_scene/alias_table.h"
#include "scene/geometry.h"
#include "scene/mesh.h"

namespace candela::bench {
namespace {

[[noreturn]] void refuse(const std::string& what) {
    throw Error("the tracer knows no " + what +
                "; give it a scene of quads, boxes and meshes of diffuse, conductor "
                "and exact dielectric materials, with one-sided lamps and a visible environment");
}

template <class Value>
Value constant(const Textured<Value>& value) {
    if (value.texture) refuse("textures");
    return value.factor;
}

Surface surface(const Material& material) {
    if (material.normal_map) refuse("normal maps");
    if (constant(material.opacity.value) < 1.0f) refuse("opacity below 1");
    if (material.vertex_colors) refuse("colours of vertices");
    if (const auto* m = std::get_if<DiffuseMaterial>(&material.model)) {
        return {Model::diffuse, constant(m->reflectance)};
    }
    if (const auto* m = std::get_if<ConductorMaterial>(&material.model)) {
        return {Model::metal, constant(m->reflectance), constant(m->alpha)};
    }
    const auto* m = std::get_if<DielectricMaterial>(&material.model);
    if (m == nullptr || m->fresnel != Fresnel::exact || m->inside.absorption != vec3(0)) {
        refuse("material like \"" + material.name + "\"");
    }
    return {Model::glass, vec3(1), m->ior / m->exterior_ior.value_or(1.0f)};
}

// Column of an alias table, or its alias: 32 random bits choose the column, their remainder decides within
// it.
uint32_t choose(const std::vector<AliasEntry>& alias, Random& random) {
    const uint64_t scaled = uint64_t(random.bits()) * alias.size();
    const auto column = uint32_t(scaled >> 32);
    return uint32_t(scaled) < alias[column].threshold ? column : alias[column].alias;
}

}  // namespace

TracerScene::TracerScene(const Scene& scene) {
    std::transform(scene.materials.begin(), scene.materials.end(), std::back_inserter(surfaces), surface);
    for (const Shape& shape : scene.shapes)
        add(shape, scene.meshes);
    diagonal = float(length(bounds(scene).extent()));
    if (scene.environment) {
        if (!scene.environment->visible) refuse("hidden environment");
        environment_ = *scene.environment;
    }
    build_lights();
    build_embree();
}

TracerScene::~TracerScene() {
    rtcReleaseScene(embree);
    rtcReleaseDevice(device_);
}

void TracerScene::add(const Shape& shape, const std::vector<TriangleMesh>& meshes) {
    if (shape.emission && shape.emission->two_sided) refuse("two-sided emission");
    const auto add_triangle = [&](vec3 a, vec3 b, vec3 c, uint32_t lamp) {
        const vec3 n = normalize(cross(b - a, c - a));
        triangles.push_back({{a, b, c}, {n, n, n}, shape.material, lamp});
    };
    if (const auto* quad = std::get_if<Quad>(&shape.geometry)) {
        const vec3 a(quad->corners[0]), b(quad->corners[1]), c(quad->corners[2]), d(quad->corners[3]);
        const bool is_parallelogram = length(b - a + d - c) <= 1e-6f * length(c - a);
        const uint32_t first = add_lamp(shape, a, b - a, is_parallelogram ? d - a : c - a, !is_parallelogram);
        add_triangle(a, b, c, first);
        add_triangle(a, c, d, is_parallelogram ? first : add_lamp(shape, a, c - a, d - a, true));
    } else if (const auto* instance = std::get_if<MeshInstance>(&shape.geometry)) {
        const TriangleMesh mesh = placed(meshes[instance->mesh], instance->transform);
        for (const uvec3 t : mesh.triangles) {
            const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
            add_triangle(a, b, c, add_lamp(shape, a, b - a, c - a, true));
            if (mesh.normals.empty()) continue;
            for (int i = 0; i < 3; ++i)
                triangles.back().n[i] = mesh.normals[t[i]];
        }
    } else {
        refuse("round shapes");
    }
}

uint32_t TracerScene::add_lamp(const Shape& shape, vec3 p, vec3 e1, vec3 e2, bool is_triangle) {
    if (!shape.emission) return NO_LAMP;
    const vec3 normal = cross(e1, e2);
    const double area = length(normal) * (is_triangle ? 0.5 : 1.0);
    lamps.push_back(
        {p, e1, e2, is_triangle, normalize(normal), constant(shape.emission->radiance), area, 0.0f});
    return uint32_t(lamps.size() - 1);
}

// Lamps are weighted by area times luminance, the environment by the light above its mean that falls onto a
// disk as wide as the scene, but at most as much as all lamps together. candela does the same.
void TracerScene::build_lights() {
    map_ = build_environment_map(environment_);
    for (uint32_t y = 0; y <= environment_.size.y; ++y)
        row_cosines_.push_back(std::cos(PI * float(y) / float(environment_.size.y)));
    if (map_.irradiance > 0.0) {
        std::vector<double> weights;  // Of texels; solid angles of rows are as differences of cosines.
        for (size_t i = 0; i < map_.texels.size(); ++i) {
            const size_t row = i / environment_.size.x;
            weights.push_back(double(map_.texels[i].pdf) * double(row_cosines_[row] - row_cosines_[row + 1]));
        }
        sky_alias_ = build_alias_table(weights);
    }
    std::vector<double> powers;
    for (const Lamp& lamp : lamps)
        powers.push_back(lamp.area * luminance(lamp.radiance));
    const double all_lamps = std::accumulate(powers.begin(), powers.end(), 0.0);
    const double sky = 0.25 * diagonal * diagonal * map_.irradiance;
    powers.push_back(lamps.empty() ? sky : std::min(sky, all_lamps));
    const double total = std::accumulate(powers.begin(), powers.end(), 0.0);
    has_lights = total > 0.0;
    for (EnvironmentTexel& texel : map_.texels)
        texel.pdf *= has_lights ? float(powers.back() / total) : 0.0f;
    if (!has_lights) return;
    alias_ = build_alias_table(powers);
    for (size_t i = 0; i < lamps.size(); ++i)
        lamps[i].pdf_area = float(powers[i] / total / lamps[i].area);
}

void TracerScene::build_embree() {
    device_ = rtcNewDevice(nullptr);
    if (device_ == nullptr) throw Error("Embree cannot start; check that this processor has SSE2");
    const RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* corners = static_cast<vec3*>(rtcSetNewGeometryBuffer(
        mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3), 3 * triangles.size()));
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
        mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(uvec3), triangles.size()));
    if (corners == nullptr || indices == nullptr)
        throw Error("Embree has too little memory; use a smaller scene");
    for (const Triangle& triangle : triangles)
        corners = std::copy_n(triangle.p, 3, corners);
    std::iota(indices, indices + 3 * triangles.size(), 0u);
    rtcCommitGeometry(mesh);
    embree = rtcNewScene(device_);
    rtcAttachGeometry(embree, mesh);
    rtcReleaseGeometry(mesh);
    rtcCommitScene(embree);
}

LightSample TracerScene::sample_light(vec3 from, Random& random) const {
    const uint32_t chosen = choose(alias_, random);
    if (chosen == lamps.size()) return sample_environment(random);
    const Lamp& lamp = lamps[chosen];
    float u = random.number(), v = random.number();
    if (lamp.is_triangle && u + v > 1.0f) {
        u = 1.0f - u;
        v = 1.0f - v;
    }
    const vec3 to = lamp.p + u * lamp.e1 + v * lamp.e2 - from;
    const float distance_squared = dot(to, to), distance = std::sqrt(distance_squared);
    const vec3 wi = to * (1.0f / distance);
    const float cosine = -dot(wi, lamp.n);
    if (cosine <= 0.0f) return {};
    return {wi, lamp.radiance, distance, lamp.pdf_area * distance_squared / cosine};
}

// Chooses a texel by luminance above the mean times solid angle, and a direction uniformly within it.
LightSample TracerScene::sample_environment(Random& random) const {
    const uint32_t texel = choose(sky_alias_, random);
    const uvec2 size = environment_.size;
    const float phi = 2.0f * PI * ((float(texel % size.x) + random.number()) / float(size.x) - 0.5f);
    const float above = row_cosines_[texel / size.x], below = row_cosines_[texel / size.x + 1];
    const float y = above + random.number() * (below - above);
    const float r = std::sqrt(std::max(0.0f, 1.0f - y * y)), longitude = phi - environment_.rotation;
    const vec3 wi(r * std::sin(longitude), y, -r * std::cos(longitude));
    return {wi, map_.texels[texel].radiance, INFINITE, map_.texels[texel].pdf};
}

EnvironmentTexel TracerScene::environment(vec3 d) const {
    const uvec2 size = environment_.size;
    if (size == uvec2(1)) return map_.texels[0];
    const float turns = (std::atan2(d.x, -d.z) + environment_.rotation) / (2.0f * PI) + 0.5f;
    const float v = std::acos(std::clamp(d.y, -1.0f, 1.0f)) / PI;
    const uvec2 texel(uint32_t((turns - std::floor(turns)) * float(size.x)), uint32_t(v * float(size.y)));
    const uvec2 inside = glm::min(texel, size - 1u);
    return map_.texels[size_t(inside.y) * size.x + inside.x];
}

}  // namespace candela::bench
