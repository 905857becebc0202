// Writes WebP files with libwebp.
#include <cassert>
#include <memory>
#include <string>

#include <webp/encode.h>

#include "base/error.h"
#include "base/file.h"
#include "image/image_io_parts.h"

namespace candela {

std::string encode_webp(const std::filesystem::path& path, const TexelImage& picture, int quality) {
    assert(picture.type == TexelType::unorm8);
    check_sides(path, picture, WEBP_MAX_DIMENSION, "WebP");
    const auto* const pixels = reinterpret_cast<const uint8_t*>(picture.texels.data());
    const int width = int(picture.size.x), height = int(picture.size.y);
    const int row_bytes = width * int(picture.channels);
    uint8_t* bytes = nullptr;
    const size_t size = picture.channels == 4
                            ? WebPEncodeRGBA(pixels, width, height, row_bytes, float(quality), &bytes)
                            : WebPEncodeRGB(pixels, width, height, row_bytes, float(quality), &bytes);
    const std::unique_ptr<uint8_t, void (*)(void*)> owner(bytes, WebPFree);
    if (size == 0) {
        throw Error("cannot write " + quoted(path) +
                    ": there is not enough memory to encode the WebP file; write a PNG file");
    }
    return {reinterpret_cast<const char*>(bytes), size};
}

}  // namespace candela
