// Cameras around what a scene shows, for a client.
#pragma once

#include "load/node.h"
#include "scene/scene.h"
#include "serve/message.h"

namespace candela::serve {

// The cameras that the parameters of `views` ask for. Throws Error for what makes no sense.
Json describe_views(const Node& parameters, const Scene& scene);

}  // namespace candela::serve
