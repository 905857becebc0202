// What the images that materials look up are, once they are read: see images_parts.h.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <variant>

#include "base/printable.h"
#include "base/text.h"
#include "image/texel_image.h"
#include "scene/images_parts.h"

namespace candela {
namespace {

// The mean of some thousand texels all over the image. They follow a sequence that agrees with no pattern of
// rows and columns. Ref: Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences" (2018).
vec4 mean_codes(const TexelImage& image) {
    constexpr size_t MAX = 4096;
    constexpr double STEP_X = 0.7548776662466927, STEP_Y = 0.5698402909980532;
    const size_t count = size_t(image.size.x) * image.size.y;
    const size_t taken = std::min(count, MAX);
    vec4 sum(0.0f);
    for (size_t i = 0; i < taken; ++i) {
        const glm::dvec2 p = fract(double(i) * glm::dvec2(STEP_X, STEP_Y)) * glm::dvec2(image.size);
        sum += texel_codes(image, count <= MAX ? i : size_t(p.y) * image.size.x + size_t(p.x));
    }
    return sum / float(taken);
}

// The mean normal of a bumpy surface points away from it.
bool points_up(vec4 mean) {
    constexpr float FAR = 0.2f;
    return mean.z > 0.6f && std::abs(mean.x - 0.5f) < FAR && std::abs(mean.y - 0.5f) < FAR;
}

// `PLACE: the normal map of the material "x", FILE,`.
std::string map_text(const ImageFile& file, const char* what, const Material& material) {
    const std::string name = is_within(file) ? "" : ", " + file.path.string() + ',';
    return concat(file.place, ": the ", what, " of the material \"", printable(material.name, MAX_NAME_BYTES),
                  '"', name);
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
    constexpr float MIN = 0.15f;  // The value for a map with slopes of 70 degrees everywhere.
    return points_up(mean) && mean.z - std::max(mean.x, mean.y) > MIN;
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
        concat(file.place, ": the opacity of the material \"", printable(material.name, MAX_NAME_BYTES),
               "\" is the alpha of ", is_within(file) ? "the image" : file.path.string(),
               ", which has none: it is opaque", file.of_gltf ? "" : "; name another channel"));
}

}  // namespace

void check_maps(Scene& scene) {
    MeanCodes means(scene);
    for (Material& material : scene.materials) {
        if (material.normal_map) check_normal_map(scene, means, material, *material.normal_map, "normal map");
        const auto* principled = std::get_if<PrincipledMaterial>(&material.model);
        if (principled != nullptr && principled->coat_normal_map)
            check_normal_map(scene, means, material, *principled->coat_normal_map, "coat's normal map");
        if (material.bump_map) check_bump_map(scene, means, material);
        if (!material.opacity.value.texture) continue;
        choose_channel(scene, *material.opacity.value.texture);
        check_opacity(scene, material);
    }
}

}  // namespace candela
