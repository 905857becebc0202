// See job.h.
#include "session/job.h"

#include <algorithm>
#include <vector>

#include "base/error.h"
#include "base/printable.h"

namespace candela {

const Camera& choose_camera(const Scene& scene, const std::optional<std::string>& name,
                            const std::string& place) {
    if (!name) return scene.cameras.front();
    std::vector<std::string> names;
    for (const Camera& defined : scene.cameras) {
        if (defined.name == *name) return defined;
        names.push_back(defined.name);
    }
    throw Error(place + "unknown camera \"" + *name + "\" (defined: " + joined(names) + ")",
                ErrorKind::request);
}

RenderSettings proposed_settings(const Scene& scene, const Camera& camera) {
    const IntegratorSettings& proposed = scene.integrator;
    const uvec2 size = camera.film_size.value_or(scene.film.size);
    return {.size = size,
            .crop = {0, 0, size.x, size.y},
            .estimator = proposed.estimator,
            .sampler = proposed.sampler,
            .light_sampler = proposed.light_sampler,
            .terminator = proposed.terminator,
            .filter = scene.film.filter,
            .clamp_indirect = proposed.clamp_indirect,
            .seed = proposed.seed,
            .max_depth = std::min(proposed.max_depth.value_or(DEPTH_SAFETY_LIMIT), DEPTH_SAFETY_LIMIT),
            .rr_depth = proposed.rr_depth};
}

}  // namespace candela
