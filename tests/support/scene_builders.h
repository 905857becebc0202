// Scenes for tests: those that the program itself has for its selftest, and more.
#pragma once

#include <functional>

#include "probe/scenes.h"

namespace candela {

// The vertex at a corner: the third of the second triangle is corner 5.
inline uint32_t vertex_of(const TriangleMesh& mesh, size_t corner) {
    return mesh.triangles[corner / 3][glm::length_t(corner % 3)];
}

// A floor at y = 0 that a camera sees from (0, 1, 5), so closely that all pixels are one point: the origin.
// Material 0 is that of the floor, material 1 is black.
Scene floor_seen_closely(vec3 reflectance);

// A box whose sides are so far away that no ray of a test hits them, with the front at y = 0 and the back at
// y = -thickness: its front sides are outside.
void add_slab(Scene& scene, const DielectricMaterial& glass, float thickness);

// The mesh as the records hold it, in the frame of its scene, if it is first moved by `shift` and then
// scaled.
TriangleMesh in_its_frame(const TriangleMesh& mesh, double scale, dvec3 shift);

// A texture of `scene` whose image of that size has the colour texel(x, y) at each texel, in halves; (0, 0)
// is the upper left one.
Texture add_texture(Scene& scene, uvec2 size, const std::function<vec4(uint32_t, uint32_t)>& texel);

// Textures on every kind of shape and value: colours, roughness, emission of all kinds of lights, masks,
// opacity, a normal map, the colours of vertices.
Scene textured_scene();

// Principled materials with each of their layers, some of whose values come from textures, lamps under coat,
// sheen and fuzz among them.
Scene layered_scene();

// Haze, a cloud around a lamp, and wax, in an open room under another lamp, a point light and a sky: light on
// ways of every kind through media.
Scene hazy_room();

}  // namespace candela
