// OpenEXR files of every compression, type and odd size, in lines and tiles, against the library's C++
// reader.
#include <bit>
#include <random>

#include <ImfChannelList.h>
#include <ImfCompression.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <half.h>

#include "image/image_io.h"

namespace candela {
namespace {

struct ExrForm {
    Imf::Compression compression;
    std::string channels;  // One for each letter: h, f or u, for half, float or uint.
    Imath::V2i size;
    bool tiled;
    bool noisy;  // What no compression makes smaller, so that chunks are stored as they are.
};

Imf::PixelType type_of(char letter) {
    return letter == 'h' ? Imf::HALF : letter == 'f' ? Imf::FLOAT : Imf::UINT;
}

Imath::Box2i window_of(const ExrForm& form) {
    const Imath::V2i origin(-3, 7);
    return {origin, origin + form.size - Imath::V2i(1)};
}

std::string written(const ExrForm& form) {
    const Imath::Box2i window = window_of(form);
    Imf::Header header(Imath::Box2i({-5, 0}, {70, 80}), window);
    header.compression() = form.compression;
    const size_t count = size_t(form.size.x) * size_t(form.size.y);
    std::vector<half> halves;
    std::vector<float> floats;
    std::vector<uint32_t> uints;
    std::mt19937 random(7);
    for (size_t i = 0; i < count; ++i) {
        floats.push_back(form.noisy ? std::bit_cast<float>(0x3f000000u | uint32_t(random()) >> 9u)
                                    : float(i / 8) / 16.0f);
        halves.emplace_back(floats.back());
        uints.push_back(uint32_t(form.noisy ? random() : i / 8));
    }
    Imf::FrameBuffer frame;
    for (const char letter : form.channels) {
        const std::string name(1, letter);
        header.channels().insert(name, Imf::Channel(type_of(letter)));
        const void* values = letter == 'h'   ? static_cast<const void*>(halves.data())
                             : letter == 'f' ? static_cast<const void*>(floats.data())
                                             : uints.data();
        frame.insert(name, Imf::Slice::Make(type_of(letter), values, window));
    }
    Imf::StdOSStream stream;
    if (form.tiled) {
        header.setTileDescription({16, 8, Imf::ONE_LEVEL});
        Imf::TiledOutputFile file(stream, header);
        file.setFrameBuffer(frame);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    } else {
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(frame);
        file.writePixels(form.size.y);
    }
    return stream.str();
}

std::vector<float> read_by_library(const std::string& bytes, const ExrForm& form, char letter) {
    Imf::StdISStream stream;
    stream.str(bytes);
    Imf::InputFile file(stream);
    std::vector<float> values(size_t(form.size.x) * size_t(form.size.y));
    Imf::FrameBuffer frame;
    const Imath::Box2i window = window_of(form);
    frame.insert(std::string(1, letter), Imf::Slice::Make(Imf::FLOAT, values.data(), window));
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    return values;
}

TEST(Exr, ChunksOfAnyKindAndSizeAreWhatTheLibraryReads) {
    for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression) {
        for (const char* channels : {"h", "f", "u", "fhu"}) {
            for (const Imath::V2i& size : {Imath::V2i(1, 1), {4, 4}, {5, 5}, {8, 33}, {37, 18}}) {
                for (const bool tiled : {false, true}) {
                    for (const bool noisy : {false, true}) {
                        SCOPED_TRACE(testing::Message() << compression << ' ' << channels << ' ' << size
                                                        << ' ' << tiled << ' ' << noisy);
                        const ExrForm form{Imf::Compression(compression), channels, size, tiled, noisy};
                        const std::string bytes = written(form);
                        const Image image = decode_exr(bytes, "a.exr");
                        EXPECT_EQ(image.data, (PixelRect{2, 7, 2 + uint32_t(size.x), 7 + uint32_t(size.y)}));
                        for (const char letter : form.channels) {
                            ASSERT_EQ(image.find(std::string(1, letter))->values,
                                      read_by_library(bytes, form, letter))
                                << letter;
                        }
                    }
                }
            }
        }
    }
}

}  // namespace
}  // namespace candela
