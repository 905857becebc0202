// The file of a checkpoint: it keeps every bit, and a damaged one is refused.
#include "render/checkpoint.h"

#include <cstring>

#include <gtest/gtest.h>

#include "accumulation_fixture.h"
#include "base/file.h"
#include "base/image_io.h"
#include "base_fixture.h"
#include "damage.h"
#include "image_fixture.h"

namespace candela {
namespace {

const Identity IDENTITY{
    .settings = {"40x30", "10,20,13,22", "4294967294", "sobol", "mis", "7", "3", "at 1 2 3"},
    .hash = 0x123456789abcdef0u};
const Maker MAKER{.device = "GPU", .driver = "1.2", .version = "0.1"};

class CheckpointFile : public testing::Test {
  protected:
    void save(const Accumulation& state) const { save_checkpoint(file_, IDENTITY, MAKER, 12.5, state); }

    static void expect_same(const Checkpoint& loaded, const Accumulation& state) {
        EXPECT_EQ(loaded.identity.settings, IDENTITY.settings);
        EXPECT_EQ(loaded.identity.hash, IDENTITY.hash);
        EXPECT_EQ(loaded.maker, MAKER);
        EXPECT_EQ(loaded.render_seconds, 12.5);
        EXPECT_EQ(loaded.state.full, state.full);
        EXPECT_EQ(loaded.state.rect, state.rect);
        EXPECT_EQ(loaded.state.seed, state.seed);
        EXPECT_EQ(loaded.state.first_sample, state.first_sample);
        EXPECT_EQ(loaded.state.layer_count, state.layer_count);
        EXPECT_EQ(loaded.state.counters, state.counters);
        ASSERT_EQ(loaded.state.values.size(), state.values.size());
        EXPECT_EQ(
            std::memcmp(loaded.state.values.data(), state.values.data(), state.values.size() * sizeof(float)),
            0);
    }

    TemporaryDirectory folder_;
    std::filesystem::path file_ = folder_ / "state.exr";
};

TEST_F(CheckpointFile, KeepsEveryBit) {
    for (const uint32_t layers : {LAYER_COUNT_COLOUR, LAYER_COUNT_AOVS}) {
        Accumulation state = sampled(layers).state;
        state.values[5] = -0.0f;
        state.values[6] = 0x1p-149f;
        state.values[7] = INFINITE;
        save(state);
        expect_same(load_checkpoint(file_), state);
    }
}

// Bytes that no reader looks at may change; any other change must be noticed.
TEST_F(CheckpointFile, DamageIsNoticed) {
    const Accumulation state = sampled(LAYER_COUNT_COLOUR).state;
    save(state);
    const std::string good = read_file(file_);
    const size_t refused = count_refused(good, std::string("\0\1", 2), 400, [&](const std::string& bytes) {
        if (bytes == good) throw Error("nothing was changed");
        write_quickly(file_, bytes);
        expect_same(load_checkpoint(file_), state);
    });
    EXPECT_GT(refused, 250u);
}

// What OpenEXR itself would not notice: values and attributes that are exchanged for others.
TEST_F(CheckpointFile, ChangesThatLeaveAValidFileAreNoticed) {
    const auto after = [this](const std::function<void(Image&)>& change) {
        save(sampled(LAYER_COUNT_COLOUR).state);
        Image image = read_exr(file_);
        change(image);
        write_exr(file_, image);
        return error_of([&] { load_checkpoint(file_); });
    };
    const std::string name = file_.string() + ": ";
    const std::string damaged =
        name +
        "the checkpoint is damaged: its contents do not have its checksum; use an undamaged "
        "copy, or remove the file to start anew";
    EXPECT_EQ(after([](Image& image) { image.channels[9].values[4] += 0x1p-10f; }), damaged);
    for (const char* attribute :
         {"candela.seed", "candela.firstSample", "candela.rays", "candela.renderSeconds", "candela.driver",
          "candela.sampler", "candela.identity"}) {
        EXPECT_EQ(after([&](Image& image) { image.attributes[attribute] = std::string("1"); }), damaged);
    }
    EXPECT_EQ(after([](Image& image) { image.full.x += 1; }), damaged);
    EXPECT_EQ(
        after([](Image& image) { image.attributes.erase("candela.checksum"); }),
        name + "the attribute candela.checksum is missing; give a file that candela render wrote, unchanged");
    EXPECT_EQ(
        after([](Image& image) {
            std::erase_if(image.channels, [](const Channel& c) { return c.name == "Layer3.G"; });
        }),
        name + "the channel Layer3.G is missing; give a checkpoint that candela render wrote, unchanged");
}

TEST_F(CheckpointFile, UnreadableAndUnwritableFilesAreNamed) {
    const auto expect_named = [](const std::string& message, const std::filesystem::path& path) {
        EXPECT_NE(message.find(path.string()), std::string::npos) << message;
    };
    expect_named(error_of([&] { load_checkpoint(folder_ / "missing.exr"); }), folder_ / "missing.exr");
    write_file_atomically(folder_ / "text.exr", "no image");
    expect_named(error_of([&] { load_checkpoint(folder_ / "text.exr"); }), folder_ / "text.exr");
    const std::filesystem::path nowhere = folder_ / "none/state.exr";
    expect_named(
        error_of([&] { save_checkpoint(nowhere, IDENTITY, MAKER, 0.0, sampled(LAYER_COUNT_COLOUR).state); }),
        nowhere);
    EXPECT_EQ(folder_.size(), 1);
}

}  // namespace
}  // namespace candela
