// The numbers and names of a scene's objects, instances and materials.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "image/labels.h"
#include "scene/scene.h"

namespace candela {

// Numbers the objects and instances by their first shapes, and the materials by their places in the scene. A
// shape that belongs to no object is one by itself. Names that are not UTF-8 get U+FFFD for each such byte;
// names that are missing or taken get others. Throws Error if there are more than MAX_LABEL of a kind.
Labels label_scene(const Scene& scene);

// Throws Error if there are more than MAX_LABEL of `things`.
void check_label_count(size_t count, const char* things);

// A warning for names of different things that Cryptomatte cannot tell apart, since they have the same id;
// nothing if there are none. `things`: what messages call them.
std::vector<std::string> warnings_of_collisions(const std::vector<std::string>& names, const char* things);

}  // namespace candela
