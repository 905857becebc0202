// Lamps: instances of meshes that emit. Their lights are stored once for each mesh, in its space.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "gpu_scene/area_lights.h"
#include "gpu_scene/instancing.h"
#include "gpu_scene/light_tree.h"
#include "gpu_scene/mesh_trees.h"
#include "gpu_scene/scene_tree.h"
#include "scene/scene.h"
#include "shared/light.h"

namespace candela {

// The lights of a mesh, in its space.
struct LampLights {
    AreaLights area;     // None if all are black.
    LightTree tree;      // Over them.
    LightBounds bounds;  // Around them, but without a box.
    double power = 0.0;  // Of all, over pi.
};

using Lamps = std::map<ShownMesh, LampLights>;

// The lights of the trees that emit. Throws what build_area_lights() throws.
Lamps build_lamps(const Scene& scene, const MeshTrees& trees);

// A lamp in the frame of the scene.
struct PlacedLamp {
    ShownMesh mesh;
    LampRecord record;  // Only node, mirrored and area.
    LightBounds bounds;
    double power = 0.0;  // Over pi [W].
};

// The lamps that have lights, in the order of the tree's instances.
std::vector<PlacedLamp> place_lamps(const Lamps& lamps, const SceneTree& tree);

// Writes the places of lamps in the table of lights, which are consecutive, into the records of their
// instances.
void number_lamps(SceneTree& tree, const Lamps& lamps, uint32_t first);

}  // namespace candela
