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

// The index of an image file in scene.images, which it joins if it is not there yet; load_images() reads it.
// `place` is what messages about it begin with. It is an error if it is missing and any of those who add it
// say so.
uint32_t add_image(Scene& scene, const std::filesystem::path& path, const std::string& place,
                   IfMissing if_missing = IfMissing::error);

// The same for an image file that is within another one: these are its bytes, and messages call it `name`.
// Images of the same bytes are one.
uint32_t add_image_bytes(Scene& scene, const std::string& name, std::string_view bytes,
                         const std::string& place);

// The index of an image in scene.images, which it joins unless one of its real_path has been added.
uint32_t add_image_file(Scene& scene, ImageFile file);

// Images that have been decoded with one texture_limit, for further scenes.
struct DecodedImage {
    std::shared_ptr<const TexelImage> image;
    std::vector<std::string> warnings;
};
using DecodedImages = std::map<std::string, DecodedImage>;

struct ImageOptions {
    // Images with more texels along a side are made smaller.
    uint32_t texture_limit = UINT32_MAX;
    IfMissing if_missing = IfMissing::white;  // Error: for all images.
};

// Reads all images that have not been read, on all cores. An image that a PNG file says has another gamma
// than sRGB's is converted for textures of sRGB; others take it as it is. Chooses the channel of opacities
// that wait for their image (ALPHA_OR_RED), and turns bump maps of mesh files into normal maps where they are
// some. Where an image may be missing and is, or is out of reach, its textures go: factors remain, and
// emission ends. Throws Error if one cannot be read; what is odd but usable goes to scene.warnings.
// Images among `decoded` are shared with it, others join it.
void load_images(Scene& scene, const ImageOptions& options, const LoadProgress& progress,
                 DecodedImages& decoded);

}  // namespace candela
