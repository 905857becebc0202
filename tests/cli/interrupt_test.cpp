// Progress on a terminal and elsewhere, and Ctrl-C.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include "cli/cli_fixture.h"

namespace candela {
namespace {

class Interrupt : public CliTest {
  protected:
    // Starts a rendering that would take for ever; stderr is a terminal.
    Process start(const std::string& size) const {
        ProcessOptions terminal = options();
        terminal.terminal = true;
        return Process(call({"render", CORNELL_BOX, "-o", file("a.exr"), "-o", file("a.png"), "--size", size,
                             "--spp", "16777216", "--report", file("r.json")}),
                       terminal);
    }

    // A signal in the middle of rendering ends it with what there is.
    void expect_partial_image(int signal) const {
        Process process = start("32x32");
        ASSERT_TRUE(process.wait_for_err("Msamples/s"));
        process.send(signal);
        const ProcessResult result = process.finish();
        EXPECT_EQ(result.exit_code, 130);
        EXPECT_CONTAINS(result.err, " of 16777216 spp in ");
        const Image image = read_exr(file("a.exr"));
        EXPECT_EQ(image.full, uvec2(32, 32));
        const std::vector<float>& counts = image.find("SampleCount.V")->values;
        EXPECT_GE(std::ranges::min(counts), 1.0f);
        EXPECT_LT(std::ranges::max(counts), 16777216.0f);
        EXPECT_TRUE(std::filesystem::exists(file("a.png")));
        EXPECT_EQ(nlohmann::json::parse(read_file(file("r.json")))["complete"], false);
    }
};

TEST_F(Interrupt, CtrlCWritesWhatThereIs) {
    expect_partial_image(SIGINT);
}

TEST_F(Interrupt, TerminationWritesWhatThereIs) {
    expect_partial_image(SIGTERM);
}

// The picture is so large that the program would still be writing for a while after the first signal.
TEST_F(Interrupt, ASecondSignalEndsAtOnce) {
    Process process = start("1024x1024");
    ASSERT_TRUE(process.wait_for_err("Msamples/s"));
    process.send(SIGTERM);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    process.send(SIGINT);
    EXPECT_EQ(process.finish().signal, SIGINT);
    EXPECT_FALSE(std::filesystem::exists(file("a.exr")));
    EXPECT_FALSE(std::filesystem::exists(file("r.json")));
}

TEST_F(Interrupt, ATerminalGetsALiveLineWithRateAndTimeLeft) {
    ProcessOptions terminal = options();
    terminal.terminal = true;
    const Words arguments = {"render", CORNELL_BOX, "-o",       file("a.png"),  "--size",
                             "32x32",  "--spp",     "16777216", "--time-limit", "0.5"};
    const std::string live = run_process(call(arguments), terminal).err;
    EXPECT_CONTAINS(live, "\r\x1b[K0 %, ");
    EXPECT_CONTAINS(live, " of 16777216 spp, ");
    EXPECT_CONTAINS(live, " Msamples/s, 0.");
    EXPECT_CONTAINS(live, " s left");

    terminal.environment["TERM"] = "dumb";
    EXPECT_EQ(run_process(call(arguments), terminal).err.find('\x1b'), std::string::npos);
    EXPECT_EQ(candela(arguments).err.find('\x1b'), std::string::npos);
    EXPECT_EQ(run_process(call(arguments + Words{"--quiet"}), terminal).err, "");
}

}  // namespace
}  // namespace candela
