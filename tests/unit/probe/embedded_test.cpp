// Files that are part of the program: they are those of the repository, and are read as files on disk are.
#include "probe/embedded.h"

#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "base/file.h"
#include "image/image_io.h"
#include "load/json/loader.h"
#include "load/load.h"
#include "unit/base/base_fixture.h"

namespace candela {
namespace {

const std::string REFERENCE = CANDELA_SCENES "/../tests/references/cornell-box.exr";

TEST(Embedded, FilesAreThoseOfTheRepository) {
    EXPECT_EQ(embedded::cornell_box_json, read_file(CANDELA_SCENES "/cornell-box.json"));
    EXPECT_EQ(embedded::furnace_json, read_file(CANDELA_SCENES "/furnace.json"));
    EXPECT_EQ(embedded::cornell_box_exr, read_file(REFERENCE));
}

TEST(Embedded, AnImageInMemoryIsThatOfTheFile) {
    const Image decoded = decode_exr(embedded::cornell_box_exr, "cornell-box.exr"),
                read = read_exr(REFERENCE);
    EXPECT_EQ(decoded.full, read.full);
    EXPECT_EQ(decoded.data, read.data);
    EXPECT_EQ(decoded.attributes, read.attributes);
    ASSERT_EQ(decoded.channels.size(), read.channels.size());
    for (size_t i = 0; i < read.channels.size(); ++i) {
        EXPECT_EQ(decoded.channels[i].name, read.channels[i].name);
        EXPECT_EQ(decoded.channels[i].values, read.channels[i].values);
    }
    ASSERT_TRUE(decoded.find_rgb("Variance").has_value());
}

TEST(Embedded, SaysWhyBytesAreNoImage) {
    EXPECT_EQ(error_of([] { decode_exr("", "a.exr"); }),
              "cannot read \"a.exr\": it is not an OpenEXR file; give an .exr image");
    EXPECT_EQ(error_of([] { decode_exr("not an image at all", "a.exr"); }),
              "cannot read \"a.exr\": it is not an OpenEXR file; give an .exr image");
    // The step hits the header, the table of offsets and the pixels.
    const std::string_view bytes = embedded::cornell_box_exr;
    for (size_t size = 8; size < bytes.size(); size += bytes.size() / 97) {
        const std::string message = error_of([&] { decode_exr(bytes.substr(0, size), "a.exr"); });
        EXPECT_EQ(message.rfind("cannot read \"a.exr\": the file is damaged or incomplete (", 0), 0u)
            << size << ": " << message;
    }
}

TEST(Embedded, AScenesTextIsReadAsItsFileIs) {
    const Scene scene = parse_scene(embedded::cornell_box_json, "cornell-box.json");
    EXPECT_EQ(scene.shapes.size(), load_scene(CANDELA_SCENES "/cornell-box.json").shapes.size());
    EXPECT_EQ(scene.warnings, std::vector<std::string>{});
    EXPECT_EQ(error_of([] { parse_scene("{\n  \"light\": 1 }", "own.json"); }).rfind("own.json:2:3: ", 0),
              0u);
}

}  // namespace
}  // namespace candela
