// Reads WebP files with libwebp. The bytes do not bound the size: an image of one colour needs hardly any.
#include <cassert>
#include <cstdint>
#include <new>

#include <webp/decode.h>

#include "base/memory_limit.h"
#include "image/image_io_parts.h"
#include "image/texel_io_parts.h"

namespace candela {
namespace {

void check_webp(const TexelSource& source, VP8StatusCode status) {
    switch (status) {
        case VP8_STATUS_OK:
            return;
        case VP8_STATUS_OUT_OF_MEMORY:
            throw std::bad_alloc();
        case VP8_STATUS_NOT_ENOUGH_DATA:
        case VP8_STATUS_SUSPENDED:
            source.fail_damaged("it ends early");
        default:
            source.fail_damaged("its bytes are not valid WebP");
    }
}

}  // namespace

TexelImage decode_webp_texels(const TexelSource& source) {
    const auto* bytes = reinterpret_cast<const uint8_t*>(source.bytes.data());
    WebPDecoderConfig config;
    if (WebPInitDecoderConfig(&config) == 0)
        source.fail("libwebp is of another version; build candela again");
    check_webp(source, WebPGetFeatures(bytes, source.bytes.size(), &config.input));
    const uvec2 size(config.input.width, config.input.height);
    check_pixel_count(source.name, size.x, size.y, source.limits.max_pixels);
    if (config.input.has_animation != 0)
        source.fail("it is an animation; save its first frame as an image of its own");
    const bool alpha = config.input.has_alpha != 0;
    TexelImage image = make_texels(size, alpha ? 4 : 3, TexelType::unorm8);
    config.output.colorspace = alpha ? MODE_RGBA : MODE_RGB;
    config.output.is_external_memory = 1;
    config.output.u.RGBA = {.rgba = reinterpret_cast<uint8_t*>(image.texels.data()),
                            .stride = int(size.x * image.channels),
                            .size = image.texels.size()};
    const MemoryCharge inside(uint64_t{4} * size.x * size.y);  // Memory of libwebp for lossless images.
    check_webp(source, WebPDecode(bytes, source.bytes.size(), &config));
    return image;
}

}  // namespace candela
