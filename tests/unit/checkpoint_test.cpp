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

const CheckpointHeader HEADER{
    .identity = {.settings = {"40x30", "10,20,13,22", "4294967294", "sobol", "mis", "7", "3", "at 1 2 3"},
                 .hash = 0x123456789abcdef0u},
    .maker = {.device = "GPU", .driver = "1.2", .version = "0.1"},
    .render_seconds = 12.5,
    .planned = 64};

class CheckpointFile : public testing::Test {
  protected:
    using States = std::vector<Accumulation>;

    void save(const States& states) const { save_checkpoint(file_, HEADER, states); }

    static void expect_same(const Checkpoint& loaded, const States& states) {
        EXPECT_EQ(loaded.header.identity.settings, HEADER.identity.settings);
        EXPECT_EQ(loaded.header.identity.hash, HEADER.identity.hash);
        EXPECT_EQ(loaded.header.maker, HEADER.maker);
        EXPECT_EQ(loaded.header.render_seconds, HEADER.render_seconds);
        EXPECT_EQ(loaded.header.planned, HEADER.planned);
        ASSERT_EQ(loaded.states.size(), states.size());
        for (size_t i = 0; i < states.size(); ++i) {
            const Accumulation &a = loaded.states[i], &b = states[i];
            EXPECT_EQ(a.full, b.full);
            EXPECT_EQ(a.rect, b.rect);
            EXPECT_EQ(a.seed, b.seed);
            EXPECT_EQ(a.first_sample, b.first_sample);
            EXPECT_EQ(a.layer_count, b.layer_count);
            EXPECT_EQ(a.counters, b.counters);
            ASSERT_EQ(a.values.size(), b.values.size());
            EXPECT_EQ(std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(float)), 0);
        }
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
        save({state});
        expect_same(load_checkpoint(file_), {state});
    }
}

TEST_F(CheckpointFile, KeepsSeveralStates) {
    States states(4, sampled(LAYER_COUNT_AOVS).state);
    for (uint32_t i = 0; i < states.size(); ++i) {
        states[i].seed ^= i << 30;
        states[i].counters.rays += i;
        states[i].values[i] = 100.0f + float(i);
        states[i].set_limit(i, 1000 * i);
    }
    save(states);
    const Checkpoint loaded = load_checkpoint(file_);
    expect_same(loaded, states);
    EXPECT_EQ(loaded.states[3].limit(3), 3000u);
}

// Bytes that no reader looks at may change; any other change must be noticed.
TEST_F(CheckpointFile, DamageIsNoticed) {
    const States states = {sampled(LAYER_COUNT_COLOUR).state};
    save(states);
    const std::string good = read_file(file_);
    const size_t refused = count_refused(good, std::string("\0\1", 2), 400, [&](const std::string& bytes) {
        if (bytes == good) throw Error("nothing was changed");
        write_quickly(file_, bytes);
        expect_same(load_checkpoint(file_), states);
    });
    EXPECT_GT(refused, 250u);
}

// What OpenEXR itself would not notice: values and attributes that are exchanged for others.
TEST_F(CheckpointFile, ChangesThatLeaveAValidFileAreNoticed) {
    const auto after = [this](const std::function<void(Image&)>& change) {
        save({2, sampled(LAYER_COUNT_COLOUR).state});
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
          "candela.sampler", "candela.identity", "candela.planned", "candela.State1.seed"}) {
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
    EXPECT_EQ(after([](Image& image) {
                  std::erase_if(image.channels,
                                [](const Channel& c) { return c.name.starts_with("State1."); });
              }),
              damaged);
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
        error_of([&] { save_checkpoint(nowhere, HEADER, States{sampled(LAYER_COUNT_COLOUR).state}); }),
        nowhere);
    EXPECT_EQ(folder_.size(), 1);
}

}  // namespace
}  // namespace candela
