// Images that do not exist, and what their materials become: see images_parts.h.
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/file.h"
#include "base/text.h"
#include "image/texel_image.h"
#include "scene/images_parts.h"
#include "scene/material_textures.h"

namespace candela {
namespace {

// Whether an image that may be missing is missing or out of reach. Nothing may reveal whether an image out of
// reach exists.
bool is_lost(const Scene& scene, const ImageFile& file, const ImageOptions& options) {
    if (std::max(file.if_missing, options.if_missing) == IfMissing::error) return false;
    if (file.image || !file.bytes.empty() || file.make) return false;
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

}  // namespace

void drop_missing_images(Scene& scene, const ImageOptions& options) {
    constexpr size_t MAX_LISTED = 10;
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
        if (count < MAX_LISTED) names += (count == 0 ? "" : ", ") + quoted(file.path);
        ++count;
    }
    if (count + outside > 0) drop_lost_images(scene, lost);
    if (outside > 0) {
        const std::string times = outside == 1 ? "" : concat(" (", outside, " times)");
        scene.warnings.push_back(refusal + "; white is used instead" + times);
    }
    if (count == 0) return;
    if (count > MAX_LISTED) names += ", ...";
    const std::string which = count == 1
                                  ? concat("the image ", names, " does not exist; white is used instead")
                                  : concat(count, " images do not exist; white is used instead: ", names);
    scene.warnings.push_back(place + ": " + which);
}

}  // namespace candela
