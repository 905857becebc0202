// Reads OpenEXR files, by the library's C interface: it checks sizes against the file's before it allocates,
// and lets us look at each chunk before it is decoded. Version 3.1 knows no DWA compression there; such
// chunks are decoded by the other interface, which gets a file made of what has been checked.
#include <algorithm>
#include <array>
#include <cstdlib>
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
#include "base/image_io.h"
#include "base/image_io_parts.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

constexpr int PART = 0;  // The first one of a file.

// Attributes of every OpenEXR file that speak of the file, not of the picture; an Image does not keep them.
constexpr std::array<std::string_view, 4> FILE_ATTRIBUTES = {"name", "type", "pixelAspectRatio",
                                                             "screenWindowWidth"};

// The most bytes that so many compressed ones can stand for, beside which a chunk may have a few more. PIZ:
// runs of 255 words, by nine bits each. DWA, which packs what is packed, has no bound worth the name.
constexpr uint64_t MAX_EXPANSION[EXR_COMPRESSION_LAST_TYPE] = {1,    64, 1032, 1032,       454,
                                                               1400, 3,  11,   UINT32_MAX, UINT32_MAX};
constexpr uint64_t EXPANSION_SLACK = 1024;

// The largest chunk: 256 lines of DWAB, 2^16 pixels wide, of four 32-bit channels.
constexpr uint64_t MAX_CHUNK_BYTES = uint64_t{1} << 28;
constexpr const char* TOO_LARGE_CHUNKS =
    "it has more channels or longer lines than can be read together; write fewer";

// What the library said last; its functions return no more than a code.
thread_local std::string library_message;

void take_message(exr_const_context_t, exr_result_t, const char* message) {
    library_message = message;
}

// Zeroed, so that nothing that a damaged chunk leaves out is somebody else's memory; and bounded.
void* allocate(size_t size) {
    return size > 2 * MAX_CHUNK_BYTES ? nullptr : std::calloc(1, std::max<size_t>(size, 1));
}

// A file, of which at least the first bytes are in memory.
struct ExrBytes {
    std::string_view bytes;
    uint64_t size = bytes.size();  // Of the file.
};

int64_t read_bytes(exr_const_context_t, void* user, void* out, uint64_t size, uint64_t offset,
                   exr_stream_error_func_ptr_t) {
    const std::string_view bytes = static_cast<const ExrBytes*>(user)->bytes;
    if (offset >= bytes.size()) return 0;
    const uint64_t count = std::min<uint64_t>(size, bytes.size() - offset);
    std::memcpy(out, bytes.data() + offset, count);
    return int64_t(count);
}

int64_t byte_count(exr_const_context_t, void* user) {
    return int64_t(static_cast<const ExrBytes*>(user)->size);
}

// An Imath matrix for row vectors is stored row by row, a glm matrix for column vectors column by column.
// Each is the other transposed, and stored transposed: the 16 numbers stay in place.
mat4 to_glm(const float* numbers) {
    mat4 result;
    for (int i = 0; i < 16; ++i)
        result[i / 4][i % 4] = numbers[i];
    return result;
}

class ExrFile {
  public:
    // Copies neither the bytes nor the path, which is the file's name in messages.
    ExrFile(const ExrBytes& file, const fs::path& path) : bytes_(file.bytes), path_(path) {
        constexpr std::string_view MAGIC("\x76\x2f\x31\x01", 4);
        if (!bytes_.starts_with(MAGIC)) fail("it is not an OpenEXR file; give an .exr image");
        exr_context_initializer_t wishes = EXR_DEFAULT_CONTEXT_INITIALIZER;
        wishes.error_handler_fn = take_message;
        wishes.alloc_fn = allocate;
        wishes.free_fn = std::free;
        wishes.user_data = const_cast<ExrBytes*>(&file);
        wishes.read_fn = read_bytes;
        wishes.size_fn = byte_count;
        wishes.max_image_width = wishes.max_image_height = int(MAX_IMAGE_SIDE);
        wishes.max_tile_width = wishes.max_tile_height = int(MAX_IMAGE_SIDE);
        library_message.clear();
        check(exr_start_read(&context_, path.c_str(), &wishes));
    }
    ExrFile(const ExrFile&) = delete;
    ExrFile& operator=(const ExrFile&) = delete;
    ~ExrFile() {
        exr_decoding_destroy(context_, &decoder_);
        exr_finish(&context_);
    }

    // The image without values; sees whether they can be read.
    Image read_header(const ImageLimits& limits);
    Image read(const ImageLimits& limits);

  private:
    // One of the rectangles that a file is cut into, with its place in the image.
    struct Chunk {
        exr_chunk_info_t info;
        uint32_t x, y;
    };

    [[noreturn]] void fail(const std::string& why) const {
        throw Error("cannot read " + quoted(path_) + ": " + why);
    }
    [[noreturn]] void fail_damaged(const std::string& how) const {
        fail("the file is damaged or incomplete (" + how + "); write it again");
    }
    void check(exr_result_t result) const {
        if (result == EXR_ERR_SUCCESS) return;
        if (result == EXR_ERR_OUT_OF_MEMORY) throw std::bad_alloc();
        fail_damaged(library_message.empty() ? exr_get_default_error_message(result) : library_message);
    }

    void read_windows(Image& image) const;
    void read_attributes(Image& image) const;
    void read_channels(Image& image) const;
    void for_each_chunk(const Image& image, const std::function<void(const Chunk&)>& each);
    uvec2 tile_size() const;
    Imf::Header least_header() const;
    std::string least_file(const Image& image);
    void read_dwa(Image& image, const ImageLimits& limits);
    void decode(const Chunk& chunk, Image& image, const ImageLimits& limits);

    std::string_view bytes_;
    const fs::path& path_;
    exr_context_t context_ = nullptr;
    exr_decode_pipeline_t decoder_{};
    bool decoder_is_ready_ = false;
    bool tiled_ = false;
    std::vector<float> unwanted_;
};

void ExrFile::read_windows(Image& image) const {
    exr_attr_box2i_t display{}, data{};
    check(exr_get_display_window(context_, PART, &display));
    check(exr_get_data_window(context_, PART, &data));
    if (data.min.x < display.min.x || data.min.y < display.min.y || data.max.x > display.max.x ||
        data.max.y > display.max.y) {
        fail("its data window exceeds its display window; crop the image to the display window");
    }
    // In 64 bits: windows may lie anywhere in the range of int.
    const auto offset = [](int from, int to) { return uint32_t(int64_t(to) - int64_t(from)); };
    image.full = {offset(display.min.x, display.max.x) + 1, offset(display.min.y, display.max.y) + 1};
    image.data = {offset(display.min.x, data.min.x), offset(display.min.y, data.min.y),
                  offset(display.min.x, data.max.x) + 1, offset(display.min.y, data.max.y) + 1};
}

void ExrFile::read_attributes(Image& image) const {
    int32_t count = 0;
    check(exr_get_attribute_count(context_, PART, &count));
    for (int32_t i = 0; i < count; ++i) {
        const exr_attribute_t* attribute = nullptr;
        check(exr_get_attribute_by_index(context_, PART, EXR_ATTR_LIST_FILE_ORDER, i, &attribute));
        const std::string name(attribute->name, attribute->name_length);
        if (std::ranges::find(FILE_ATTRIBUTES, name) != FILE_ATTRIBUTES.end()) continue;
        if (attribute->type == EXR_ATTR_STRING) {
            image.attributes[name] = std::string(attribute->string->str, size_t(attribute->string->length));
        } else if (attribute->type == EXR_ATTR_FLOAT) {
            image.attributes[name] = attribute->f;
        } else if (attribute->type == EXR_ATTR_M44F) {
            image.attributes[name] = to_glm(attribute->m44f->m);
        }
    }
}

void ExrFile::read_channels(Image& image) const {
    const exr_attr_chlist_t* list = nullptr;
    check(exr_get_channels(context_, PART, &list));
    for (int i = 0; i < list->num_channels; ++i) {
        const exr_attr_chlist_entry_t& entry = list->entries[i];
        const std::string name(entry.name.str, size_t(entry.name.length));
        if (entry.x_sampling != 1 || entry.y_sampling != 1)
            fail("channel \"" + name + "\" is subsampled; write it at full resolution");
        image.channels.push_back({name, {}, entry.pixel_type == EXR_PIXEL_HALF});
    }
}

// Decodes a chunk into the channels, and lets these grow to its end.
void ExrFile::decode(const Chunk& chunk, Image& image, const ImageLimits& limits) {
    const exr_chunk_info_t& info = chunk.info;
    const uint64_t most = info.packed_size * MAX_EXPANSION[info.compression] + EXPANSION_SLACK;
    if (info.packed_size == 0 || info.unpacked_size > most || info.packed_size > bytes_.size())
        fail_damaged("a chunk is shorter than its pixels need");
    if (info.unpacked_size > MAX_CHUNK_BYTES) fail(TOO_LARGE_CHUNKS);
    if (decoder_is_ready_) {
        check(exr_decoding_update(context_, PART, &info, &decoder_));
    } else {
        check(exr_decoding_initialize(context_, PART, &info, &decoder_));
        decoder_is_ready_ = true;
    }
    grow(image, chunk.y + uint32_t(info.height), limits);
    // What nobody asked for has to go somewhere: the library skips no channel of an uncompressed file.
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
    check(exr_decoding_choose_default_routines(context_, PART, &decoder_));
    check(exr_decoding_run(context_, PART, &decoder_));
}

// Hands on each chunk, from the top and row by row; of tiles those of the largest resolution.
void ExrFile::for_each_chunk(const Image& image, const std::function<void(const Chunk&)>& each) {
    const uint32_t width = image.data.width(), height = image.data.height();
    if (!tiled_) {
        exr_attr_box2i_t window{};
        check(exr_get_data_window(context_, PART, &window));
        for (uint32_t y = 0; y < height;) {
            Chunk chunk{.info = {}, .x = 0, .y = y};
            const int64_t line = window.min.y + int64_t(y);
            check(exr_read_scanline_chunk_info(context_, PART, int(line), &chunk.info));
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
            check(exr_read_tile_chunk_info(context_, PART, int(column), int(row), 0, 0, &chunk.info));
            if (uint32_t(chunk.info.width) > width - x || uint32_t(chunk.info.height) > height - y)
                fail_damaged("a tile is too large");
            each(chunk);
        }
    }
}

uvec2 ExrFile::tile_size() const {
    int32_t width = 0, height = 0;
    check(exr_get_tile_sizes(context_, PART, 0, 0, &width, &height));
    if (width < 1 || height < 1) fail_damaged("its tiles are empty");
    return {width, height};
}

// The header that decoding needs, of what has been checked.
Imf::Header ExrFile::least_header() const {
    exr_attr_box2i_t display{}, data{};
    check(exr_get_display_window(context_, PART, &display));
    check(exr_get_data_window(context_, PART, &data));
    exr_compression_t compression{};
    check(exr_get_compression(context_, PART, &compression));
    const auto box = [](const exr_attr_box2i_t& b) {
        return Imath::Box2i({b.min.x, b.min.y}, {b.max.x, b.max.y});
    };
    Imf::Header header(box(display), box(data));
    header.compression() = Imf::Compression(compression);
    const exr_attr_chlist_t* list = nullptr;
    check(exr_get_channels(context_, PART, &list));
    for (int i = 0; i < list->num_channels; ++i) {
        const exr_attr_chlist_entry_t& entry = list->entries[i];
        header.channels().insert(entry.name.str,
                                 Imf::Channel(Imf::PixelType(entry.pixel_type), 1, 1, entry.p_linear != 0));
    }
    if (tiled_) {  // Tiles larger than the image hold no more than it: nor need the decoder.
        const uint32_t width = uint32_t(data.max.x - data.min.x) + 1,
                       height = uint32_t(data.max.y - data.min.y) + 1;
        header.setTileDescription(
            {std::min(tile_size().x, width), std::min(tile_size().y, height), Imf::ONE_LEVEL});
    }
    return header;
}

// An OpenEXR file of the least header and the chunks as they are.
std::string ExrFile::least_file(const Image& image) {
    std::vector<Chunk> chunks;
    for_each_chunk(image, [&](const Chunk& chunk) {
        if (chunk.info.packed_size > bytes_.size() ||
            chunk.info.data_offset > bytes_.size() - chunk.info.packed_size)
            fail_damaged("a chunk lies outside the file");
        chunks.push_back(chunk);
    });
    Imf::StdOSStream file;
    const auto put = [&](auto number) {  // Little-endian, like every machine that candela runs on.
        file.write(reinterpret_cast<const char*>(&number), sizeof(number));
    };
    put(int32_t{Imf::MAGIC});
    put(int32_t{Imf::EXR_VERSION | (tiled_ ? Imf::TILED_FLAG : 0)});
    least_header().writeTo(file, tiled_);
    uint64_t offset = file.tellp() + chunks.size() * sizeof(uint64_t);
    for (const Chunk& chunk : chunks) {
        put(offset);
        offset += (tiled_ ? 5 : 2) * sizeof(int32_t) + chunk.info.packed_size;
    }
    for (const auto& [info, x, y] : chunks) {
        if (tiled_) {
            for (const int32_t place : {info.start_x, info.start_y, 0, 0})  // In tiles; of level 0.
                put(place);
        } else {
            put(int32_t{info.start_y});
        }
        put(int32_t(info.packed_size));
        file.write(bytes_.data() + info.data_offset, int(info.packed_size));
    }
    return file.str();
}

void ExrFile::read_dwa(Image& image, const ImageLimits& limits) {
    uint64_t chunk_bytes = 0;
    check(exr_get_chunk_unpacked_size(context_, PART, &chunk_bytes));
    if (chunk_bytes > MAX_CHUNK_BYTES) fail(TOO_LARGE_CHUNKS);
    try {
        decode_exr_by_rows(least_file(image), image, limits);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        fail_damaged(error.what());
    }
}

Image ExrFile::read_header(const ImageLimits& limits) {
    exr_storage_t storage{};
    check(exr_get_storage(context_, PART, &storage));
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
        fail("it has deep pixels, of several samples each; flatten it");
    tiled_ = storage == EXR_STORAGE_TILED;
    Image image;
    read_windows(image);
    check_pixel_count(path_, image.data.width(), image.data.height(), limits.max_pixels);
    read_attributes(image);
    read_channels(image);
    return image;
}

Image ExrFile::read(const ImageLimits& limits) {
    Image image = read_header(limits);
    exr_compression_t compression{};
    check(exr_get_compression(context_, PART, &compression));
    if (compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB) {
        read_dwa(image, limits);
    } else {
        for_each_chunk(image, [&](const Chunk& chunk) { decode(chunk, image, limits); });
    }
    return image;
}

}  // namespace

Image decode_exr(std::string_view bytes, const fs::path& name, const ImageLimits& limits) {
    try {
        const ExrBytes file{bytes};
        return ExrFile(file, name).read(limits);
    } catch (const std::bad_alloc&) {
        throw Error(
            "cannot read " + quoted(name) +
                ": there is not enough memory for its pixels; use a smaller image or a larger machine",
            ExitCode::out_of_memory);
    }
}

Image read_exr(const fs::path& path, const ImageLimits& limits) {
    return decode_exr(read_file(path), path, limits);
}

Image read_exr_header(const fs::path& path) {
    constexpr size_t USUAL = 1 << 16;
    const FileStart start = read_file_start(path, USUAL);
    const ExrBytes file{start.bytes, start.size};
    try {
        return ExrFile(file, path).read_header({});
    } catch (const Error&) {
        if (start.bytes.size() == start.size) throw;
    }
    const std::string bytes = read_file(path);  // It is longer than usual, or damaged.
    const ExrBytes whole{bytes};
    return ExrFile(whole, path).read_header({});
}

}  // namespace candela
