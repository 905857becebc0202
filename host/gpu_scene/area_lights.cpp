// See area_lights.h.
#include "gpu_scene/area_lights.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "base/color.h"
#include "base/error.h"
#include "base/text.h"
#include "gpu_scene/beam.h"
#include "gpu_scene/texture_mean.h"
#include "scene/materials.h"

namespace candela {
namespace {

// Of images that emit.
using Pyramids = std::map<std::pair<uint32_t, TextureEncoding>, std::unique_ptr<ImagePyramid>>;

// The corners of a piece in the surface coordinates of its light; of a disk, those of a polygon around it.
std::vector<vec2> corners_of(uint kind) {
    switch (kind) {
        case LIGHT_TRIANGLE:
            return {{0, 0}, {1, 0}, {0, 1}};
        case LIGHT_DISK: {
            constexpr int CORNERS = 16;
            std::vector<vec2> corners;
            for (int i = 0; i < CORNERS; ++i) {
                const float angle = 2.0f * PI * float(i) / float(CORNERS);
                corners.push_back(vec2(std::cos(angle), std::sin(angle)) / std::cos(PI / float(CORNERS)));
            }
            return corners;
        }
        default:
            return {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    }
}

// The mean radiance of an emitter over a piece of it.
vec3 mean_radiance(const Scene& scene, Pyramids& pyramids, const Emission& emission, uint kind,
                   const PieceUv& uv) {
    const std::optional<Texture>& texture = emission.radiance.texture;
    if (!texture) return emission.radiance.factor;
    std::unique_ptr<ImagePyramid>& pyramid = pyramids[{texture->image, texture->encoding}];
    if (!pyramid)
        pyramid = std::make_unique<ImagePyramid>(*scene.images[texture->image].image, texture->encoding);
    std::vector<vec2> corners;
    for (const vec2 b : corners_of(kind))
        corners.push_back(uv.origin + b.x * uv.along_b1 + b.y * uv.along_b2);
    return emission.radiance.factor * pyramid->mean(*texture, corners);
}

// A piece as its light's record holds it, and its area.
struct Extent {
    vec3 p, e1, e2;
    double area;
};

Extent extent_of(uint kind, const Primitive& primitive) {
    const vec3 a = primitive.a, b = primitive.b, c = primitive.c, d = primitive.d;
    const auto flat = [&](vec3 e1, vec3 e2, double fraction) {
        return Extent{a, e1, e2, fraction * length(cross(dvec3(e1), dvec3(e2)))};
    };
    switch (kind) {
        case LIGHT_SPHERE:
        case LIGHT_BEAM:
            return {a, b, vec3(0.0f), 4.0 * double(PI) * double(b.x) * double(b.x)};
        case LIGHT_DISK:
            return flat(b, c, double(PI));
        case LIGHT_PARALLELOGRAM:
            return flat(b - a, d - a, 1.0);
        default:
            return flat(b - a, c - a, 0.5);
    }
}

}  // namespace

AreaLights build_area_lights(const Scene& scene, const FlatScene& flat) {
    Pyramids pyramids;
    AreaLights result;
    result.of_pieces.reserve(flat.pieces.size());
    for (uint32_t i = 0; i < flat.pieces.size(); ++i) {
        const EmittingPiece& piece = flat.pieces[i];
        const Shape& shape = scene.shapes[piece.shape];
        const Emission& emission = *shape.emission;
        const auto [p, e1, e2, area] = extent_of(piece.kind, flat.primitives[piece.primitive]);
        // Rays pass what is culled from behind, and see nothing of it.
        const bool two_sided = emission.two_sided && !is_culled(scene.materials[shape.material]);
        LightRecord light{.kind = piece.kind,
                          .p = p,
                          .e1 = e1,
                          .e2 = e2,
                          .radiance = emission.radiance.factor,
                          .spread = 0.0f,
                          .two_sided = two_sided ? 1u : 0u,
                          .pdf_area = float(1.0 / area),
                          .pmf = 0.0f,
                          .error = float(piece.error)};
        const double power = area * set_beam(light, shape) *
                             luminance(mean_radiance(scene, pyramids, emission, piece.kind, piece.uv)) *
                             (two_sided ? 2.0 : 1.0);
        result.of_pieces.push_back(power == 0.0 ? NO_LIGHT : uint32_t(result.pieces.size()));
        if (power == 0.0) continue;
        result.pieces.push_back(i);
        result.lights.powers.push_back(power);
        result.lights.records.push_back(light);
    }
    return result;
}

void check_emitters(const Scene& scene, const Instancing& instancing) {
    constexpr uint64_t MAX_LIGHTS = 1u << 24u;  // A gigabyte of records.
    uint64_t triangles = 0;
    for (size_t i = 0; i < scene.shapes.size(); ++i) {
        const auto* instance = std::get_if<MeshInstance>(&scene.shapes[i].geometry);
        if (instance != nullptr && scene.shapes[i].emission && !instancing.is_instance[i])
            triangles += scene.meshes[instance->mesh].triangles.size();
    }
    for (const ShownMesh& shown : instancing.meshes) {
        if (shown.emitter != NO_EMITTER) triangles += scene.meshes[shown.mesh].triangles.size();
    }
    if (triangles > MAX_LIGHTS) {
        throw Error(concat("the scene has ", triangles,
                           " triangles that emit, each of which is a light, but at most ", MAX_LIGHTS,
                           " are possible; let fewer copies of a mesh emit, or simpler ones"));
    }
}

}  // namespace candela
