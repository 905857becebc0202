// See scene_change.h.
#include "scene/scene_change.h"

#include <algorithm>
#include <span>
#include <variant>

namespace candela {
namespace {

void append(std::vector<uint32_t>& all, const std::vector<uint32_t>& more) {
    all.insert(all.end(), more.begin(), more.end());
}

// Other than equality, this tells 0 and -0 apart, which may lead to other bits.
template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return std::ranges::equal(std::as_bytes(std::span(a)), std::as_bytes(std::span(b)));
}

template <class T>
bool same_bits(const T& a, const T& b) {
    return std::ranges::equal(std::as_bytes(std::span(&a, 1)), std::as_bytes(std::span(&b, 1)));
}

}  // namespace

bool is_same(const TriangleMesh& a, const TriangleMesh& b) {
    return same_bits(a.origin, b.origin) && same_bits(a.positions, b.positions) &&
           same_bits(a.normals, b.normals) && same_bits(a.tangents, b.tangents) && same_bits(a.uv0, b.uv0) &&
           same_bits(a.uv1, b.uv1) && same_bits(a.colors, b.colors) && same_bits(a.triangles, b.triangles);
}

void note_shape(SceneChange& change, uint32_t i, const Shape& before, const Shape& now) {
    note_emission(change, i, before.emission, now.emission);
    const auto* from = std::get_if<MeshInstance>(&before.geometry);
    const auto* to = std::get_if<MeshInstance>(&now.geometry);
    if (before.material == now.material && from != nullptr && to != nullptr && from->mesh == to->mesh) {
        if (!same_bits(from->transform.matrix(), to->transform.matrix())) change.moved.push_back(i);
    } else if (before.material != now.material || before.geometry != now.geometry) {
        change.shapes.push_back(i);
    }
}

void SceneChange::add(const SceneChange& later) {
    environment |= later.environment;
    rotation |= later.rotation;
    lights |= later.lights;
    radiance |= later.radiance;
    materials |= later.materials;
    images |= later.images;
    append(moved, later.moved);
    append(shapes, later.shapes);
    append(meshes, later.meshes);
}

void note_emission(SceneChange& change, uint32_t shape, const std::optional<Emission>& before,
                   const std::optional<Emission>& now) {
    if (before == now) return;
    if (before && now && before->radiance.texture == now->radiance.texture) {
        change.radiance = true;
    } else {
        change.shapes.push_back(shape);
    }
}

void note_environment(SceneChange& change, const std::optional<Environment>& before,
                      const std::optional<Environment>& now) {
    if (!before || !now) {
        change.environment |= before.has_value() != now.has_value();
        return;
    }
    change.environment |=
        before->size != now->size || before->visible != now->visible || before->radiance != now->radiance;
    change.rotation |= before->rotation != now->rotation;
}

std::optional<SceneChange> difference(const Scene& before, const Scene& now) {
    if (before.materials.size() != now.materials.size() || before.meshes.size() != now.meshes.size() ||
        before.shapes.size() != now.shapes.size())
        return std::nullopt;
    SceneChange change;
    note_environment(change, before.environment, now.environment);
    change.lights = !before.lights.empty() || !now.lights.empty();
    change.materials = before.materials != now.materials;
    change.images = !std::ranges::equal(before.images, now.images, {}, &ImageFile::image, &ImageFile::image);
    for (uint32_t i = 0; i < now.shapes.size(); ++i)
        note_shape(change, i, before.shapes[i], now.shapes[i]);
    for (uint32_t i = 0; i < now.meshes.size(); ++i) {
        if (!is_same(before.meshes[i], now.meshes[i])) change.meshes.push_back(i);
    }
    return change;
}

}  // namespace candela
