// See textures.h.
#include "selftest/textures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <glm/packing.hpp>

#include "base/text.h"
#include "probe/probes.h"
#include "probe/random.h"
#include "probe/scenes.h"

namespace candela {
namespace {

using glm::dvec2;
using glm::dvec4;

// An image of random texels.
TexelImage random_image(uvec2 size, uint32_t channels, TexelType type, uint32_t seed) {
    TexelImage image{.size = size, .channels = channels, .type = type, .texels = {}, .gamma = {}};
    Random random(seed);
    const size_t count = size_t(size.x) * size.y * channels;
    for (size_t i = 0; i < count; ++i) {
        uint16_t code = uint16_t(random.unit() * 65536.0f);
        // Halves of every size from the least denormal one on.
        if (type == TexelType::half) code = uint16_t(code % 0x5C00u);
        const auto* bytes = reinterpret_cast<const std::byte*>(&code);
        image.texels.insert(image.texels.end(), bytes, bytes + byte_size(type));
    }
    return image;
}

double srgb(double code) {
    return code > 0.04045 ? std::pow((code + 0.055) / 1.055, 2.4) : code / 12.92;
}

// The texel (x, y), within the image.
dvec4 texel_of(const TexelImage& image, bool is_srgb, uint32_t x, uint32_t y) {
    double codes[4]{};
    for (uint32_t c = 0; c < image.channels; ++c) {
        const size_t place = (size_t(y) * image.size.x + x) * image.channels + c;
        uint16_t code = 0;
        std::memcpy(&code, image.texels.data() + place * byte_size(image.type), byte_size(image.type));
        codes[c] = image.type == TexelType::half      ? double(glm::unpackHalf2x16(code).x)
                   : image.type == TexelType::unorm16 ? code / 65535.0
                                                      : code / 255.0;
    }
    const bool grey = image.channels < 3;
    dvec4 value(codes[0], grey ? codes[0] : codes[1], grey ? codes[0] : codes[2], 1.0);
    if (image.channels == 2 || image.channels == 4) value.w = codes[image.channels - 1];
    if (is_srgb && image.type != TexelType::half) {
        for (glm::length_t c = 0; c < 3; ++c)
            value[c] = srgb(value[c]);
    }
    return value;
}

// Texel i along an axis of n, for any i.
int wrapped(int i, int n, Wrap wrap) {
    if (wrap == Wrap::clamp) return std::clamp(i, 0, n - 1);
    const int period = wrap == Wrap::repeat ? n : 2 * n;
    const int within = ((i % period) + period) % period;
    return within < n ? within : 2 * n - 1 - within;
}

}  // namespace

Scene texture_scene() {
    struct Kind {
        uint32_t channels;
        TexelType type;
    };
    constexpr std::array<Kind, 8> KINDS{{{1, TexelType::unorm8},
                                         {2, TexelType::unorm8},
                                         {3, TexelType::unorm8},
                                         {4, TexelType::unorm8},
                                         {1, TexelType::unorm16},
                                         {4, TexelType::unorm16},
                                         {3, TexelType::half},
                                         {4, TexelType::half}}};
    constexpr std::array<uvec2, 5> SIZES{uvec2(1, 1), uvec2(2, 3), uvec2(64, 64), uvec2(101, 30),
                                         uvec2(7, 250)};
    constexpr std::array WRAPS{Wrap::repeat, Wrap::mirror, Wrap::clamp};
    Scene scene;
    uint32_t i = 0;
    for (const Kind kind : KINDS) {
        for (const uvec2 size : SIZES)
            scene.images.push_back({.path = {},
                                    .image = std::make_shared<TexelImage>(
                                        random_image(size, kind.channels, kind.type, 100 + i++))});
    }
    Random random(5);
    for (i = 0; i < scene.images.size() * 18; ++i) {
        Texture texture{.image = i / 18,
                        .encoding = i % 2 == 0 ? TextureEncoding::srgb : TextureEncoding::linear,
                        .filter = i % 18 < 14 ? TextureFilter::bilinear : TextureFilter::nearest,
                        .wrap_u = WRAPS[i % 3],
                        .wrap_v = WRAPS[i / 3 % 3],
                        .channel = i / 2 % 4};
        if (i % 5 == 4) {
            for (vec3& row : texture.rows)
                row = 3.0f * random.cube() - 1.5f;
        }
        scene.materials.push_back(
            {concat("material ", i), DiffuseMaterial{Textured<vec3>(vec3(1), texture)}});
    }
    return scene;
}

std::vector<TextureItem> texture_items(const Scene& scene, size_t count) {
    Random random(6);
    std::vector<TextureItem> items;
    for (size_t i = 0; i < count; ++i) {
        const auto texture = uint32_t(i % scene.materials.size());
        const uvec2 size = scene.images[texture / 18].image->size;
        vec2 uv = 8.0f * random.square() - 4.0f;
        for (int axis = 0; axis < 2; ++axis) {
            const auto n = float(size[axis]);
            const float u = random.unit();
            if (u < 0.2f)
                uv[axis] = std::floor(uv[axis] * n * 2.0f) / (n * 2.0f);  // A centre or an edge of a texel.
            if (u < 0.1f) uv[axis] = std::floor(uv[axis]);
            if (u < 0.05f) uv[axis] = std::nextafter(uv[axis], 10.0f);
            if (u < 0.025f) uv[axis] = std::nextafter(uv[axis], -10.0f);
            if (std::abs(uv[axis]) < FLOAT_MIN) uv[axis] = 0.0f;  // Devices may flush denormals.
            if (u > 0.99f) uv[axis] *= 1000.0f;
        }
        items.push_back({texture, uv});
    }
    return items;
}

std::vector<TextureValue> run_textures(const vk::Device& device, const GpuScene& gpu, SceneAccess access,
                                       const std::vector<TextureItem>& items) {
    const DeviceScene on_device(device, gpu, access);
    return probe<TextureValue>(device, kernels::texture, items, traversal_constants(gpu), &on_device);
}

TextureReference::TextureReference(const Scene& scene) : scene_(scene) {
    for (const bool is_srgb : {false, true}) {
        for (const ImageFile& file : scene.images) {
            std::vector<dvec4>& texels = texels_[is_srgb].emplace_back();
            for (uint32_t y = 0; y < file.image->size.y; ++y) {
                for (uint32_t x = 0; x < file.image->size.x; ++x)
                    texels.push_back(texel_of(*file.image, is_srgb, x, y));
            }
        }
    }
}

const Texture& TextureReference::texture(uint32_t i) const {
    return *std::get<DiffuseMaterial>(scene_.materials[i].model).reflectance.texture;
}

// Three products and two sums of the place, wrapping it, and scaling it by the number of texels: six
// roundings of the greatest term. The values of texels are good to 8e-5 (sRGB), or to two roundings; so are
// the weights' sums.
TextureBounds TextureReference::at(uint32_t i, vec2 uv) const {
    const Texture& t = texture(i);
    const bool is_srgb = t.encoding == TextureEncoding::srgb;
    const bool nearest = t.filter == TextureFilter::nearest;
    const std::vector<dvec4>& texels = texels_[is_srgb][t.image];
    const glm::ivec2 n(scene_.images[t.image].image->size);
    dvec2 x, slack;
    for (int axis = 0; axis < 2; ++axis) {
        const dvec3 terms = dvec3(t.rows[axis]) * dvec3(uv.x, uv.y, 1.0);
        const double at = terms.x + terms.y + terms.z;
        x[axis] = (axis == 0 ? at : 1.0 - at) * n[axis] - (nearest ? 0.0 : 0.5);
        slack[axis] =
            6 * 0x1p-24 * (std::abs(terms.x) + std::abs(terms.y) + std::abs(terms.z) + 1.0) * n[axis];
    }
    const auto texel = [&](double column, double row) {
        const int place = wrapped(int(row), n.y, t.wrap_v) * n.x + wrapped(int(column), n.x, t.wrap_u);
        return texels[size_t(place)];
    };
    TextureBounds bounds{dvec4(1e300), dvec4(-1e300)};
    const auto extend = [&](const dvec4& value) {
        bounds.lo = min(bounds.lo, value);
        bounds.hi = max(bounds.hi, value);
    };
    const dvec2 lo = floor(x - slack), hi = floor(x + slack);
    if (!nearest) {
        // The extremes of a bilinear function over a box are at its corners.
        for (const dvec2 side : {dvec2(-1, -1), dvec2(1, -1), dvec2(-1, 1), dvec2(1, 1)}) {
            const dvec2 place = x + side * slack;
            const dvec2 p = floor(place), w = place - p;
            extend(mix(mix(texel(p.x, p.y), texel(p.x + 1, p.y), w.x),
                       mix(texel(p.x, p.y + 1), texel(p.x + 1, p.y + 1), w.x), w.y));
        }
    }
    // A box that covers several texels, or several of the pieces between their centres, also has these
    // texels' values.
    for (double row = nearest ? lo.y : lo.y + 1; row <= hi.y; ++row) {
        for (double column = lo.x; column <= hi.x + (nearest ? 0 : 1); ++column)
            extend(texel(column, row));
    }
    if (!nearest) {
        for (double column = lo.x + 1; column <= hi.x; ++column) {
            for (double row = lo.y; row <= hi.y + 1; ++row)
                extend(texel(column, row));
        }
    }
    const dvec4 relative(dvec3(is_srgb ? 8e-5 : 0.0), 0.0);
    const dvec4 rounding = bounds.hi * relative + (bounds.hi + 0x1p-20) * 8.0 * 0x1p-24;
    return {bounds.lo - rounding, bounds.hi + rounding};
}

Evidence test_textures(const vk::Device& device, SceneAccess access, size_t count) {
    const Scene scene = texture_scene();
    const TextureReference reference(scene);
    const std::vector<TextureItem> items = texture_items(scene, count);
    const std::vector<TextureValue> values = run_textures(device, build_gpu_scene(scene), access, items);
    Evidence evidence;
    for (size_t i = 0; i < items.size(); ++i) {
        const uint32_t texture = items[i].texture;
        const vec2 uv = items[i].uv;
        const TextureBounds expected = reference.at(texture, uv);
        const dvec4 value(values[i].rgba);
        const bool within = glm::all(glm::greaterThanEqual(value, expected.lo)) &&
                            glm::all(glm::lessThanEqual(value, expected.hi));
        const uint32_t channel = reference.texture(texture).channel;
        evidence.expect(within && values[i].number == values[i].rgba[int(channel)], [&] {
            return concat("texture ", texture, " at ", uv.x, ", ", uv.y, ": ", value.x, ' ', value.y, ' ',
                          value.z, ' ', value.w, ", not from ", expected.lo.x, ' ', expected.lo.y, ' ',
                          expected.lo.z, ' ', expected.lo.w, " to ", expected.hi.x, ' ', expected.hi.y, ' ',
                          expected.hi.z, ' ', expected.hi.w);
        });
    }
    return evidence;
}

}  // namespace candela
