// See image_io_exr_file.h.
#include "image/image_io_exr_file.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <new>

#include "base/error.h"
#include "base/file.h"
#include "base/printable.h"
#include "image/image_io_parts.h"

namespace candela {

namespace fs = std::filesystem;

namespace {

// Attributes of every OpenEXR file that describe the file, not the picture; an Image does not keep them.
constexpr std::array<std::string_view, 4> FILE_ATTRIBUTES = {"name", "type", "pixelAspectRatio",
                                                             "screenWindowWidth"};

// The library's last message; its functions return only a code.
thread_local std::string library_message;

void take_message(exr_const_context_t, exr_result_t, const char* message) {
    library_message = message;
}

// Zeroed, so that a damaged chunk that leaves something out does not expose old memory; and bounded.
void* allocate(size_t size) {
    return size > 2 * MAX_CHUNK_BYTES ? nullptr : std::calloc(1, std::max<size_t>(size, 1));
}

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
// Each is the transpose of the other, and stored transposed: the 16 numbers stay in place.
mat4 to_glm(const float* numbers) {
    mat4 result;
    for (int i = 0; i < 16; ++i)
        result[i / 4][i % 4] = numbers[i];
    return result;
}

// The library's time grows with the square of the number of channels: a tenth of a second for ten thousand.
constexpr uint32_t MAX_CHANNEL_BYTES = 1 << 18;

// The size of the list of channels that the first header states; 0 if it has none.
uint32_t channel_bytes(std::string_view file) {
    constexpr size_t ATTRIBUTES = 8;  // Offset of the attributes.
    uint32_t max = 0;
    std::string_view rest = file.substr(std::min(ATTRIBUTES, file.size()));
    while (!rest.empty() && rest[0] != '\0') {
        const size_t name = rest.find('\0');
        const size_t type = name == std::string_view::npos ? name : rest.find('\0', name + 1);
        uint32_t size = 0;
        if (type == std::string_view::npos || rest.size() - type - 1 < sizeof size) break;
        std::memcpy(&size, &rest[type + 1], sizeof size);
        if (rest.substr(0, name) == "channels") max = std::max(max, size);
        rest.remove_prefix(type + 1 + sizeof size);
        rest.remove_prefix(std::min<size_t>(size, rest.size()));
    }
    return max;
}

}  // namespace

ExrFile::ExrFile(const ExrBytes& file, const fs::path& path) : bytes_(file.bytes), path_(path) {
    if (!bytes_.starts_with(EXR_MAGIC)) fail("it is not an OpenEXR file; give an .exr image");
    if (channel_bytes(bytes_) > MAX_CHANNEL_BYTES) fail("it has thousands of channels; write fewer");
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
    check(exr_start_read(&context_, path.string().c_str(), &wishes));
}

void ExrFile::fail(const std::string& why) const {
    throw Error("cannot read " + quoted(path_) + ": " + why);
}

void ExrFile::fail_damaged(const std::string& how) const {
    fail("the file is damaged or incomplete (" + how + "); write it again");
}

void ExrFile::check(exr_result_t result) const {
    if (result == EXR_ERR_SUCCESS) return;
    if (result == EXR_ERR_OUT_OF_MEMORY) throw std::bad_alloc();
    fail_damaged(library_message.empty() ? exr_get_default_error_message(result) : library_message);
}

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
            fail("channel \"" + printable(name, MAX_NAME_BYTES) +
                 "\" is subsampled; write it at full resolution");
        image.channels.push_back({name, {}, entry.pixel_type == EXR_PIXEL_HALF});
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

Image read_exr_header(const fs::path& path) {
    constexpr size_t USUAL = 1 << 16;
    const FileStart start = read_file_start(path, USUAL);
    const ExrBytes file{start.bytes, start.size};
    try {
        return ExrFile(file, path).read_header({});
    } catch (const Error&) {
        if (start.bytes.size() == start.size) throw;
    }
    const std::string bytes = read_file(path);  // The header is longer than usual, or damaged.
    const ExrBytes whole{bytes};
    return ExrFile(whole, path).read_header({});
}

}  // namespace candela
