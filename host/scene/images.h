// The image files that a scene's textures look up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scene/load_progress.h"
#include "scene/scene.h"

namespace candela {

// The index of an image file in scene.images, to which it is added if necessary; load_images() reads it.
// Messages about it begin with `place`. A missing file is an error if any of its callers says so.
uint32_t add_image(Scene& scene, const std::filesystem::path& path, const std::string& place,
                   IfMissing if_missing = IfMissing::error);

// The same for an image file within another file: these are its bytes, and messages call it `name`. Images
// with the same bytes are one.
uint32_t add_image_bytes(Scene& scene, const std::string& name, std::string_view bytes,
                         const std::string& place);

// The index of an image in scene.images, to which it is added unless one with the same real_path is there.
uint32_t add_image_file(Scene& scene, ImageFile file);

// Images that have been decoded with one texture_limit, for further scenes.
struct DecodedImage {
    std::shared_ptr<const TexelImage> image;
    std::vector<std::string> warnings;
};
using DecodedImages = std::map<std::string, DecodedImage>;

struct ImageOptions {
    // Images with more texels along a side are shrunk.
    uint32_t texture_limit = UINT32_MAX;
    IfMissing if_missing = IfMissing::white;  // Error: for all images.
};

// Reads all images that have not been read, on all cores. An image of a PNG file with another gamma than
// sRGB's is converted for textures of sRGB, but not for others. Chooses the channel of opacities that depend
// on their image (ALPHA_OR_RED), and turns bump maps of mesh files that are really normal maps into such. If
// an image may be missing and is missing, or is out of reach, its textures are removed: factors remain, and
// emission ends. Throws Error if an image cannot be read; scene.warnings gets what is odd but usable. Images
// in `decoded` are shared; others are added to it.
void load_images(Scene& scene, const ImageOptions& options, const LoadProgress& progress,
                 DecodedImages& decoded);

}  // namespace candela
