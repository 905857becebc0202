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

// The mean normal of a bumpy surface points away from it.
bool points_up(vec4 mean) {
    constexpr float FAR = 0.2f;
    return mean.z > 0.6f && std::abs(mean.x - 0.5f) < FAR && std::abs(mean.y - 0.5f) < FAR;
}

// Whether an image is within the file that names it, as its name then says.
bool is_within(const ImageFile& file) {
    return file.place.starts_with(file.path.string());
}

// A message that begins with the name of an image, with the place before it.
std::string at_place(const ImageFile& file, const std::string& message) {
    return is_within(file) ? message : file.place + ": " + message;
}

// `PLACE: the normal map of the material "x", FILE,`.
std::string map_text(const ImageFile& file, const char* what, const Material& material) {
    const std::string name = is_within(file) ? "" : ", " + file.path.string() + ',';
    return concat(file.place, ": the ", what, " of the material \"",
                  printable(material.name, MOST_NAME_BYTES), '"', name);
}

// The mean codes of a scene's images, each computed once.
class MeanCodes {
  public:
    explicit MeanCodes(const Scene& scene) : scene_(scene) {}

    vec4 of(uint32_t image) {
        const auto [known, is_new] = means_.try_emplace(image);
        if (is_new) known->second = mean_codes(*scene_.images[image].image);
        return known->second;
    }

  private:
    const Scene& scene_;
    std::map<uint32_t, vec4> means_;
};

// Messages call the map `what`.
void check_normal_map(Scene& scene, MeanCodes& means, const Material& material, const NormalMap& map,
                      const char* what) {
    const ImageFile& file = scene.images[map.texture.image];
    const vec4 mean = means.of(map.texture.image);
    if (points_up(mean)) return;
    scene.warnings.push_back(concat(map_text(file, what, material), " has a mean of ",
                                    number_text(double(mean.x), 2), ' ', number_text(double(mean.y), 2), ' ',
                                    number_text(double(mean.z), 2),
                                    ", not about 0.5 0.5 1; is it one in tangent space?"));
}

// Whether an image of that mean is blue as a normal map in tangent space is.
bool is_blue(vec4 mean) {
    constexpr float LEAST = 0.15f;  // The value for a map with slopes of 70 degrees everywhere.
    return points_up(mean) && mean.z - std::max(mean.x, mean.y) > LEAST;
}

// Many files name normal maps as bump maps.
void check_bump_map(Scene& scene, MeanCodes& means, Material& material) {
    const BumpMap bump = *material.bump_map;
    const ImageFile& file = scene.images[bump.texture.image];
    const vec4 mean = means.of(bump.texture.image);
    if (!is_blue(mean)) return;
    const std::string what = map_text(file, "bump map", material) + " has the colours of a normal map";
    if (!bump.multiplier) {
        scene.warnings.push_back(what + "; if it is one, name it as normal_map");
        return;
    }
    material.normal_map = {bump.texture, *bump.multiplier};
    material.bump_map.reset();
    scene.warnings.push_back(what + " and is read as one; to say so, name it as norm");
}

// Whether an image that may be missing is missing or out of reach. Nothing may reveal whether an image out of
// reach exists.
bool is_lost(const Scene& scene, const ImageFile& file, const ImageOptions& options) {
    if (std::max(file.if_missing, options.if_missing) == IfMissing::error) return false;
    if (file.image || !file.bytes.empty()) return false;
    if (!scene.reach.holds(file.path)) return true;
    std::error_code ignored;
    return std::filesystem::status(file.path, ignored).type() == std::filesystem::file_type::not_found;
}

// Replaces lost images by a white texel, and removes them from materials.
void drop_lost_images(Scene& scene, const std::vector<bool>& lost) {
    const auto drop = [&](auto& texture) {
        if (texture && lost[texture->image]) texture.reset();
    };
    const auto drop_map = [&](auto& map) {
        if (map && lost[map->texture.image]) map.reset();
    };
    for (Material& material : scene.materials) {
        if (auto* principled = std::get_if<PrincipledMaterial>(&material.model)) {
            const std::optional<Texture>& texture = principled->emission.texture;
            if (texture && lost[texture->image]) principled->emission = vec3(0.0f);
            drop(principled->anisotropy_map);
            drop_map(principled->coat_normal_map);
        }
        std::visit([&](auto& model) { for_each_value(model, [&](auto& value) { drop(value.texture); }); },
                   material.model);
        drop(material.opacity.value.texture);
        drop_map(material.normal_map);
        drop_map(material.bump_map);
    }
    for (Shape& shape : scene.shapes) {
        if (!shape.emission) continue;
        const std::optional<Texture>& texture = shape.emission->radiance.texture;
        if (texture && lost[texture->image]) shape.emission.reset();
    }
}

// Drops missing images that may be missing, with one warning, and images out of reach, with another.
void drop_missing_images(Scene& scene, const ImageOptions& options) {
    constexpr size_t MOST_LISTED = 10;
    std::vector<bool> lost(scene.images.size());
    size_t count = 0, outside = 0;
    std::string names, place, refusal;
    for (size_t i = 0; i < lost.size(); ++i) {
        ImageFile& file = scene.images[i];
        if (!is_lost(scene, file, options)) continue;
        const TexelImage white{.size = uvec2(1),
                               .channels = 1,
                               .type = TexelType::unorm8,
                               .texels = {std::byte(255)},
                               .gamma = {}};
        file.image = std::make_shared<TexelImage>(file.convert ? file.convert(white) : white);
        if (file.convert) continue;  // The copy of an image that is lost, too.
        lost[i] = true;
        if (!scene.reach.holds(file.path)) {
            if (outside++ == 0) refusal = file.place + ": " + scene.reach.refusal(file.path.string());
            continue;
        }
        if (count == 0) place = file.place;
        if (count < MOST_LISTED) names += (count == 0 ? "" : ", ") + quoted(file.path);
        ++count;
    }
    if (count + outside > 0) drop_lost_images(scene, lost);
    if (outside > 0) {
        const std::string times = outside == 1 ? "" : concat(" (", outside, " times)");
        scene.warnings.push_back(refusal + "; white is used instead" + times);
    }
    if (count == 0) return;
    if (count > MOST_LISTED) names += ", ...";
    const std::string which = count == 1
                                  ? concat("the image ", names, " does not exist; white is used instead")
                                  : concat(count, " images do not exist; white is used instead: ", names);
    scene.warnings.push_back(place + ": " + which);
}

// Replaces ALPHA_OR_RED in the texture of an opacity.
void choose_channel(const Scene& scene, Texture& texture) {
    if (texture.channel != ALPHA_OR_RED) return;
    texture.channel = scene.images[texture.image].image->channels % 2 == 0 ? ALPHA : RED;
}

void check_opacity(Scene& scene, const Material& material) {
    const Texture& texture = *material.opacity.value.texture;
    const ImageFile& file = scene.images[texture.image];
    if (texture.channel != ALPHA || file.image->channels % 2 == 0) return;
    scene.warnings.push_back(
        concat(file.place, ": the opacity of the material \"", printable(material.name, MOST_NAME_BYTES),
               "\" is the alpha of ", is_within(file) ? "the image" : file.path.string(),
               ", which has none: it is opaque", file.of_gltf ? "" : "; name another channel"));
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
        file.image = kept[i]->image;
    }
    drop_missing_images(scene, options);
    std::mutex mutex;
    size_t done = 0;
    parallel_for(scene.images.size(), [&](size_t i) {
        ImageFile& file = scene.images[i];
        if (file.image) return;
        const auto load = [&] {
            kept[i]->warnings.clear();  // From an attempt that failed.
            if (file.bytes.empty()) file.bytes = scene.reach.read(file.path);
            TexelLimits limits;
            if (file.of_gltf) limits.formats = "PNG, JPEG or WebP";
            TexelImage image = decode_texels(file.bytes, file.path, kept[i]->warnings, limits);
            file.bytes = {};
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
            throw Error(at_place(file, error.what()), error.code());
        }
        const std::lock_guard lock(mutex);
        progress("images", ++done, scene.images.size());
    });
    for (size_t i = 0; i < scene.images.size(); ++i) {
        scene.images[i].bytes = {};
        for (const std::string& warning : kept[i]->warnings)
            scene.warnings.push_back(at_place(scene.images[i], warning));
    }
    convert_gammas(scene);
    check_maps(scene);
}

}  // namespace candela
