// Images on surfaces, and the values of materials that come from them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/math.h"
#include "image/texel_image.h"

namespace candela {

// The largest magnitude of a texture coordinate, so that no transform of one leaves the range of floats.
inline constexpr double MAX_UV = 1e30;

// No number of such a transform is further from 0, for the same reason.
inline constexpr double MAX_UV_TRANSFORM = 1e6;

// How a missing image file is handled.
enum class IfMissing { white, error };

// An image file that textures look up, or one within a scene file.
struct ImageFile {
    std::filesystem::path path;
    std::filesystem::path real_path{};  // The same for all names of the file.
    std::string bytes{};                // The file's contents, if it is within another file.
    // Makes the image, in place of a file; called once, by load_images().
    std::function<TexelImage()> make{};
    // Converts the file's image to this one; none: it is the same.
    std::function<TexelImage(const TexelImage&)> convert{};
    // A glTF file names it: its own gamma is ignored, and messages advise only some formats.
    bool of_gltf = false;
    std::string place{};                        // Where it is named first, for messages.
    IfMissing if_missing = IfMissing::error;    // White: for images of files not written for candela.
    std::shared_ptr<const TexelImage> image{};  // None: not read yet.
};

// How an image continues outside [0, 1] along an axis.
enum class Wrap { repeat, mirror, clamp };

// Interpolation between the centres of texels: none, or linear along both axes, in linear light.
enum class TextureFilter { nearest, bilinear };

// The meaning of the colour channels. Alpha is always linear, as are half floats.
enum class TextureEncoding { linear, srgb };

// Channels of an image. ALPHA_OR_RED means alpha if the image has it, otherwise red, in an opacity until
// load_images() has read its image.
inline constexpr uint32_t RED = 0;
inline constexpr uint32_t ALPHA = 3;
inline constexpr uint32_t ALPHA_OR_RED = 4;

// An image as a function of the coordinates (u, v) of a surface, v upwards: (0, 0) is the lower left corner
// of the image, (1, 1) the upper right one.
struct Texture {
    uint32_t image = 0;  // Index into Scene::images.
    TextureEncoding encoding = TextureEncoding::linear;
    TextureFilter filter = TextureFilter::bilinear;
    Wrap wrap_u = Wrap::repeat;
    Wrap wrap_v = Wrap::repeat;
    uint32_t uv_set = 0;  // 0 or 1.
    uint32_t channel =
        0;  // The one that is taken where a single number is asked for, 0 .. 3: red, green, blue, alpha.
    // The image is looked up at rows[i] . (u, v, 1).
    vec3 rows[2]{{1, 0, 0}, {0, 1, 0}};

    bool operator==(const Texture&) const = default;
};

// A value that is the same everywhere, or that of a texture times a factor.
template <class Value>
struct Textured {
    // Implicit: every plain value is one.
    Textured(const Value& everywhere) : factor(everywhere) {}
    Textured(const Value& times, const Texture& image) : factor(times), texture(image) {}

    Value factor;
    std::optional<Texture> texture{};

    bool operator==(const Textured&) const = default;
};

}  // namespace candela
