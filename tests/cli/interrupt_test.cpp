// Progress on a terminal and elsewhere, and Ctrl-C.
#include <algorithm>
#include <csignal>
#include <regex>

#include "cli/cli_fixture.h"
#include "support/wait.h"

namespace candela {
namespace {

class Interrupt : public CliTest {
  protected:
    // A rendering that would take for ever. Its first submission gives every pixel a sample.
    Words endless() const {
        return call({"render", CORNELL_BOX, "-o", file("a.exr"), "-o", file("a.png"), "--size", "32x32",
                     "--spp", "16777216", "--report", file("r.json")});
    }
    static ProcessOptions on_terminal() {
        ProcessOptions terminal = options();
        terminal.terminal = true;
        return terminal;
    }

    // A signal in the middle of rendering ends it with what there is.
    void expect_partial_image(int signal) const {
        Process process(endless(), on_terminal());
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

TEST_F(Interrupt, TheEndOfTheTerminalWritesWhatThereIs) {
    expect_partial_image(SIGHUP);
}

TEST_F(Interrupt, NohupLetsItGoOn) {
    Process process(Words{"/bin/sh", "-c", "trap '' HUP; exec \"$@\"", "sh"} + endless(), options());
    wait_until("it renders", [&] { return process.catches(SIGINT) && process.catches(SIGTERM); });
    EXPECT_FALSE(process.catches(SIGHUP));
    process.send(SIGHUP);
    process.send(SIGINT);
    EXPECT_EQ(process.finish().exit_code, 130);
}

TEST_F(Interrupt, MessagesThatNobodyReadsDoNotEndIt) {
    Process process(
        call({"render", CORNELL_BOX, "-o", file("a.exr"), "--size", "32x32", "--spp", "4", "--verbose"}),
        options());
    process.close_err();
    EXPECT_EQ(process.finish().exit_code, 0);
    EXPECT_EQ(std::ranges::min(read_exr(file("a.exr")).find("SampleCount.V")->values), 4.0f);
}

// The program cannot end by itself after the first signal, since nobody reads what it writes then.
TEST_F(Interrupt, ASecondSignalEndsAtOnce) {
    Process process(endless(), options());
    wait_until("it renders", [&] { return process.catches(SIGINT) && process.catches(SIGTERM); });
    process.block_err();
    process.send(SIGTERM);
    wait_until("it has the signal", [&] { return !process.catches(SIGINT); });
    process.send(SIGINT);
    EXPECT_EQ(process.finish().signal, SIGINT);
    EXPECT_FALSE(std::filesystem::exists(file("a.exr")));
    EXPECT_FALSE(std::filesystem::exists(file("r.json")));
}

TEST_F(Interrupt, ATerminalGetsALiveLineWithRateAndTimeLeft) {
    Process process(endless() + Words{"--time-limit", "50"}, on_terminal());
    ASSERT_TRUE(process.wait_for_err(" s left"));
    const std::regex line(
        "\r\x1b\\[K0 %, \\d+ of 16777216 spp, \\d+\\.\\d\\d Msamples/s, (\\d+\\.\\d) s left");
    std::smatch match;
    ASSERT_TRUE(std::regex_search(process.err(), match, line)) << process.err();
    EXPECT_LE(std::stod(match[1]), 50.0);
    process.send(SIGINT);
    process.finish();

    const Words brief = endless() + Words{"--time-limit", "0.5"};
    ProcessOptions dumb = on_terminal();
    dumb.environment["TERM"] = "dumb";
    EXPECT_EQ(run_process(brief, dumb).err.find('\x1b'), std::string::npos);
    EXPECT_EQ(run_process(brief, options()).err.find('\x1b'), std::string::npos);
    EXPECT_EQ(run_process(brief + Words{"--quiet"}, on_terminal()).err, "");
}

}  // namespace
}  // namespace candela
