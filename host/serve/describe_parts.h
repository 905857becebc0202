// Parts of a scene as JSON.
#pragma once

#include "image/labels.h"
#include "load/node.h"
#include "scene/scene.h"
#include "serve/message.h"

namespace candela::serve {

// The instances of the object that `name` names: by their numbers, where they are, whether they are seen, and
// their materials. Throws Error if there is none.
Json describe_object(const Node& name, const Scene& scene);

// The values of the material that `name` names, as in scene files; instead of an image, the name of its file.
// Throws Error if there is none.
Json describe_material(const Node& name, const Scene& scene);

// Number n is element n - 1.
Json describe_labels(const Labels& labels);

}  // namespace candela::serve
