// The file of a checkpoint: it keeps every bit, and a damaged one is refused.
#include "film/checkpoint.h"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "base/file.h"
#include "image/image_io.h"
#include "unit/base/base_fixture.h"
#include "unit/base/damage.h"
#include "unit/film/accumulation_fixture.h"
#include "unit/image/image_fixture.h"

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
            EXPECT_EQ(a.denoising_layer, b.denoising_layer);
            EXPECT_EQ(a.counters, b.counters);
            ASSERT_EQ(a.values.size(), b.values.size());
            EXPECT_EQ(std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(float)), 0);
        }
    }

    // The states of an adaptive rendering.
    static States four_states() {
        States states(4, sampled(LAYER_COUNT_COLOUR).state);
        for (uint32_t i = 0; i < states.size(); ++i)
            states[i].seed ^= i << 30;
        return states;
    }

    TemporaryDirectory folder_;
    std::filesystem::path file_ = folder_ / "state.exr";
};

TEST_F(CheckpointFile, KeepsEveryBit) {
    for (const uint32_t layers : {LAYER_COUNT_COLOUR, LAYER_COUNT_AOVS, LAYER_COUNT_CATCHERS}) {
        Accumulation state = sampled(layers).state;
        state.values[4] = -0.0f;
        state.values[5] = 0x1p-149f;
        state.values[6] = INFINITE;
        save({state});
        expect_same(load_checkpoint(file_), {state});
    }
}

// The same number of layers may be those of colour and guides, or of colour, albedo and normals.
TEST_F(CheckpointFile, TellsGuidesFromOtherLayers) {
    for (const uint32_t layers : {LAYER_COUNT_COLOUR, LAYER_COUNT_AOVS, LAYER_COUNT_CATCHERS}) {
        Accumulation state = sampled(layers + LAYER_COUNT_GUIDES).state;
        state.denoising_layer = layers;
        save({state});
        EXPECT_EQ(std::get<std::string>(read_exr(file_).attributes.at("candela.checkpoint")), "2");
        expect_same(load_checkpoint(file_), {state});
    }
    save({sampled(LAYER_COUNT_AOVS).state});
    Image image = read_exr(file_);
    EXPECT_EQ(std::get<std::string>(image.attributes.at("candela.checkpoint")), "1");
    image.attributes["candela.denoisingLayer"] = std::string("7");
    write_exr(file_, image);
    EXPECT_EQ(error_of([&] { load_checkpoint(file_); }),
              file_.string() +
                  ": the checkpoint is damaged: it says that the layers of guides begin with 7; use an "
                  "undamaged copy, or remove the file to start over");
}

TEST_F(CheckpointFile, KeepsSeveralStates) {
    States states(4, sampled(LAYER_COUNT_AOVS).state);
    for (uint32_t i = 0; i < states.size(); ++i) {
        states[i].seed ^= i << 30;
        states[i].counters.rays += i;
        states[i].values[4 * i] = 100.0f + float(i);
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
        save(four_states());
        Image image = read_exr(file_);
        change(image);
        write_exr(file_, image);
        return error_of([&] { load_checkpoint(file_); });
    };
    const std::string name = file_.string() + ": ";
    const std::string damaged =
        name +
        "the checkpoint is damaged: its contents do not match its checksum; use an undamaged "
        "copy, or remove the file to start over";
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
                                [](const Channel& c) { return c.name.starts_with("State3."); });
              }),
              name +
                  "the checkpoint is damaged: it does not hold as many states as it says; use an undamaged "
                  "copy, or remove the file to start over");
}

// The checksum of these files is right.
TEST_F(CheckpointFile, WhatNoRendererLeavesIsRefused) {
    const auto expect_refused = [this](const States& states, const std::string& what) {
        save(states);
        EXPECT_EQ(error_of([&] { load_checkpoint(file_); }),
                  file_.string() + ": the checkpoint is damaged: " + what +
                      "; use an undamaged copy, or remove the file to start over");
    };
    for (const size_t count : {2u, 3u, 5u}) {
        expect_refused(States(count, sampled(LAYER_COUNT_COLOUR).state),
                       "it says that it holds " + std::to_string(count) + " states, not 1 or 4");
    }
    const auto expect_alpha_refused = [&](uint32_t layer, const std::string& what) {
        for (const float bad : {-1.0f, 0.5f, 16777218.0f, INFINITE, std::nanf("")}) {
            for (States states : {States{four_states()[0]}, four_states()}) {
                std::vector<float>& values = states.back().values;
                values[(layer * states.back().pixel_count() + 2) * 4 + 3] = bad;
                expect_refused(states, "pixel 2 of a state has no whole number of " + what);
            }
        }
    };
    expect_alpha_refused(LAYER_L_COMPENSATION, "samples");
    expect_alpha_refused(LAYER_L, "visible samples");
    expect_alpha_refused(LAYER_SQUARE, "samples as its limit");
    expect_alpha_refused(LAYER_SQUARE_COMPENSATION, "rays");
    for (const auto& [layer, what] :
         {std::pair(LAYER_WITH, "samples of catchers"), std::pair(LAYER_WITHOUT, "samples of reflections")}) {
        for (const float bad : {-1.0f, 0.5f, 3.0f, INFINITE, std::nanf("")}) {
            Accumulation state = sampled(LAYER_COUNT_CATCHERS).state;
            state.values[(layer * state.pixel_count() + 2) * 4 + 3] = bad;
            expect_refused({state}, std::string("pixel 2 of a state has no whole number of ") + what);
        }
    }
    States states = four_states();
    states[2].seed += 1;
    expect_refused(states, "its states are not those of one rendering");
    states = four_states();
    states[1].first_sample += 1;
    expect_refused(states, "its states are not those of one rendering");
}

TEST_F(CheckpointFile, HeadersThatNoRendererLeavesAreRefused) {
    const auto message = [this](const CheckpointHeader& header) {
        save_checkpoint(file_, header, States{sampled(LAYER_COUNT_COLOUR).state});
        return error_of([&] { load_checkpoint(file_); });
    };
    for (const double seconds : {-1.0, double(INFINITE), std::nan("")}) {
        CheckpointHeader header = HEADER;
        header.render_seconds = seconds;
        EXPECT_NE(message(header).find("its rendering time is not valid"), std::string::npos);
    }
    CheckpointHeader header = HEADER;
    header.planned = (1u << 24) + 1;
    EXPECT_NE(message(header).find("it plans more samples than a pixel can hold"), std::string::npos);
}

TEST_F(CheckpointFile, ANewerFormatIsRefused) {
    save({sampled(LAYER_COUNT_COLOUR).state});
    Image image = read_exr(file_);
    image.attributes["candela.checkpoint"] = std::string("3");
    write_exr(file_, image);
    EXPECT_EQ(error_of([&] { load_checkpoint(file_); }),
              file_.string() +
                  ": the checkpoint was made by a newer version of candela (its format is 3, and 2 is the "
                  "newest known here); continue with that version");
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
