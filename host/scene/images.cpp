// See images.h.
#include "scene/images.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "base/color.h"
#include "base/error.h"
#include "base/memory_limit.h"
#include "base/parallel.h"
#include "base/text.h"
#include "image/shrink_image.h"
#include "image/texel_io.h"
#include "scene/images_parts.h"
#include "scene/material_textures.h"

namespace candela {
namespace {

// The same for all names of a file.
std::filesystem::path identity_of(const std::filesystem::path& path) {
    std::error_code ignored;
    const std::filesystem::path real = std::filesystem::weakly_canonical(path, ignored);
    return real.empty() ? path.lexically_normal() : real;
}

// The image of a file whose samples are light^gamma, in sRGB codes of 16 bits.
TexelImage in_srgb(const TexelImage& image) {
    TexelImage result{.size = image.size,
                      .channels = image.channels,
                      .type = TexelType::unorm16,
                      .texels = {},
                      .gamma = {}};
    const size_t count = size_t(image.size.x) * image.size.y;
    result.texels.resize(count * image.channels * byte_size(result.type));
    const bool has_alpha = image.channels % 2 == 0;
    parallel_for(image.size.y, [&](size_t y) {
        for (size_t i = y * image.size.x; i < (y + 1) * image.size.x; ++i) {
            const vec4 codes = texel_codes(image, i);
            for (uint32_t c = 0; c < image.channels; ++c) {
                const bool is_alpha = has_alpha && c + 1 == image.channels;
                const float code =
                    is_alpha ? codes.w : srgb_encode(std::pow(codes[int(c)], float(1.0 / *image.gamma)));
                const auto word = uint16_t(std::lround(65535.0f * code));
                std::memcpy(&result.texels[(i * image.channels + c) * sizeof word], &word, sizeof word);
            }
        }
    });
    return result;
}

// Calls visit(texture) for each texture of sRGB.
template <class Visit>
void for_each_srgb_texture(Scene& scene, const Visit& visit) {
    const auto visit_srgb = [&](Texture& texture) {
        if (texture.encoding == TextureEncoding::srgb) visit(texture);
    };
    for (Material& material : scene.materials)
        for_each_texture(material, visit_srgb);
    for (Shape& shape : scene.shapes) {
        if (shape.emission && shape.emission->radiance.texture) visit_srgb(*shape.emission->radiance.texture);
    }
}

// Lets textures that treat an image with its own gamma as sRGB look up a converted copy.
void convert_gammas(Scene& scene) {
    std::map<uint32_t, uint32_t> copies;
    for_each_srgb_texture(scene, [&](Texture& texture) {
        if (!scene.images[texture.image].image->gamma) return;
        const auto [copy, is_new] = copies.emplace(texture.image, uint32_t(scene.images.size()));
        if (is_new) {
            ImageFile file = scene.images[texture.image];
            file.image = std::make_shared<TexelImage>(in_srgb(*file.image));
            file.real_path.clear();
            scene.images.push_back(std::move(file));
        }
        texture.image = copy->second;
    });
}

// The image of a file.
TexelImage read_image(const Scene& scene, ImageFile& file, std::vector<std::string>& warnings) {
    if (file.bytes.empty()) file.bytes = scene.reach.read(file.path);
    TexelLimits limits;
    if (file.of_gltf) limits.formats = "PNG, JPEG or WebP";
    TexelImage image = decode_texels(file.bytes, file.path, warnings, limits);
    file.bytes = {};
    return image;
}

// A message that begins with the name of an image, with the place before it.
std::string at_place(const ImageFile& file, const std::string& message) {
    return is_within(file) ? message : file.place + ": " + message;
}

}  // namespace

uint32_t add_image_file(Scene& scene, ImageFile file) {
    const auto [known, is_new] =
        scene.image_indices.try_emplace(file.real_path.string(), uint32_t(scene.images.size()));
    if (is_new) scene.images.push_back(std::move(file));
    return known->second;
}

uint32_t add_image(Scene& scene, const std::filesystem::path& path, const std::string& place,
                   IfMissing if_missing) {
    const size_t before = scene.images.size();
    const uint32_t index = add_image_file(scene, {.path = path,
                                                  .real_path = identity_of(path),
                                                  .place = place,
                                                  .if_missing = if_missing,
                                                  .image = {}});
    if (scene.images.size() > before) scene.files.push_back(path);
    IfMissing& strictest = scene.images[index].if_missing;
    strictest = std::max(strictest, if_missing);
    return index;
}

uint32_t add_image_bytes(Scene& scene, const std::string& name, std::string_view bytes,
                         const std::string& place) {
    ImageFile file{.path = name,
                   .real_path = concat('#', std::hash<std::string_view>()(bytes), '/', bytes.size()),
                   .bytes = std::string(bytes),
                   .place = place,
                   .image = {}};
    const auto known = scene.image_indices.find(file.real_path.string());
    // Other bytes with the same hash.
    if (known != scene.image_indices.end() && scene.images[known->second].bytes != bytes)
        file.real_path = name;
    return add_image_file(scene, std::move(file));
}

void load_images(Scene& scene, const ImageOptions& options, const LoadProgress& progress,
                 DecodedImages& decoded) {
    std::vector<TexelCodes> codes(scene.images.size(), TexelCodes::linear);
    for_each_srgb_texture(scene, [&](const Texture& texture) { codes[texture.image] = TexelCodes::encoded; });
    std::vector<DecodedImage*> kept;
    for (size_t i = 0; i < scene.images.size(); ++i) {
        ImageFile& file = scene.images[i];
        kept.push_back(&decoded[concat(file.path.string(), '\n', file.real_path.string(), '\n', int(codes[i]),
                                       int(file.of_gltf))]);
        if (!file.image) file.image = kept[i]->image;
    }
    drop_missing_images(scene, options);
    std::mutex mutex;
    size_t done = 0;
    parallel_for(scene.images.size(), [&](size_t i) {
        ImageFile& file = scene.images[i];
        if (file.image) return;
        const auto load = [&] {
            kept[i]->warnings.clear();  // From an attempt that failed.
            TexelImage image = file.make ? file.make() : read_image(scene, file, kept[i]->warnings);
            if (file.of_gltf) image.gamma.reset();
            if (file.convert) image = file.convert(image);
            file.image =
                std::make_shared<TexelImage>(shrink(std::move(image), options.texture_limit, codes[i]));
            kept[i]->image = file.image;
        };
        try {
            with_memory_for(
                "the image", [&] { return file.path.string(); }, load);
        } catch (const Error& error) {
            throw Error(at_place(file, error.what()), error.kind());
        }
        const std::lock_guard lock(mutex);
        progress("images", ++done, scene.images.size());
    });
    for (size_t i = 0; i < scene.images.size(); ++i) {
        scene.images[i].bytes = {};
        scene.images[i].make = {};
        for (const std::string& warning : kept[i]->warnings)
            scene.warnings.push_back(at_place(scene.images[i], warning));
    }
    convert_gammas(scene);
    check_maps(scene);
}

}  // namespace candela
