// OpenEXR files as other programs write them: what an Image can hold is read, and all else is refused by
// name.
#include <array>
#include <cstring>

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include "base/file.h"
#include "image/image_io.h"
#include "unit/base/base_fixture.h"
#include "unit/image/image_fixture.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

TEST(Exr, ReadsTilesIntegersAndShiftedWindows) {
    const TemporaryDirectory directory;
    const fs::path path = directory / "tiled.exr";
    // 100 x 70 pixels at (-10, 5) in a display window from (-20, 0) to (99, 79).
    const Imath::Box2i window({-10, 5}, {89, 74});
    Imf::Header header(Imath::Box2i({-20, 0}, {99, 79}), window);
    header.channels().insert("id", Imf::Channel(Imf::UINT));
    header.channels().insert("G", Imf::Channel(Imf::HALF));
    header.setTileDescription(Imf::TileDescription(32, 16));
    std::vector<uint32_t> ids(100 * 70);
    std::vector<half> greens(100 * 70);
    for (size_t i = 0; i < ids.size(); ++i) {
        ids[i] = uint32_t(i);
        greens[i] = half(float(i % 1000));
    }
    {
        Imf::TiledOutputFile file(path.string().c_str(), header);
        Imf::FrameBuffer frame;
        frame.insert("id", Imf::Slice::Make(Imf::UINT, ids.data(), window));
        frame.insert("G", Imf::Slice::Make(Imf::HALF, greens.data(), window));
        file.setFrameBuffer(frame);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    }
    const Image image = read_exr(path);
    EXPECT_EQ(image.full, uvec2(120, 80));
    EXPECT_EQ(image.data, (PixelRect{10, 5, 110, 75}));
    ASSERT_EQ(image.channels.size(), 2u);
    for (size_t i = 0; i < ids.size(); ++i) {
        ASSERT_EQ(image.find("id")->values[i], float(i));
        ASSERT_EQ(image.find("G")->values[i], float(i % 1000));
    }
}

// Writes one row of 4 pixels of the channel "Y" in that data window, of a picture of 4 x 1 pixels.
void write_row(const fs::path& path, const Imath::Box2i& window, int sampling) {
    Imf::Header header(Imath::Box2i({0, 0}, {3, 0}), window);
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT, sampling, 1));
    const std::vector<float> values(4, 1.0f);
    Imf::FrameBuffer frame;
    frame.insert("Y", Imf::Slice::Make(Imf::FLOAT, values.data(), window, 0, 0, sampling, 1));
    Imf::OutputFile file(path.string().c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(1);
}

TEST(Exr, RefusesWhatAnImageCannotHold) {
    const TemporaryDirectory directory;
    const fs::path path = directory / "a.exr";
    write_row(path, Imath::Box2i({1, 0}, {4, 0}), 1);
    EXPECT_EQ(error_of([&] { read_exr(path); }),
              "cannot read \"" + path.string() +
                  "\": its data window exceeds its display window; crop the image to the display window");
    write_row(path, Imath::Box2i({0, 0}, {3, 0}), 2);
    EXPECT_EQ(
        error_of([&] { read_exr(path); }),
        "cannot read \"" + path.string() + "\": channel \"Y\" is subsampled; write it at full resolution");
}

// A file of 96 x 70 pixels of these channels, whose values are multiples of 64 in each block of four by four:
// no compression changes such halves. In scan lines, or in tiles of that size.
std::vector<half> write_compressed(const fs::path& path, Imf::Compression compression, uint32_t tile_size) {
    constexpr int WIDTH = 96, HEIGHT = 70;
    Imf::Header header(WIDTH, HEIGHT);
    header.compression() = compression;
    std::vector<half> values(size_t{WIDTH} * HEIGHT);
    for (size_t i = 0; i < values.size(); ++i)
        values[i] = half(float(64 * (1 + i % WIDTH / 4 % 5 + i / WIDTH / 4 % 3)));
    Imf::FrameBuffer frame;
    for (const char* name : {"R", "id", "Z"}) {
        header.channels().insert(name, Imf::Channel(Imf::HALF));
        frame.insert(name, Imf::Slice::Make(Imf::HALF, values.data(), header.dataWindow()));
    }
    if (tile_size == 0) {
        Imf::OutputFile file(path.string().c_str(), header);
        file.setFrameBuffer(frame);
        file.writePixels(HEIGHT);
    } else {
        header.setTileDescription({tile_size, tile_size, Imf::MIPMAP_LEVELS});
        Imf::TiledOutputFile file(path.string().c_str(), header);
        file.setFrameBuffer(frame);
        file.writeTiles(0, file.numXTiles(0) - 1, 0, file.numYTiles(0) - 1, 0);
        // Without the smaller resolutions, the file would be incomplete.
        for (int level = 1; level < file.numLevels(); ++level)
            file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
    }
    return values;
}

void expect_compression_is_read(const fs::path& path, Imf::Compression compression, uint32_t tile_size) {
    const std::vector<half> values = write_compressed(path, compression, tile_size);
    const Image image = read_exr(path);
    ASSERT_EQ(image.channels.size(), 3u);
    // DWA keeps no more than the eye sees.
    const float tolerance = compression >= Imf::DWAA_COMPRESSION ? 0.1f : 0.0f;
    for (size_t i = 0; i < values.size(); ++i) {
        ASSERT_NEAR(image.find("R")->values[i], values[i], tolerance * values[i]);
        ASSERT_EQ(image.find("id")->values[i], values[i]);
    }
    const Image one = read_exr(path, {.channels = {"id"}});
    EXPECT_EQ(one.find("id")->values, image.find("id")->values);
    EXPECT_TRUE(one.find("R")->values.empty());
}

TEST(Exr, ReadsEveryCompressionInScanLinesAndTiles) {
    const TemporaryDirectory directory;
    const fs::path path = directory / "a.exr";
    for (const auto compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,
          Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION,
          Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION}) {
        for (const uint32_t tile_size : {0u, 32u, 128u}) {
            SCOPED_TRACE(std::to_string(compression) + " in tiles of " + std::to_string(tile_size));
            expect_compression_is_read(path, compression, tile_size);
        }
    }
}

// The bytes of the only chunk are replaced, which follow the number of its first line and their own number.
TEST(Exr, RefusesAChunkThatIsShorterThanItsPixels) {
    const TemporaryDirectory directory;
    const fs::path path = directory / "a.exr";
    Imf::Header header(1024, 1);
    header.compression() = Imf::RLE_COMPRESSION;
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    const std::vector<float> values(1024, 1.0f);
    {
        Imf::FrameBuffer frame;
        frame.insert("R", Imf::Slice::Make(Imf::FLOAT, values.data(), header.dataWindow()));
        Imf::OutputFile file(path.string().c_str(), header);
        file.setFrameBuffer(frame);
        file.writePixels(1);
    }
    const std::string bytes = read_file(path);
    const size_t chunk = bytes.rfind(std::string("\0\0\0\0", 4), bytes.size() - 1 - 4 * 32);
    ASSERT_EQ(read_exr(path).find("R")->values, values);
    uint64_t offset = 0;  // The last eight bytes before the chunk say where it begins.
    for (size_t at = chunk; at > 8 && offset == 0; --at) {
        std::memcpy(&offset, bytes.data() + at - 8, 8);
        if (offset != at) offset = 0;
    }
    ASSERT_NE(offset, 0u);
    // Runs of 128 bytes: all, all but one, one, none.
    for (const size_t runs : {32u, 31u, 1u, 0u}) {
        std::string data;
        for (size_t i = 0; i < runs; ++i)
            data += std::string("\x7f\x80", 2);
        const auto size = uint32_t(data.size());
        std::string short_chunk(8, '\0');
        std::memcpy(short_chunk.data() + 4, &size, 4);
        write_quickly(path, bytes.substr(0, offset) + short_chunk + data);
        if (runs == 32) {
            EXPECT_EQ(read_exr(path).pixel_count(), 1024u);
        } else {
            EXPECT_TRUE(
                error_of([&] {
                    read_exr(path);
                }).starts_with("cannot read \"" + path.string() + "\": the file is damaged or incomplete ("))
                << runs;
        }
    }
}

TEST(Exr, OfSeveralPartsReadsTheFirstAndOfDeepPixelsNone) {
    const TemporaryDirectory directory;
    const fs::path path = directory / "a.exr";
    const std::vector<float> ones(4, 1.0f), twos(4, 2.0f);
    {
        std::vector<Imf::Header> headers(2, Imf::Header(4, 1));
        for (size_t i = 0; i < headers.size(); ++i) {
            headers[i].setName(i == 0 ? "first" : "second");
            headers[i].setType(Imf::SCANLINEIMAGE);
            headers[i].channels().insert("Y", Imf::Channel(Imf::FLOAT));
        }
        Imf::MultiPartOutputFile file(path.string().c_str(), headers.data(), 2);
        for (int i = 0; i < 2; ++i) {
            Imf::OutputPart part(file, i);
            Imf::FrameBuffer frame;
            frame.insert(
                "Y", Imf::Slice::Make(Imf::FLOAT, (i == 0 ? ones : twos).data(), headers[0].dataWindow()));
            part.setFrameBuffer(frame);
            part.writePixels(1);
        }
    }
    EXPECT_EQ(read_exr(path).find("Y")->values, ones);
    {
        Imf::Header header(4, 1);
        header.setType(Imf::DEEPSCANLINE);
        header.compression() = Imf::ZIPS_COMPRESSION;
        header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
        Imf::DeepScanLineOutputFile file(path.string().c_str(), header);
        const std::vector<unsigned> counts(4, 1);
        std::vector<float> depths(4, 1.0f);
        std::vector<float*> samples{&depths[0], &depths[1], &depths[2], &depths[3]};
        Imf::DeepFrameBuffer frame;
        frame.insertSampleCountSlice(Imf::Slice::Make(Imf::UINT, counts.data(), header.dataWindow()));
        frame.insert("Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(samples.data()), sizeof(float*),
                                         sizeof(float*) * 4, sizeof(float)));
        file.setFrameBuffer(frame);
        file.writePixels(1);
    }
    EXPECT_EQ(
        error_of([&] { read_exr(path); }),
        "cannot read \"" + path.string() + "\": it has deep pixels, of several samples each; flatten it");
}

}  // namespace
}  // namespace candela
