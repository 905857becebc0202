// Reads KTX 2 textures whose pixels Basis Universal has compressed (ETC1S and UASTC), with Binomial's
// decoder, if candela is built with it (cmake/basisu.sh).
// Ref: Khronos, "KTX File Format Specification", version 2.0, sections 3 and 5.
#include "image/texel_io_parts.h"

#ifdef CANDELA_BASISU

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

#include <basisu_transcoder.h>

#include "base/memory_limit.h"
#include "image/image_io_parts.h"

namespace candela {

bool reads_ktx_texels() {
    return true;
}

namespace {

constexpr size_t BLOCK_ALIGNMENT = 4;
constexpr const char* OTHER_CODEC =
    "its pixels are neither ETC1S nor UASTC, as Basis Universal writes them for glTF; write it as one of "
    "these";

// Refuses what the decoder would read but glTF does not allow, and what it does not check before it uses it.
void check_header(const TexelSource& source) {
    basist::ktx2_header header;
    if (source.bytes.size() <= sizeof header) source.fail_damaged("it ends early");
    if (source.bytes.size() > UINT32_MAX) source.fail("the file has more than 4 GiB; write a smaller image");
    std::memcpy(static_cast<void*>(&header), source.bytes.data(), sizeof header);
    if (header.m_vk_format != basist::KTX2_VK_FORMAT_UNDEFINED) source.fail(OTHER_CODEC);
    if (header.m_face_count != 1 || header.m_layer_count > 1 || header.m_pixel_depth != 0)
        source.fail(
            "it has several images (a cube map, an array or a volume); write one as a file of its own");
    // The first byte of the description's fourth word is its colour model.
    const uint64_t model = uint64_t{header.m_dfd_byte_offset} + 12;
    if (model >= source.bytes.size()) source.fail_damaged("it ends early");
    const auto color_model = uint8_t(source.bytes[model]);
    if (color_model != basist::KTX2_KDF_DF_MODEL_ETC1S &&
        color_model != basist::KTX2_KDF_DF_MODEL_UASTC_LDR_4X4)
        source.fail(OTHER_CODEC);
    check_pixel_count(source.name, header.m_pixel_width, header.m_pixel_height, source.limits.max_pixels);
    if (header.m_supercompression_scheme == basist::KTX2_SS_BASISLZ &&
        header.m_sgd_byte_length.get_uint64() < sizeof(basist::ktx2_etc1s_global_data_header))
        source.fail_damaged("its global data are too short");
}

// The channels of each texel: 3 for RGB and for grey, which the decoder repeats, or 4.
uint32_t channels_of(const TexelSource& source, const basist::ktx2_transcoder& decoder) {
    using namespace basist;
    const uint32_t first = decoder.get_dfd_channel_id0(), second = decoder.get_dfd_channel_id1();
    if (!decoder.is_etc1s()) {
        if (first == KTX2_DF_CHANNEL_UASTC_RGBA) return 4;
        if (first == KTX2_DF_CHANNEL_UASTC_RGB || first == KTX2_DF_CHANNEL_UASTC_RRR) return 3;
    } else if (decoder.get_dfd_total_samples() == 1) {
        if (first == KTX2_DF_CHANNEL_ETC1S_RGB || first == KTX2_DF_CHANNEL_ETC1S_RRR) return 3;
    } else if (first == KTX2_DF_CHANNEL_ETC1S_RGB && second == KTX2_DF_CHANNEL_ETC1S_AAA) {
        return 4;
    }
    source.fail("its channels are neither RGB nor RGBA; write it with these");
}

// Of UASTC: that the decoder finds as many bytes as the blocks have.
void check_blocks(const TexelSource& source, const basist::ktx2_transcoder& decoder, uint64_t bytes) {
    const bool packed = decoder.get_header().m_supercompression_scheme == basist::KTX2_SS_ZSTANDARD;
    const auto& level = decoder.get_level_index()[0];
    if (!packed && level.m_byte_offset.get_uint64() % BLOCK_ALIGNMENT != 0)
        source.fail_damaged("its pixels begin where they may not");
    if ((packed ? level.m_uncompressed_byte_length : level.m_byte_length).get_uint64() != bytes)
        source.fail_damaged("the size of its pixels is wrong");
}

// Of RGBA, RGB. The memory stays as it is: another block in its place, among those of many images, costs
// more.
void drop_alpha(TexelImage& image) {
    const size_t pixels = size_t{image.size.x} * image.size.y;
    for (size_t i = 0; i < pixels; ++i)
        std::memmove(&image.texels[3 * i], &image.texels[4 * i], 3);
    image.texels.resize(3 * pixels);
    image.channels = 3;
}

}  // namespace

TexelImage decode_ktx_texels(const TexelSource& source) {
    check_header(source);
    [[maybe_unused]] static const bool tables_are_made = (basist::basisu_transcoder_init(), true);
    // The decoder reads blocks where they are, as words.
    std::string copy;
    const char* bytes = source.bytes.data();
    if (std::bit_cast<uintptr_t>(bytes) % BLOCK_ALIGNMENT != 0) {
        copy = source.bytes;
        bytes = copy.data();
    }
    basist::ktx2_transcoder decoder;
    if (!decoder.init(bytes, uint32_t(source.bytes.size())))
        source.fail_damaged("its header is not valid KTX 2 of Basis Universal");
    const uint32_t scheme = decoder.get_header().m_supercompression_scheme;
    const bool etc1s = decoder.is_etc1s() && scheme == basist::KTX2_SS_BASISLZ;
    const bool uastc =
        decoder.is_uastc() && (scheme == basist::KTX2_SS_NONE || scheme == basist::KTX2_SS_ZSTANDARD);
    if (!etc1s && !uastc) source.fail(OTHER_CODEC);
    const uint32_t channels = channels_of(source, decoder);
    const uvec2 size(decoder.get_width(), decoder.get_height());
    const uint64_t block_bytes = uint64_t{16} * ((size.x + 3) / 4) * ((size.y + 3) / 4);
    if (uastc) check_blocks(source, decoder, block_bytes);
    // The decoder's memory: the pixels of UASTC without Zstandard, or tables for ETC1S.
    const MemoryCharge inside(block_bytes + (uint64_t{4} << 20));
    TexelImage image = make_texels(size, 4, TexelType::unorm8);
    const uint32_t pixels = size.x * size.y;
    if (!decoder.start_transcoding() ||
        !decoder.transcode_image_level(0, 0, 0, image.texels.data(), pixels,
                                       basist::transcoder_texture_format::cTFRGBA32))
        source.fail_damaged("its pixels are not valid");
    if (channels == 3) drop_alpha(image);
    return image;
}

}  // namespace candela

#else

namespace candela {

bool reads_ktx_texels() {
    return false;
}

TexelImage decode_ktx_texels(const TexelSource& source) {
    source.fail(
        "this program is built without a decoder of KTX 2: run sh cmake/basisu.sh and build it again, or "
        "convert the texture to " +
        std::string(source.limits.formats));
}

}  // namespace candela

#endif
