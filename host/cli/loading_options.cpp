// See loading_options.h.
#include "cli/loading_options.h"

#include "base/memory_limit.h"
#include "base/text.h"
#include "cli/arguments.h"
#include "scene/names.h"
#include "shared/texture.h"

namespace candela {

void LoadingOptions::add_to(CLI::App& app) {
    const auto parse = [](const std::string& text) { return parse_uint(text, 1, MAX_IMAGE_SIDE); };
    add_value(app, "--texture-limit", texture_limit, parse,
              concat("a whole number from 1 to ", MAX_IMAGE_SIDE),
              "Shrink images on surfaces to at most SIZE pixels along the longer side (default: never)")
        ->type_name("SIZE");
    add_choice(app, "--missing-images", missing_images, IF_MISSING_NAMES,
               "What to use for missing images of glTF and MTL files (default: "
               "white)");
    add_limits_to(app);
    app.option_defaults()->group("glTF files");
    app.add_option("--scene", gltf.scene, "Scene by name or index (default: the file's)")->type_name("NAME");
    add_value(app, "--time", gltf.time, parse_number, "a number of seconds, such as 1.5",
              "Pose nodes, skins and morphs at this time of the animation (default: not animated)")
        ->type_name("SECONDS");
    app.add_option("--animation", gltf.animation, "Animation by name or index, or all (default: the first)")
        ->type_name("NAME")
        ->needs("--time");
    app.add_option("--variant", gltf.variant, "Variant of the materials by name or index")->type_name("NAME");
    add_choice(app, "--light-units", gltf.light_units, LIGHT_UNITS_NAMES,
               "Units of the lights' intensities (default: blender for files by Blender, otherwise spec)");
    app.add_flag("--double-sided", double_sided,
                 "Show all surfaces from both sides, also those that the file says are single-sided");
    lighting.add_to(app);
}

void LoadingOptions::add_limits_to(CLI::App& app) {
    app.option_defaults()->group("Limits on files and memory");
    app.add_option("--allow-folder", folders,
                   "Also allow files in this folder (default: only those in the folder "
                   "of SCENE); repeat it for several")
        ->type_name("DIR")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->allow_extra_args(false);
    app.add_flag("--allow-any-folder", any_folder, "Allow files in any folder, for scenes that you trust");
    add_value(app, "--memory-limit", memory_limit, parse_memory_size, "a size such as 500M, 1.5GB or 4GiB",
              "Use no more memory than 500M, 1.5GB or 4GiB (default: three quarters of the machine's)")
        ->type_name("SIZE");
}

}  // namespace candela
