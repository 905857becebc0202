// See texture_table.h.
#include "gpu_scene/texture_table.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"

namespace candela {
namespace {

// The layout of an image's texels: one of TEXEL_FORMATS.
uint32_t format_of(const TexelImage& image) {
    switch (image.type) {
        case TexelType::unorm8:
            return image.channels == 1 ? TEXEL_R8 : TEXEL_RGBA8;
        case TexelType::unorm16:
            return TEXEL_RGBA16;
        case TexelType::half:
            break;
    }
    return TEXEL_RGBA16F;
}

uint32_t words_of_tile(const TexelImage& image) {
    const uint32_t format = format_of(image);
    return format == TEXEL_R8 ? 1 : format == TEXEL_RGBA8 ? 4 : 8;
}

uint32_t wrap_trait(Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat:
            return TEXTURE_REPEAT;
        case Wrap::mirror:
            return TEXTURE_MIRROR;
        case Wrap::clamp:
            break;
    }
    return TEXTURE_CLAMP;
}

uint32_t traits_of(const Texture& texture, const TexelImage& image) {
    const bool srgb = texture.encoding == TextureEncoding::srgb && image.type != TexelType::half;
    return format_of(image) | (srgb ? TEXTURE_SRGB : TEXTURE_LINEAR) |
           (texture.filter == TextureFilter::nearest ? TEXTURE_NEAREST : TEXTURE_BILINEAR) |
           wrap_trait(texture.wrap_u) | wrap_trait(texture.wrap_v) << TEXTURE_WRAP_V |
           (texture.uv_set == 0 ? TEXTURE_UV0 : TEXTURE_UV1);
}

// Red, green, blue and alpha of a texel, of the image's own type; `one` is its 1.
template <class Number>
std::array<Number, 4> rgba(const Number* texel, uint32_t channels, Number one) {
    switch (channels) {
        case 1:
            return {texel[0], texel[0], texel[0], one};
        case 2:
            return {texel[0], texel[0], texel[0], texel[1]};
        case 3:
            return {texel[0], texel[1], texel[2], one};
        default:
            return {texel[0], texel[1], texel[2], texel[3]};
    }
}

// Writes one row of tiles. Texels beyond the image's edges repeat those at the edges.
template <class Number>
void pack_row(const TexelImage& image, uint32_t tile_y, Number one, bool grey, std::byte* out) {
    const auto* texels = reinterpret_cast<const Number*>(image.texels.data());
    const size_t bytes = (grey ? 1 : 4) * sizeof(Number);
    for (uint32_t tile_x = 0; 4 * tile_x < image.size.x; ++tile_x) {
        for (uint32_t i = 0; i < 16; ++i) {
            const uint32_t x = std::min(4 * tile_x + i % 4, image.size.x - 1);
            const uint32_t y = std::min(4 * tile_y + i / 4, image.size.y - 1);
            const size_t place = (size_t(y) * image.size.x + x) * image.channels;
            const std::array<Number, 4> texel = rgba(texels + place, image.channels, one);
            std::memcpy(out, texel.data(), bytes);
            out += bytes;
        }
    }
}

}  // namespace

uint64_t texel_words(const TexelImage& image) {
    const glm::u64vec2 tiles = (glm::u64vec2(image.size) + uint64_t{3}) / uint64_t{4};
    return tiles.x * tiles.y * words_of_tile(image);
}

void pack_texels(const TexelImage& image, std::span<uvec4> words) {
    const size_t row = size_t{words_of_tile(image)} * ((image.size.x + 3) / 4);
    parallel_for((image.size.y + 3) / 4, [&](size_t y) {
        auto* out = reinterpret_cast<std::byte*>(words.data() + y * row);
        constexpr uint16_t HALF_ONE = 0x3C00;
        switch (image.type) {
            case TexelType::unorm8:
                return pack_row<uint8_t>(image, uint32_t(y), 0xFF, image.channels == 1, out);
            case TexelType::unorm16:
                return pack_row<uint16_t>(image, uint32_t(y), 0xFFFF, false, out);
            case TexelType::half:
                return pack_row<uint16_t>(image, uint32_t(y), HALF_ONE, false, out);
        }
    });
}

TextureTable::TextureKey TextureTable::key_of(const Texture& texture) {
    TextureKey key{texture.image,
                   uint32_t(texture.encoding),
                   uint32_t(texture.filter),
                   uint32_t(texture.wrap_u),
                   uint32_t(texture.wrap_v),
                   texture.uv_set,
                   texture.channel};
    for (size_t i = 0; i < 6; ++i)
        key[7 + i] = std::bit_cast<uint32_t>(texture.rows[i / 3][glm::length_t(i % 3)]);
    return key;
}

uint32_t TextureTable::add(const std::optional<Texture>& texture) {
    if (!texture) return TEXTURE_NONE;
    const auto [known, is_new] = indices_.try_emplace(key_of(*texture), uint32_t(records_.size()));
    if (!is_new) return known->second;
    const ImageFile& file = images_[texture->image];
    const TexelImage& image = *file.image;
    if (std::max(image.size.x, image.size.y) > MAX_IMAGE_SIDE) {
        throw Error(concat(file.place, ": the image ", file.path.string(), " has ", image.size.x, 'x',
                           image.size.y, " pixels, but a texture at most ", MAX_IMAGE_SIDE,
                           " along a side; make it smaller (--texture-limit)"));
    }
    std::optional<uint32_t>& first = places_[texture->image];
    if (!first) {
        first = uint32_t(words_);
        words_ += texel_words(image);
        if (words_ > std::numeric_limits<uint32_t>::max()) {
            throw Error(
                "the scene's textures take more than 64 GiB, beyond which no kernel can address them; use "
                "smaller images (--texture-limit)");
        }
    }
    // Rows of the image run from the top, v upwards.
    const vec3 row_v = texture->rows[1];
    records_.push_back({.first = *first,
                        .size = image.size,
                        .traits = traits_of(*texture, image) | texture->channel << TEXTURE_CHANNEL_SHIFT,
                        .row_u = texture->rows[0],
                        .row_v = vec3(-row_v.x, -row_v.y, 1.0f - row_v.z)});
    traits_ |= traits_of(*texture, image);
    return known->second;
}

std::vector<uvec4> TextureTable::records() const {
    std::vector<uvec4> words;
    for (const TextureRecord& record : records_) {
        const auto packed = pack(record);
        words.insert(words.end(), packed.begin(), packed.end());
    }
    return words;
}

// Grows step by step, because memory that has not been written to takes none.
std::vector<uvec4> build_texels(const std::vector<ImageFile>& images, const ImagePlaces& places,
                                const std::function<void(size_t)>& packed) {
    std::vector<std::pair<uint32_t, size_t>> in_order;
    uint64_t count = 0;
    for (size_t i = 0; i < images.size(); ++i) {
        if (!places[i]) continue;
        in_order.emplace_back(*places[i], i);
        count += texel_words(*images[i].image);
    }
    std::ranges::sort(in_order);
    std::vector<uvec4> words;
    words.reserve(count);
    for (const auto& [first, i] : in_order) {
        words.resize(first + texel_words(*images[i].image));
        pack_texels(*images[i].image, std::span(words).subspan(first));
        packed(i);
    }
    return words;
}

}  // namespace candela
