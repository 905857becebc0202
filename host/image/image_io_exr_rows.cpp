// Decodes OpenEXR files, from headers that can be trusted, by the library's C++ interface.
#include <algorithm>
#include <cstring>
#include <stdexcept>

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>

#include "image/image_io_parts.h"

namespace candela {
namespace {

// The bytes of a file in memory; they must outlive it.
class MemoryFile : public Imf::IStream {
  public:
    explicit MemoryFile(std::string_view bytes) : Imf::IStream(""), bytes_(bytes) {}

    bool read(char* out, int count) override {
        const auto size = size_t(count);
        if (position_ > bytes_.size() || size > bytes_.size() - position_)
            throw std::runtime_error("it ends early");
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

}  // namespace

void grow(Image& image, uint32_t rows, const ImageLimits& limits) {
    for (Channel& channel : image.channels) {
        if (limits.wants(channel.name)) channel.values.resize(size_t(rows) * image.data.width());
    }
}

void decode_exr_by_rows(std::string_view bytes, Image& image, const ImageLimits& limits) {
    constexpr uint32_t ROWS = 256;  // Decoded at once; no chunk of scan lines has more.
    MemoryFile stream(bytes);
    Imf::InputFile file(stream);
    const Imath::Box2i& window = file.header().dataWindow();
    const uint32_t height = image.data.height();
    for (uint32_t y = 0; y < height; y += ROWS) {
        const uint32_t end = std::min(y + ROWS, height);
        grow(image, end, limits);
        Imf::FrameBuffer frame;
        for (Channel& channel : image.channels) {
            if (limits.wants(channel.name))
                frame.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), window));
        }
        file.setFrameBuffer(frame);
        file.readPixels(int(window.min.y + int64_t(y)), int(window.min.y + int64_t(end) - 1));
    }
}

}  // namespace candela
