// See loading.h.
#include "cli/loading.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "base/text.h"
#include "cli/arguments.h"
#include "cli/console.h"
#include "cli/progress_line.h"
#include "load/load.h"
#include "scene/geometry.h"
#include "shared/texture.h"

namespace candela {

void add_texture_limit(CLI::App& app, std::optional<uint32_t>& limit) {
    const auto parse = [](const std::string& text) { return parse_uint(text, 1, MAX_IMAGE_SIDE); };
    add_value(app, "--texture-limit", limit, parse, concat("a whole number from 1 to ", MAX_IMAGE_SIDE),
              "Shrink images on surfaces to so many pixels along the longer side (default: never)")
        ->type_name("SIZE");
}

Scene load_with_progress(const std::string& file, std::optional<uint32_t> texture_limit,
                         ProgressStyle style) {
    Scene scene;
    {
        ProgressLine line(style, 0.0);
        ImageOptions options{.progress = [&line](size_t done, size_t of) {
            const double share = double(done) / double(of);
            if (!line.is_due(share)) return;
            const nlohmann::ordered_json json{{"state", "loading"}, {"images", done}, {"of_images", of}};
            line.print(line.is_json() ? json.dump() : concat("images: ", done, " of ", of), share);
        }};
        if (texture_limit) options.texture_limit = *texture_limit;
        scene = load_scene(file, options);
    }
    for (const std::string& warning : scene.warnings)
        print_warning(warning);
    return scene;
}

void warn_of_unseen_lights(const Scene& scene, Estimator estimator) {
    const auto lit = [](const Light& light) { return gives_light(light); };
    if (estimator != Estimator::bsdf || !std::ranges::any_of(scene.lights, lit)) return;
    print_warning(
        "the estimator bsdf does not find the point, spot and directional lights of this scene, which no "
        "surface "
        "shows; use mis or light");
}

}  // namespace candela
