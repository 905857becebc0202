// See job.h.
#include "session/job.h"

#include <algorithm>
#include <vector>

#include "base/error.h"
#include "base/printable.h"
#include "image/cryptomatte.h"

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

uint32_t layer_bytes(const AovSelection& aovs) {
    // Most pixels show one part or two; a vector has room for up to twice as many as it holds.
    constexpr size_t COVERAGE = sizeof(size_t) + size_t{4} * sizeof(CoveredPart);
    constexpr size_t IDS = 3 * sizeof(float), CRYPTOMATTE = size_t{4} * CRYPTO_RANKS * sizeof(float);
    constexpr size_t MOTION = 2 * sizeof(vec2);
    return uint32_t((aovs.needs_coverage() ? COVERAGE : 0) + (aovs.ids ? IDS : 0) +
                    (aovs.cryptomatte ? CRYPTOMATTE : 0) + (aovs.motion ? MOTION : 0));
}

}  // namespace candela
