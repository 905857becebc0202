// Checkpoints as a user sees them: kill the program, fill the disk, forbid the place; what was rendered is
// never lost, and the image has the same bits.
#include "film/checkpoint.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <random>
#include <system_error>
#include <thread>

#include "cli/cli_fixture.h"
#include "support/wait.h"

namespace candela {
namespace {

class CheckpointTest : public CliTest {
  protected:
    const std::string state_ = file("state.exr");

    // A rendering of some samples with a checkpoint, as `render` of the fixture renders 4.
    ProcessResult render_with(const Words& arguments) const {
        return render(Words{"-o", file("a.exr"), "--checkpoint", state_} + arguments);
    }
    // The colours and all other channels of two images have the same bits.
    static void expect_same_bits(const std::string& a, const std::string& b) {
        const Image x = read_exr(a), y = read_exr(b);
        ASSERT_EQ(x.channels.size(), y.channels.size());
        for (size_t c = 0; c < x.channels.size(); ++c) {
            ASSERT_EQ(x.channels[c].name, y.channels[c].name);
            EXPECT_EQ(std::memcmp(x.channels[c].values.data(), y.channels[c].values.data(),
                                  x.pixel_count() * sizeof(float)),
                      0)
                << x.channels[c].name;
        }
    }

    // Kills the program that many times at a random moment and resumes it: every second time at any moment,
    // else in turn as soon as the file was changed (if it were not replaced as a whole, it would be half a
    // file then) and a while after it had more samples, which the first submissions after a start may not
    // add. Whatever the moment, the file is there, and never goes back.
    void expect_kills_lose_nothing(int kills) const {
        const Words arguments = {"render", CORNELL_BOX, "-o",      file("a.exr"),
                                 "--size", "64x64",     "--quiet", "--spp"};
        const Words checkpoint = {"--checkpoint", state_, "--checkpoint-every", "0.001s", "--resume"};
        ASSERT_EQ(run_process(call(arguments + Words{"1"} + checkpoint), options()).exit_code, 0);
        const auto written = [this] { return std::filesystem::last_write_time(state_); };
        const auto held = [this] { return load_checkpoint(state_).states.at(0).total_samples(); };
        std::mt19937 random{uint32_t(kills)};
        uint64_t samples = 0;
        int advances = 0;
        for (int i = 0; i < kills; ++i) {
            const auto before = written();
            Process process(call(arguments + Words{"16777216"} + checkpoint), options());
            if (i % 4 == 0) {
                while (written() == before) {
                }
            } else {
                if (i % 4 == 2) wait_until("it went on", [&] { return held() > samples; });
                std::this_thread::sleep_for(std::chrono::milliseconds(random() % (i % 4 == 2 ? 200 : 500)));
            }
            process.send(SIGKILL);
            ASSERT_EQ(process.finish().signal, SIGKILL);
            const uint64_t now = held();
            EXPECT_GE(now, samples);
            advances += now > samples ? 1 : 0;
            samples = now;
        }
        EXPECT_GE(advances, kills / 4);
        const std::string spp = std::to_string(load_checkpoint(state_).states.at(0).max_samples() + 1);
        EXPECT_EQ(run_process(call(arguments + Words{spp} + checkpoint), options()).exit_code, 0);
        EXPECT_EQ(run_process(call(arguments + Words{spp, "-o", file("whole.exr")}), options()).exit_code, 0);
        expect_same_bits(file("a.exr"), file("whole.exr"));
    }
};

TEST_F(CheckpointTest, AResumedRenderingHasTheSameBits) {
    ASSERT_EQ(render({"-o", file("whole.exr"), "--spp", "9", "--report", file("whole.json")}).exit_code, 0);
    const ProcessResult first = render_with({"--resume", "--spp", "4"});
    EXPECT_EQ(first.exit_code, 0);
    EXPECT_CONTAINS(first.err, "\"" + state_ + "\" does not exist yet: starting from the beginning\n");
    const ProcessResult second = render_with({"--resume", "--spp", "9", "--report", file("resumed.json")});
    EXPECT_EQ(second.exit_code, 0) << second.err;
    EXPECT_CONTAINS(second.err, "rendered 9 spp in ");
    expect_same_bits(file("a.exr"), file("whole.exr"));
    // The report is about the whole rendering,
    const auto whole = nlohmann::json::parse(read_file(file("whole.json")));
    const auto resumed = nlohmann::json::parse(read_file(file("resumed.json")));
    for (const char* key : {"image_hash", "rays_per_sample", "samples", "spp", "complete"})
        EXPECT_EQ(resumed[key], whole[key]) << key;
    EXPECT_EQ(resumed["rendered_samples"], 32 * 32 * 5);  // except for this.
    // With nothing left to do, the program writes the image again.
    EXPECT_EQ(render_with({"--resume", "--spp", "9"}).exit_code, 0);
    expect_same_bits(file("a.exr"), file("whole.exr"));
}

TEST_F(CheckpointTest, SignalsLeaveACheckpointAndAnImage) {
    for (const int signal : {SIGINT, SIGTERM}) {
        ProcessOptions terminal = options();
        terminal.terminal = true;
        const Words arguments = {"render", CORNELL_BOX, "-o",           file("a.exr"), "--size",  "32x32",
                                 "--spp",  "16777216",  "--checkpoint", state_,        "--resume"};
        Process process(call(arguments), terminal);
        ASSERT_TRUE(process.wait_for_err("Msamples/s"));
        process.send(signal);
        EXPECT_EQ(process.finish().exit_code, 130);
        const Accumulation state = load_checkpoint(state_).states.at(0);
        const std::vector<float> counts = read_exr(file("a.exr")).find("SampleCount.V")->values;
        for (size_t i = 0; i < counts.size(); ++i)
            ASSERT_EQ(float(state.sample_count(i)), counts[i]);
    }
}

TEST_F(CheckpointTest, FiveKillsLoseNothing) {
    expect_kills_lose_nothing(5);
}

using SlowCheckpointTest = CheckpointTest;

TEST_F(SlowCheckpointTest, TwentyKillsLoseNothing) {
    expect_kills_lose_nothing(20);
}

// A file system in a name space of its own holds the checkpoint, and has no space for another.
TEST_F(CheckpointTest, AFullDiskKeepsTheOldCheckpointAndTheRendering) {
    if (run_process({"/usr/bin/unshare", "-rm", "/bin/true"}).exit_code != 0)
        GTEST_SKIP() << "this system lets no test mount anything";
    const Words arguments = {"render",   CORNELL_BOX,          "-o",    file("b.png"), "--size", "32x32",
                             "--resume", "--checkpoint-every", "0.05s", "--checkpoint"};
    ASSERT_EQ(candela(arguments + Words{state_, "--spp", "4"}).exit_code, 0);
    const uintmax_t size = std::filesystem::file_size(state_);
    ASSERT_GT(size, 16384u);
    std::filesystem::remove(file("b.png"));
    const std::string disk = file("disk");
    std::filesystem::create_directory(disk);
    const std::string script =
        "mount -t tmpfs -o size=" + std::to_string(size / 1024 + 8) +
        "k none \"$0\" && cp \"$1\" \"$0\" && old=$1 && shift || exit; \"$@\"; code=$?; "
        "cmp \"$old\" \"$0/state.exr\" && test \"$(ls -A \"$0\")\" = state.exr && exit $code";
    const ProcessResult result =
        run_process(Words{"/usr/bin/unshare", "-rm", "/bin/sh", "-c", script, disk, state_} +
                        call(arguments + Words{disk + "/state.exr", "--spp", "200"}),
                    options());
    EXPECT_EQ(result.exit_code, 1) << result.err;  // The last one is not where it was asked for.
    EXPECT_CONTAINS(result.err, "candela: error: cannot write \"" + disk +
                                    "/state.exr\": " + std::generic_category().message(ENOSPC) +
                                    "; free some space or choose another place");
    EXPECT_CONTAINS(result.err, "rendered 200 spp");
    EXPECT_TRUE(std::filesystem::exists(file("b.png")));
}

TEST_F(CheckpointTest, AnUnwritablePlaceIsRefusedAtOnce) {
    const auto error = [&](const std::string& place) {
        const ProcessResult result =
            candela({"render", file("no scene.json"), "-o", file("a.png"), "--checkpoint", place});
        EXPECT_EQ(result.exit_code, 1);
        return result.err;
    };
    EXPECT_CONTAINS(error(file("none/state.exr")), "none\" does not exist; create it first");
    std::filesystem::create_directory(file("folder"));
    EXPECT_CONTAINS(error(file("folder")), "it is a directory");
    EXPECT_CONTAINS(error("/proc/state.exr"), "no file can be created in the directory \"/proc\"");
}

// The folder vanishes while rendering, and comes back: the next checkpoint is there.
TEST_F(CheckpointTest, APlaceThatVanishesIsAWarningAndTriedAgain) {
    std::filesystem::create_directory(file("gone"));
    const std::string state = file("gone/state.exr");
    Process process(call({"render", CORNELL_BOX, "--size", "32x32", "--spp", "16777216", "-o", file("a.png"),
                          "--checkpoint", state, "--checkpoint-every", "0.1s"}),
                    options());
    wait_until("there is a checkpoint", [&] { return std::filesystem::exists(state); });
    std::filesystem::rename(file("gone"), file("elsewhere"));
    ASSERT_TRUE(process.wait_for_err("rendering continues without this checkpoint"));
    std::filesystem::create_directory(file("gone"));
    wait_until("there is a checkpoint again", [&] { return std::filesystem::exists(state); });
    EXPECT_GT(load_checkpoint(state).states.at(0).total_samples(), 0u);
    process.send(SIGINT);
    const ProcessResult result = process.finish();
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_CONTAINS(result.err, "gone\" does not exist; create it first");
}

TEST_F(CheckpointTest, AnExistingFileIsNeverOverwrittenUnasked) {
    write("state.exr", "precious");
    const ProcessResult result = render_with({});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.err, "candela: error: --checkpoint: \"" + state_ +
                              "\" exists; add --resume to continue from it, or remove it to start over\n");
    EXPECT_EQ(read_file(state_), "precious");
}

TEST_F(CheckpointTest, WhatDoesNotFitIsRefusedWithTheReason) {
    ASSERT_EQ(render_with({"--seed", "3"}).exit_code, 0);
    const std::string before = read_file(state_);
    const auto expect_refused = [&](const Words& arguments, const std::string& reason) {
        const ProcessResult result = render_with(Words{"--resume", "--seed", "3"} + arguments);
        EXPECT_EQ(result.exit_code, 1) << arguments[0];
        EXPECT_EQ(result.err,
                  "candela: error: --resume: cannot continue from \"" + state_ + "\": " + reason + "\n");
        EXPECT_EQ(read_file(state_), before);
    };
    const std::string remedy = "; render the same scene with the same options, or give another --checkpoint";
    expect_refused({"--seed", "4"}, "its seed is 3, not 4" + remedy);
    expect_refused({"--size", "32x33"},
                   "its size is 32x32, not 32x33, its crop is 0,0,32,32, not 0,0,32,33" + remedy);
    expect_refused({"--sampler", "stratified", "--max-depth", "5"},
                   "its sampler is sobol, not stratified, its max depth is 4096, not 5" + remedy);
    expect_refused({"--aov", "none"},
                   "it holds albedo and normals, which the outputs do not need; give the same outputs and "
                   "--aov as for the checkpoint");
    expect_refused({"--spp", "3"},
                   "it holds up to 4 samples per pixel, but 3 are asked for; ask for at least as many");

    const ProcessResult part =
        candela({"render", CORNELL_BOX, "-o", file("a.exr"), "--size", "32x32", "--seed", "3", "--samples",
                 "4..9", "--checkpoint", state_, "--resume"});
    EXPECT_EQ(part.exit_code, 1);
    EXPECT_CONTAINS(part.err, "its first sample is 0, not 4" + remedy);
    const ProcessResult scene = candela({"render", MESH, "-o", file("a.exr"), "--size", "32x32", "--seed",
                                         "3", "--spp", "4", "--checkpoint", state_, "--resume"});
    EXPECT_EQ(scene.exit_code, 1);
    EXPECT_CONTAINS(scene.err, "its camera is at ");
}

TEST_F(CheckpointTest, AnotherDeviceIsAWarningAndDamageIsNot) {
    ASSERT_EQ(render_with({}).exit_code, 0);
    Checkpoint checkpoint = load_checkpoint(state_);
    checkpoint.states[0].values[0] = 1000.0f;  // The red of the first pixel, to be seen again.
    checkpoint.header.maker = {.device = "Abacus", .driver = "1", .version = "0"};
    save_checkpoint(state_, checkpoint.header, checkpoint.states);
    const ProcessResult other = render_with({"--resume", "--spp", "5"});
    EXPECT_EQ(other.exit_code, 0);
    EXPECT_CONTAINS(other.err,
                    "candela: warning: the checkpoint was made by Abacus, driver 1, candela 0, and this is ");
    EXPECT_CONTAINS(other.err,
                    ": the image is correct, but its bits are not those of a single program or device");

    EXPECT_GT(read_exr(file("a.exr")).find("R")->values[0], 100.0f) << "it was not continued but begun anew";

    std::string bytes = read_file(state_);
    bytes.resize(bytes.size() / 2);
    write("state.exr", bytes);
    const ProcessResult damaged = render_with({"--resume", "--spp", "6"});
    EXPECT_EQ(damaged.exit_code, 1);
    EXPECT_CONTAINS(damaged.err, "the file is damaged or incomplete");
    EXPECT_EQ(read_file(state_), bytes);
}

TEST_F(CheckpointTest, OptionsThatMakeNoSenseAreRefused) {
    const auto expect_usage = [&](const Words& arguments, const std::string& message) {
        const ProcessResult result = candela(Words{"render", CORNELL_BOX, "-o", file("a.exr")} + arguments);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_CONTAINS(result.err, message);
    };
    expect_usage({"--resume"}, "--resume requires --checkpoint");
    expect_usage({"--checkpoint-every", "1s"}, "--checkpoint-every requires --checkpoint");
    expect_usage({"--samples", "0..4", "--spp", "4"}, "--samples");
    for (const std::string range : {"4", "4..4", "5..4", "0..4,5..6", "0..16777217", "0-4"}) {
        expect_usage({"--samples", range},
                     "--samples: cannot use \"" + range +
                         "\"; expected A..B: samples A to B-1, with A < B, each at most "
                         "16777216");
    }
    expect_usage({"--checkpoint", file("s.exr"), "--checkpoint-every", "0"},
                 "--checkpoint-every: cannot use \"0\"; expected a duration such as 90, 90s, 1.5m or 2h");
}

}  // namespace
}  // namespace candela
