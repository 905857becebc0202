// Ref: Khronos, "glTF 2.0 Specification", sections 3.8 and 3.9.7.
#include "load/gltf/texture.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/text.h"
#include "image/texel_io.h"
#include "load/gltf/extensions.h"
#include "load/gltf/uri.h"
#include "load/gltf/values.h"
#include "scene/images.h"

namespace candela::gltf {
namespace {

// The numbers of OpenGL.
constexpr uint32_t NEAREST = 9728;
constexpr uint32_t CLAMP = 10496;
constexpr uint32_t CLAMP_TO_BORDER = 33069;
constexpr uint32_t CLAMP_TO_EDGE = 33071;
constexpr uint32_t MIRRORED_REPEAT = 33648;
constexpr uint32_t REPEAT = 10497;

Wrap read_wrap_mode(File& file, const Node& sampler, std::string_view key) {
    const auto node = sampler.find(key);
    const uint32_t mode = node ? node->integer(0, UINT32_MAX) : REPEAT;
    if (mode == CLAMP_TO_EDGE) return Wrap::clamp;
    if (mode == MIRRORED_REPEAT) return Wrap::mirror;
    if (mode == REPEAT) return Wrap::repeat;
    const bool clamps = mode == CLAMP || mode == CLAMP_TO_BORDER;
    file.warn(*node,
              concat(mode, " is not 33071, 33648 or 10497; ", clamps ? CLAMP_TO_EDGE : REPEAT, " is used"));
    return clamps ? Wrap::clamp : Wrap::repeat;
}

void read_texture_sampler(File& file, const Node& sampler, Texture& texture) {
    const auto filter = sampler.find("magFilter");
    if (filter && filter->integer(0, UINT32_MAX) == NEAREST) texture.filter = TextureFilter::nearest;
    texture.wrap_u = read_wrap_mode(file, sampler, "wrapS");
    texture.wrap_v = read_wrap_mode(file, sampler, "wrapT");
}

// The rows of KHR_texture_transform for coordinates with v upwards. The extension's v grows downwards:
// u' = a u + b v + c, v' = d u + e v + f, with 1 - v and 1 - v' for v and v'.
void read_transform_of_uvs(const Node& transform, Texture& texture) {
    dvec3 offset(0.0), scale(1.0);
    const auto pair = [&](std::string_view key, dvec3& value) {
        const auto node = transform.find(key);
        if (!node) return;
        const std::vector<double> numbers = node->numbers(2);
        for (size_t i = 0; i < 2; ++i) {
            if (std::abs(numbers[i]) > MAX_UV_TRANSFORM) node->fail_expected("numbers from -1e6 to 1e6");
            value[glm::length_t(i)] = numbers[i];
        }
    };
    pair("offset", offset);
    pair("scale", scale);
    const auto rotation = transform.find("rotation");
    const double angle = rotation ? rotation->number() : 0.0;
    const double c = std::cos(angle), s = std::sin(angle);
    const double a = c * scale.x, b = s * scale.y, d = -s * scale.x, e = c * scale.y;
    texture.rows[0] = vec3(dvec3(a, -b, b + offset.x));
    texture.rows[1] = vec3(dvec3(-d, e, 1.0 - e - offset.y));
}

// The index of a texture's image; nothing if no image can be read.
std::optional<Node> image_of(const Node& texture) {
    const auto source_of = [&](std::string_view extension) {
        const auto found = extension_of(texture, extension);
        return found ? found->find("source") : std::nullopt;
    };
    if (const auto webp = source_of("EXT_texture_webp")) return webp;
    const auto ktx = reads_ktx_texels() ? source_of(KTX_IMAGES) : std::nullopt;
    return ktx ? ktx : texture.find("source");
}

// Why there is none.
std::string reason_without_image(const Node& texture) {
    for (const std::string_view name :
         std::initializer_list<std::string_view>{KTX_IMAGES, "EXT_texture_avif", "MSFT_texture_dds"}) {
        if (extension_of(texture, name))
            return concat("the texture has an image of ", name, " only, which is not read");
    }
    return "the texture has no image";
}

// Whether an image says where its bytes are.
bool has_bytes(const Node& image) {
    const auto uri = image.find("uri");
    return image.find("bufferView") || (uri && !uri->string().empty());
}

}  // namespace

uint32_t read_image(File& file, Scene& scene, const Node& reference) {
    const uint32_t index = file.index("images", reference);
    const Node image = file.element("images", index);
    auto uri = image.find("uri");
    const auto view = image.find("bufferView");
    if (view && uri && uri->string().empty()) uri.reset();
    if (uri.has_value() == view.has_value())
        image.fail("an image has either a uri or a bufferView; export the file again");
    const std::string name = concat(file.path().string(), "#/images/", index);
    const auto add = [&] {
        if (view) {
            const std::span<const std::byte> bytes = file.view_bytes(file.resolve("bufferViews", *view));
            const auto* begin = reinterpret_cast<const char*>(bytes.data());
            return add_image_bytes(scene, name, {begin, bytes.size()}, image.place());
        }
        if (const auto data = inline_data(*uri)) return add_image_bytes(scene, name, *data, uri->place());
        return add_image(scene, file.named(*uri), uri->place(), IfMissing::white);
    };
    std::optional<uint32_t>& known = file.image_index(index);
    if (known) return *known;
    known = add();
    scene.images[*known].of_gltf = true;  // Section 3.8.3: colour profiles are ignored.
    return *known;
}

std::optional<Texture> read_texture(File& file, Scene& scene, const Node& info, TextureEncoding encoding,
                                    uint32_t channel) {
    const Node element = file.resolve("textures", info.require("index"));
    const auto source = image_of(element);
    if (!source) {
        file.warn(element, reason_without_image(element) + "; it is white");
        return std::nullopt;
    }
    if (!has_bytes(file.resolve("images", *source))) {
        file.warn(file.resolve("images", *source),
                  "the image has neither a uri nor a bufferView; it is white");
        return std::nullopt;
    }
    Texture texture{.image = read_image(file, scene, *source), .encoding = encoding, .channel = channel};
    if (const auto sampler = element.find("sampler")) {
        if (file.count("samplers") == 0) {
            file.warn(*sampler, "the file has no samplers; the texture repeats");
        } else {
            read_texture_sampler(file, file.resolve("samplers", *sampler), texture);
        }
    }
    auto set = info.find("texCoord");
    if (const auto transform = extension_of(info, "KHR_texture_transform")) {
        read_transform_of_uvs(*transform, texture);
        if (const auto other = transform->find("texCoord")) set = other;
    }
    texture.uv_set = set ? set->integer(0, UINT32_MAX) : 0;
    if (texture.uv_set > 1) {
        file.warn(*set, "only TEXCOORD_0 and TEXCOORD_1 are read; TEXCOORD_0 is used");
        texture.uv_set = 0;
    }
    return texture;
}

}  // namespace candela::gltf
