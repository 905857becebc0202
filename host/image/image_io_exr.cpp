// Writes OpenEXR files, by the library's C++ interface, which compresses on all cores.
#include <cassert>
#include <cmath>
#include <cstring>
#include <string>
#include <system_error>
#include <thread>

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>

#include "base/error.h"
#include "base/file.h"
#include "image/image_io.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

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

// A glm matrix for column vectors is stored column by column, an Imath matrix for row vectors row by row.
// Each is the transpose of the other, and stored transposed: the 16 numbers stay in place.
Imath::M44f to_imath(const mat4& m) {
    Imath::M44f result;
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

// Returns whether the library has that many threads now.
bool set_thread_count(int count) {
    try {
        Imf::setGlobalThreadCount(count);
        return true;
    } catch (const std::system_error&) {
        return false;
    }
}

// Lets the library compress on all cores, since compression is most of the time of writing; the file does not
// depend on their number. If the system allows fewer threads, the library gets none, and uses the caller's:
// OpenEXR 3.1.13 would join, at the end of the program, a thread that was never started, and abort.
void start_threads() {
    const auto cores = int(std::thread::hardware_concurrency());
    for (int count = Imf::globalThreadCount() + 1; count <= cores; ++count) {
        if (set_thread_count(count)) continue;
        set_thread_count(0);
        return;
    }
}

}  // namespace

void write_exr(const fs::path& path, const Image& image, FileWriter write) {
    assert(image.pixel_count() > 0 && image.data.x1 <= image.full.x && image.data.y1 <= image.full.y);
    std::vector<std::vector<half>> halves;  // Values of the 16-bit channels; must live until the pixels are
                                            // written.
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
        start_threads();
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(frame);
        file.writePixels(int(image.data.height()));
    } catch (const std::exception& error) {
        throw Error("cannot write " + quoted(path) + ": OpenEXR refuses the image (" + error.what() + ')');
    }
    write(path, stream.bytes());
}

}  // namespace candela
