// Reads the pixels of OpenEXR files through the library's C interface, which describes each chunk before it
// is decoded. Version 3.1 lacks DWA compression there; such chunks are decoded through the C++ interface,
// from a file that is rebuilt from checked parts.
#include <algorithm>
#include <cstring>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfStdIO.h>
#include <ImfTileDescription.h>
#include <ImfVersion.h>
#include <openexr.h>

#include "base/error.h"
#include "base/file.h"
#include "base/memory_limit.h"
#include "image/image_io.h"
#include "image/image_io_exr_file.h"
#include "image/image_io_parts.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

// The most bytes that one compressed byte can expand to, by compression; a chunk may have EXPANSION_SLACK
// more. PIZ: runs of 255 words, nine bits each. DWA, which compresses twice, has no useful bound.
constexpr uint64_t MAX_EXPANSION[EXR_COMPRESSION_LAST_TYPE] = {1,    64, 1032, 1032,       454,
                                                               1400, 3,  11,   UINT32_MAX, UINT32_MAX};
constexpr uint64_t EXPANSION_SLACK = 1024;

constexpr const char* TOO_LARGE_CHUNKS =
    "it has more channels or longer lines than can be read together; write fewer";

// Uses the bytes of a chunk as its pixels.
exr_result_t copy_chunk(exr_decode_pipeline_t* decoder) {
    std::memcpy(decoder->unpacked_buffer, decoder->packed_buffer, decoder->chunk.unpacked_size);
    return EXR_ERR_SUCCESS;
}

// A file whose values are read.
class ExrPixels : public ExrFile {
  public:
    using ExrFile::ExrFile;
    ~ExrPixels() { exr_decoding_destroy(context(), &decoder_); }

    Image read(const ImageLimits& limits);

  private:
    // A chunk of a file, a rectangle, with its place in the image.
    struct Chunk {
        exr_chunk_info_t info;
        uint32_t x, y;
    };

    void for_each_chunk(const Image& image, const std::function<void(const Chunk&)>& each);
    uvec2 tile_size() const;
    Imf::Header min_header() const;
    std::string min_file(const Image& image);
    void read_dwa(Image& image, const ImageLimits& limits);
    void decode(const Chunk& chunk, Image& image, const ImageLimits& limits);

    exr_decode_pipeline_t decoder_{};
    bool decoder_is_ready_ = false;
    std::vector<float> unwanted_;
};

// Decodes a chunk into the channels, which it grows to the chunk's end.
void ExrPixels::decode(const Chunk& chunk, Image& image, const ImageLimits& limits) {
    const exr_chunk_info_t& info = chunk.info;
    const uint64_t max = info.packed_size * MAX_EXPANSION[info.compression] + EXPANSION_SLACK;
    if (info.packed_size == 0 || info.unpacked_size > max || info.packed_size > bytes().size())
        fail_damaged("a chunk is shorter than its pixels need");
    if (info.unpacked_size > MAX_CHUNK_BYTES) fail(TOO_LARGE_CHUNKS);
    if (decoder_is_ready_) {
        check(exr_decoding_update(context(), PART, &info, &decoder_));
    } else {
        check(exr_decoding_initialize(context(), PART, &info, &decoder_));
        decoder_is_ready_ = true;
    }
    grow(image, chunk.y + uint32_t(info.height), limits);
    // Unwanted channels need a place too: the library skips no channel of an uncompressed file.
    const uint32_t width = image.data.width();
    unwanted_.resize(size_t(width) * uint32_t(info.height));
    for (int i = 0; i < decoder_.channel_count; ++i) {
        Channel& channel = image.channels[size_t(i)];
        exr_coding_channel_info_t& out = decoder_.channels[i];
        out.user_bytes_per_element = sizeof(float);
        out.user_data_type = EXR_PIXEL_FLOAT;
        out.user_pixel_stride = sizeof(float);
        out.user_line_stride = int32_t(sizeof(float) * width);
        float* values = unwanted_.data();
        if (limits.wants(channel.name)) values = &channel.values[size_t(chunk.y) * width + chunk.x];
        out.decode_to_ptr = reinterpret_cast<uint8_t*>(values);
    }
    check(exr_decoding_choose_default_routines(context(), PART, &decoder_));
    // A chunk that compression would not shrink is stored uncompressed. Version 3.1 of the library
    // nevertheless decompresses B44.
    if (info.compression != EXR_COMPRESSION_NONE && info.packed_size == info.unpacked_size)
        decoder_.decompress_fn = copy_chunk;
    check(exr_decoding_run(context(), PART, &decoder_));
}

// Calls `each` with every chunk, from the top and row by row; with tiles, only those of the largest
// resolution.
void ExrPixels::for_each_chunk(const Image& image, const std::function<void(const Chunk&)>& each) {
    const uint32_t width = image.data.width(), height = image.data.height();
    if (!is_tiled()) {
        exr_attr_box2i_t window{};
        check(exr_get_data_window(context(), PART, &window));
        for (uint32_t y = 0; y < height;) {
            Chunk chunk{.info = {}, .x = 0, .y = y};
            const int64_t line = window.min.y + int64_t(y);
            check(exr_read_scanline_chunk_info(context(), PART, int(line), &chunk.info));
            const auto rows = uint32_t(std::max(chunk.info.height, 1));
            if (chunk.info.start_y != line || rows > height - y)
                fail_damaged("a chunk is in the wrong place");
            each(chunk);
            y += rows;
        }
        return;
    }
    const auto [tile_width, tile_height] = tile_size();
    for (uint32_t y = 0, row = 0; y < height; y += tile_height, ++row) {
        for (uint32_t x = 0, column = 0; x < width; x += tile_width, ++column) {
            Chunk chunk{.info = {}, .x = x, .y = y};
            check(exr_read_tile_chunk_info(context(), PART, int(column), int(row), 0, 0, &chunk.info));
            if (uint32_t(chunk.info.width) > width - x || uint32_t(chunk.info.height) > height - y)
                fail_damaged("a tile is too large");
            each(chunk);
        }
    }
}

uvec2 ExrPixels::tile_size() const {
    int32_t width = 0, height = 0;
    check(exr_get_tile_sizes(context(), PART, 0, 0, &width, &height));
    if (width < 1 || height < 1) fail_damaged("its tiles are empty");
    return {width, height};
}

// The smallest header that decoding needs, with checked values.
Imf::Header ExrPixels::min_header() const {
    exr_attr_box2i_t display{}, data{};
    check(exr_get_display_window(context(), PART, &display));
    check(exr_get_data_window(context(), PART, &data));
    exr_compression_t compression{};
    check(exr_get_compression(context(), PART, &compression));
    const auto box = [](const exr_attr_box2i_t& b) {
        return Imath::Box2i({b.min.x, b.min.y}, {b.max.x, b.max.y});
    };
    Imf::Header header(box(display), box(data));
    header.compression() = Imf::Compression(compression);
    const exr_attr_chlist_t* list = nullptr;
    check(exr_get_channels(context(), PART, &list));
    for (int i = 0; i < list->num_channels; ++i) {
        const exr_attr_chlist_entry_t& entry = list->entries[i];
        header.channels().insert(entry.name.str,
                                 Imf::Channel(Imf::PixelType(entry.pixel_type), 1, 1, entry.p_linear != 0));
    }
    if (is_tiled()) {  // The decoder needs no tiles larger than the image.
        const uint32_t width = uint32_t(data.max.x - data.min.x) + 1,
                       height = uint32_t(data.max.y - data.min.y) + 1;
        header.setTileDescription(
            {std::min(tile_size().x, width), std::min(tile_size().y, height), Imf::ONE_LEVEL});
    }
    return header;
}

// An OpenEXR file with the smallest header and the original chunks.
std::string ExrPixels::min_file(const Image& image) {
    std::vector<Chunk> chunks;
    for_each_chunk(image, [&](const Chunk& chunk) {
        if (chunk.info.packed_size > bytes().size() ||
            chunk.info.data_offset > bytes().size() - chunk.info.packed_size)
            fail_damaged("a chunk lies outside the file");
        chunks.push_back(chunk);
    });
    Imf::StdOSStream file;
    const auto put = [&](auto number) {  // Little-endian, like every machine that candela runs on.
        file.write(reinterpret_cast<const char*>(&number), sizeof(number));
    };
    put(int32_t{Imf::MAGIC});
    put(int32_t{Imf::EXR_VERSION | (is_tiled() ? Imf::TILED_FLAG : 0)});
    min_header().writeTo(file, is_tiled());
    uint64_t offset = file.tellp() + chunks.size() * sizeof(uint64_t);
    for (const Chunk& chunk : chunks) {
        put(offset);
        offset += (is_tiled() ? 5 : 2) * sizeof(int32_t) + chunk.info.packed_size;
    }
    for (const auto& [info, x, y] : chunks) {
        if (is_tiled()) {
            for (const int32_t place : {info.start_x, info.start_y, 0, 0})  // In tiles; of level 0.
                put(place);
        } else {
            put(int32_t{info.start_y});
        }
        put(int32_t(info.packed_size));
        file.write(bytes().data() + info.data_offset, int(info.packed_size));
    }
    return file.str();
}

void ExrPixels::read_dwa(Image& image, const ImageLimits& limits) {
    uint64_t chunk_bytes = 0;
    check(exr_get_chunk_unpacked_size(context(), PART, &chunk_bytes));
    if (chunk_bytes > MAX_CHUNK_BYTES) fail(TOO_LARGE_CHUNKS);
    try {
        decode_exr_by_rows(min_file(image), image, limits);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        fail_damaged(error.what());
    }
}

Image ExrPixels::read(const ImageLimits& limits) {
    Image image = read_header(limits);
    exr_compression_t compression{};
    check(exr_get_compression(context(), PART, &compression));
    if (compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB) {
        read_dwa(image, limits);
    } else {
        for_each_chunk(image, [&](const Chunk& chunk) { decode(chunk, image, limits); });
    }
    return image;
}

}  // namespace

Image decode_exr(std::string_view bytes, const fs::path& name, const ImageLimits& limits) {
    const uint64_t before = memory_in_use();
    try {
        const ExrBytes file{bytes};
        return ExrPixels(file, name).read(limits);
    } catch (const std::bad_alloc& error) {
        throw Error("cannot read " + quoted(name) + ": there is not enough memory for its pixels" +
                        shortage_text(error, before) + "; use a smaller image or a larger machine",
                    ErrorKind::out_of_memory);
    }
}

Image read_exr(const fs::path& path, const ImageLimits& limits) {
    return decode_exr(read_file(path), path, limits);
}

}  // namespace candela
