// See loader_textures.h.
#include "load/json/loader_textures.h"

#include <cmath>

#include "base/error.h"
#include "load/json/arrays.h"
#include "load/json/keys.h"
#include "scene/images.h"
#include "scene/names.h"

namespace candela {
namespace {

// Two numbers that floats can hold.
glm::dvec2 pair_of(const Node& node) {
    const std::vector<Node> elements = node.elements();
    if (elements.size() != 2) node.fail_expected("two numbers");
    return {elements[0].number(), elements[1].number()};
}

void read_wrap(const Node& node, Texture& texture) {
    if (node.is_string()) {
        texture.wrap_u = texture.wrap_v = node.choice(WRAP_NAMES);
        return;
    }
    const std::vector<Node> elements = node.elements();
    if (elements.size() != 2) node.fail_expected("a name, or one for each of u and v");
    texture.wrap_u = elements[0].choice(WRAP_NAMES);
    texture.wrap_v = elements[1].choice(WRAP_NAMES);
}

// uv_scale, then uv_rotation, then uv_offset.
void read_uv_transform(const Node& node, Texture& texture) {
    const auto checked = [&](const Node& value, glm::dvec2 v) {
        if (std::abs(v.x) > MAX_UV_TRANSFORM || std::abs(v.y) > MAX_UV_TRANSFORM)
            value.fail_expected("numbers from -1e6 to 1e6");
        return v;
    };
    glm::dvec2 scale(1.0), offset(0.0);
    double angle = 0.0;
    if (const auto value = node.find("uv_scale"))
        scale = checked(*value, value->is_number() ? glm::dvec2(value->number()) : pair_of(*value));
    if (const auto value = node.find("uv_offset")) offset = checked(*value, pair_of(*value));
    if (const auto value = node.find("uv_rotation")) angle = value->angle();
    const double c = std::cos(angle), s = std::sin(angle);
    texture.rows[0] = vec3(dvec3(c * scale.x, -s * scale.y, offset.x));
    texture.rows[1] = vec3(dvec3(s * scale.x, c * scale.y, offset.y));
}

}  // namespace

std::filesystem::path find_file(const Node& name, const std::filesystem::path& folder,
                                const FileReach& reach) {
    const std::string& file = name.file_name();
    try {
        return reach.find(folder, file);
    } catch (const Error& error) {
        name.fail(error.what());
    }
}

Texture read_texture(const Node& node, const ImageFolder& folder, TextureEncoding encoding,
                     std::string_view more_keys) {
    node.allow_only({}, keys_of({"texture", more_keys}));
    const Node image = node.require("image");
    Texture texture{.encoding = encoding};
    texture.image =
        is_array_name(image)
            ? add_image_array(image, folder.scene)
            : add_image(folder.scene, find_file(image, folder.path, folder.scene.reach), image.place());
    if (const auto value = node.find("encoding")) texture.encoding = value->choice(ENCODING_NAMES);
    if (const auto value = node.find("wrap")) read_wrap(*value, texture);
    if (const auto value = node.find("filter")) texture.filter = value->choice(FILTER_NAMES);
    if (const auto value = node.find("channel")) texture.channel = value->choice(CHANNEL_NAMES);
    if (const auto value = node.find("uv_set"))
        texture.uv_set = read_integer(*value, scene_key("texture", "uv_set"));
    read_uv_transform(node, texture);
    return texture;
}

Textured<vec3> read_radiance(const Node& node, const ImageFolder& folder) {
    if (!node.is_object()) return vec3(node.rgb());
    const auto factor = node.find("factor");
    return {factor ? vec3(factor->rgb()) : vec3(1.0f),
            read_texture(node, folder, TextureEncoding::srgb, "textured")};
}

NormalMap read_normal_map(const Node& node, const ImageFolder& folder) {
    NormalMap map{.texture = read_texture(node, folder, TextureEncoding::linear, "normal_map")};
    if (const auto scale = node.find("scale"))
        map.scale = read_number(*scale, scene_key("normal_map", "scale"));
    return map;
}

BumpMap read_bump_map(const Node& node, const ImageFolder& folder) {
    BumpMap map{.texture = read_texture(node, folder, TextureEncoding::linear, "bump_map")};
    map.scale = float(node.require("scale").number());
    return map;
}

Opacity read_opacity(const Node& node, const ImageFolder& folder) {
    Opacity opacity;
    if (!node.is_object()) {
        opacity.value = read_number(node, scene_key("opacity", "factor"));
        return opacity;
    }
    const auto factor = node.find("factor");
    Texture texture = read_texture(node, folder, TextureEncoding::linear, "opacity");
    if (!node.find("channel")) texture.channel = ALPHA;
    opacity.value = {factor ? read_number(*factor, scene_key("opacity", "factor")) : 1.0f, texture};
    if (const auto cutoff = node.find("cutoff"))
        opacity.cutoff = read_number(*cutoff, scene_key("opacity", "cutoff"));
    return opacity;
}

Textured<dvec3> read_reflectance(const Node& node, const ImageFolder& folder) {
    if (!node.is_object()) return node.reflectance();
    const auto factor = node.find("factor");
    return {factor ? factor->reflectance() : dvec3(1.0),
            read_texture(node, folder, TextureEncoding::srgb, "textured")};
}

Textured<vec3> as_floats(const Textured<dvec3>& color) {
    Textured<vec3> result(vec3(color.factor));
    result.texture = color.texture;
    return result;
}

Textured<vec3> read_color(const Node& node, const ImageFolder& folder) {
    return as_floats(read_reflectance(node, folder));
}

Textured<float> read_number(const Node& node, const ImageFolder& folder, Range range) {
    if (!node.is_object()) return node.number(range.min, range.max);
    const auto factor = node.find("factor");
    return {factor ? factor->number(0.0f, range.max) : 1.0f,
            read_texture(node, folder, TextureEncoding::linear, "textured")};
}

}  // namespace candela
