// What a request wants rendered, in terms of the session.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "film/accumulation.h"
#include "load/node.h"
#include "scene/scene.h"
#include "session/job.h"

namespace candela::serve {

// A layer as the protocol names it, and the channels that it is made of.
struct LayerKind {
    std::string_view name;
    std::vector<std::string_view> channels;
    bool AovSelection::*selected;  // Null: it is always there.
};
std::span<const LayerKind> layer_kinds();

// The job for the parameters of `render`, whose camera is a name or is described as in a scene file. What is
// not given is what the scene proposes. Throws Error for what makes no sense.
RenderJob read_job(const Node& parameters, const Scene& scene);

// The layers that the parameter `layers` names, "all" being all but those of ids, which cost as much again as
// the picture; none if it is not given.
AovSelection read_layers(const Node& parameters);

// A size [width, height] in pixels, if it is given.
std::optional<uvec2> read_size(const Node& parameters);

}  // namespace candela::serve
