// OpenEXR files; no other file includes OpenEXR.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTestFile.h>
#include <ImfThreading.h>

#include "base/error.h"
#include "base/file.h"
#include "base/image_io.h"
#include "base/image_io_parts.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

// Attributes of every OpenEXR file that speak of the file, not of the picture; an Image does not keep them.
constexpr std::array<std::string_view, 4> FILE_ATTRIBUTES = {"name", "type", "pixelAspectRatio",
                                                             "screenWindowWidth"};

// A file in memory, for OpenEXR to write to.
class MemoryStream : public Imf::OStream {
  public:
    MemoryStream() : Imf::OStream("") {}

    void write(const char* bytes, int count) override {
        const auto size = size_t(count);
        if (position_ + size > bytes_.size()) bytes_.resize(position_ + size);
        std::memcpy(bytes_.data() + position_, bytes, size);
        position_ += size;
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t position) override { position_ = position; }

    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
    size_t position_ = 0;
};

// The bytes of a file in memory, for OpenEXR to read; they must outlive it.
class MemoryFile : public Imf::IStream {
  public:
    MemoryFile(std::string_view bytes, const std::string& name) : Imf::IStream(name.c_str()), bytes_(bytes) {}

    bool read(char* out, int count) override {
        const auto size = size_t(count);
        if (position_ > bytes_.size() || size > bytes_.size() - position_) {
            throw std::runtime_error("it ends early");
        }
        std::memcpy(out, bytes_.data() + position_, size);
        position_ += size;
        return position_ < bytes_.size();
    }
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t position) override { position_ = position; }

  private:
    std::string_view bytes_;
    size_t position_ = 0;
};

// A glm matrix for column vectors is stored column by column, an Imath matrix for row vectors row by row.
// Each is the other transposed, and stored transposed: the 16 numbers stay in place.
Imath::M44f to_imath(const mat4& m) {
    Imath::M44f result;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j)
            result[i][j] = m[i][j];
    }
    return result;
}

mat4 to_glm(const Imath::M44f& m) {
    mat4 result;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j)
            result[i][j] = m[i][j];
    }
    return result;
}

void insert(Imf::Header& header, const std::string& name, const Attribute& attribute) {
    if (const auto* text = std::get_if<std::string>(&attribute)) {
        header.insert(name, Imf::StringAttribute(*text));
    } else if (const auto* number = std::get_if<float>(&attribute)) {
        header.insert(name, Imf::FloatAttribute(*number));
    } else {
        header.insert(name, Imf::M44fAttribute(to_imath(std::get<mat4>(attribute))));
    }
}

Imf::Header make_header(const Image& image) {
    const Imath::Box2i display({0, 0}, {int(image.full.x) - 1, int(image.full.y) - 1});
    const Imath::Box2i data({int(image.data.x0), int(image.data.y0)},
                            {int(image.data.x1) - 1, int(image.data.y1) - 1});
    Imf::Header header(display, data);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::addChromaticities(header, Imf::Chromaticities());  // The default is Rec.709.
    for (const auto& [name, attribute] : image.attributes) {
        insert(header, name, attribute);
    }
    for (const Channel& channel : image.channels) {
        header.channels().insert(channel.name, Imf::Channel(channel.half ? Imf::HALF : Imf::FLOAT));
    }
    return header;
}

std::vector<half> to_half(const fs::path& path, const Image& image, const Channel& channel) {
    std::vector<half> values(channel.values.size());
    for (size_t i = 0; i < values.size(); ++i) {
        const float value = channel.values[i];
        values[i] = value;
        if (values[i].isInfinity() && std::isfinite(value)) {
            const size_t x = image.data.x0 + i % image.data.width();
            const size_t y = image.data.y0 + i / image.data.width();
            throw Error("cannot write " + quoted(path) + ": channel \"" + channel.name + "\" is " +
                        std::to_string(value) + " at pixel (" + std::to_string(x) + ", " + std::to_string(y) +
                        "), more than a 16-bit float can hold (65504); write 32-bit floats");
        }
    }
    return values;
}

Image read_header(const fs::path& path, const Imf::Header& header) {
    const Imath::Box2i& display = header.displayWindow();
    const Imath::Box2i& data = header.dataWindow();
    if (data.min.x < display.min.x || data.min.y < display.min.y || data.max.x > display.max.x ||
        data.max.y > display.max.y) {
        throw Error("cannot read " + quoted(path) +
                    ": its data window exceeds its display window; crop the image to the display window");
    }
    // In 64 bits: windows may lie anywhere in the range of int.
    const auto offset = [](int from, int to) { return uint32_t(int64_t(to) - int64_t(from)); };
    Image image;
    image.full = {offset(display.min.x, display.max.x) + 1, offset(display.min.y, display.max.y) + 1};
    image.data = {offset(display.min.x, data.min.x), offset(display.min.y, data.min.y),
                  offset(display.min.x, data.max.x) + 1, offset(display.min.y, data.max.y) + 1};
    for (auto it = header.begin(); it != header.end(); ++it) {
        if (std::ranges::find(FILE_ATTRIBUTES, it.name()) != FILE_ATTRIBUTES.end()) continue;
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute())) {
            image.attributes[it.name()] = text->value();
        } else if (const auto* number = dynamic_cast<const Imf::FloatAttribute*>(&it.attribute())) {
            image.attributes[it.name()] = number->value();
        } else if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&it.attribute())) {
            image.attributes[it.name()] = to_glm(matrix->value());
        }
    }
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        if (it.channel().xSampling != 1 || it.channel().ySampling != 1) {
            throw Error("cannot read " + quoted(path) + ": channel \"" + it.name() +
                        "\" is subsampled; write it at full resolution");
        }
        image.channels.push_back({it.name(), {}, it.channel().type == Imf::HALF});
    }
    return image;
}

// Reads the pixels strip by strip and lets the channels grow with them, so that a short file whose header
// claims a huge picture runs out of file before the machine runs out of memory.
void read_pixels(Imf::InputFile& file, Image& image) {
    constexpr uint32_t STRIP_PIXELS = 1 << 22;
    const int64_t rows = std::max(1u, STRIP_PIXELS / image.data.width());
    const Imath::Box2i& window = file.header().dataWindow();
    Imf::FrameBuffer frame;
    for (Channel& channel : image.channels) {
        channel.values.reserve(image.pixel_count());
        frame.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), window));
    }
    file.setFrameBuffer(frame);
    for (int64_t first = window.min.y; first <= window.max.y; first += rows) {
        const int64_t last = std::min<int64_t>(first + rows - 1, window.max.y);
        for (Channel& channel : image.channels) {
            channel.values.resize(size_t(last + 1 - window.min.y) * image.data.width());
        }
        file.readPixels(int(first), int(last));
    }
}

// Reads from what OpenEXR takes for a file: a path or a stream. `path` is its name in messages.
template <class Source>
Image read_from(Source& source, const fs::path& path, uint64_t max_pixels) {
    try {
        if (!Imf::isOpenExrFile(source)) {
            throw Error("cannot read " + quoted(path) + ": it is not an OpenEXR file; give an .exr image");
        }
        Imf::Header::setMaxImageSize(int(MAX_IMAGE_SIDE), int(MAX_IMAGE_SIDE));
        Imf::InputFile file(source);
        Image image = read_header(path, file.header());
        check_pixel_count(path, image.data.width(), image.data.height(), max_pixels);
        read_pixels(file, image);
        return image;
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw Error("cannot read " + quoted(path) +
                    ": there is not enough memory for its pixels; use a smaller image or a larger machine");
    } catch (const std::exception& error) {
        throw Error("cannot read " + quoted(path) + ": the file is damaged or incomplete (" + error.what() +
                    "); write it again");
    }
}

}  // namespace

void write_exr(const fs::path& path, const Image& image) {
    assert(image.pixel_count() > 0 && image.data.x1 <= image.full.x && image.data.y1 <= image.full.y);
    std::vector<std::vector<half>> halves;  // Of the 16-bit channels; must live until the pixels are written.
    for (const Channel& channel : image.channels) {
        if (channel.half) halves.push_back(to_half(path, image, channel));
    }
    MemoryStream stream;
    try {
        const Imf::Header header = make_header(image);
        Imf::FrameBuffer frame;
        auto next_half = halves.cbegin();
        for (const Channel& channel : image.channels) {
            assert(channel.values.size() == image.pixel_count());
            const void* values = channel.half ? static_cast<const void*>((next_half++)->data())
                                              : static_cast<const void*>(channel.values.data());
            const Imf::PixelType type = channel.half ? Imf::HALF : Imf::FLOAT;
            frame.insert(channel.name, Imf::Slice::Make(type, values, header.dataWindow()));
        }
        // ZIP takes most of the time of writing; the order of the file does not depend on the threads.
        Imf::setGlobalThreadCount(int(std::thread::hardware_concurrency()));
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(frame);
        file.writePixels(int(image.data.height()));
    } catch (const std::exception& error) {
        throw Error("cannot write " + quoted(path) + ": OpenEXR refuses the image (" + error.what() + ')');
    }
    write_file_atomically(path, stream.bytes());
}

Image read_exr(const fs::path& path, uint64_t max_pixels) {
    const std::string bytes = read_file(path);
    MemoryFile file(bytes, path.string());
    return read_from(file, path, max_pixels);
}

Image decode_exr(std::string_view bytes, const std::string& name) {
    MemoryFile file(bytes, name);
    return read_from(file, name, UINT64_MAX);
}

}  // namespace candela
