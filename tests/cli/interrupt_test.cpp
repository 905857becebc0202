// Progress on a terminal and elsewhere, and Ctrl-C.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <regex>
#include <stdexcept>
#include <thread>
#include <tuple>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/cli_fixture.h"
#include "support/wait.h"

namespace candela {
namespace {

// Fills a pipe byte by byte for as long as it lives, so that its reader never comes to an end.
class EndlessPipe {
  public:
    explicit EndlessPipe(const std::string& path) {
        if (::mkfifo(path.c_str(), 0600) != 0) throw std::runtime_error("cannot make " + path);
        // For reading as well: so that there is no need to wait for the reader.
        pipe_ = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
        writer_ = std::jthread([this](const std::stop_token& stop) {
            while (!stop.stop_requested()) {
                std::ignore = ::write(pipe_, " ", 1);
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
            }
        });
    }
    ~EndlessPipe() {
        writer_ = {};
        ::close(pipe_);
    }
    EndlessPipe(const EndlessPipe&) = delete;
    EndlessPipe& operator=(const EndlessPipe&) = delete;

  private:
    int pipe_ = -1;
    std::jthread writer_;
};

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
    Process process(
        Words{"/bin/sh", "-c", "trap '' HUP; exec \"$@\"", "sh"} + endless() + Words{"--progress", "json"},
        options());
    ASSERT_TRUE(process.wait_for_err("rendering"));
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

// The program cannot end by itself after the first signal, since nobody reads what it writes.
TEST_F(Interrupt, ASecondSignalEndsAtOnce) {
    Process process(endless() + Words{"--progress", "json"}, options());
    ASSERT_TRUE(process.wait_for_err("rendering"));
    process.block_err();
    wait_until("it waits for its reader", [&] { return process.waits_for_reader(); });
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

TEST_F(Interrupt, WhileASceneIsLoadedNothingIsWritten) {
    const EndlessPipe pipe(file("m.gltf"));
    const Words words = call({"render", file("m.gltf"), "-o", file("a.png")});
    const std::string message = "candela: error: interrupted while the scene was loaded\n";
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        Process process(words + Words{"--progress", "json"}, options());
        ASSERT_TRUE(process.wait_for_err("\"bytes\""));
        process.send(signal);
        const ProcessResult result = process.finish();
        EXPECT_EQ(result.exit_code, 130);
        EXPECT_TRUE(std::regex_match(
            result.err, std::regex("(\\{\"state\":\"loading\",\"bytes\":[0-9]+\\}\n)+" + message)))
            << result.err;
    }
    Process process(words, on_terminal());
    ASSERT_TRUE(process.wait_for_err("read: "));
    process.send(SIGINT);
    const ProcessResult result = process.finish();
    EXPECT_EQ(result.exit_code, 130);
    EXPECT_TRUE(std::regex_match(result.err, std::regex("(\r\x1b\\[Kread: [0-9.]+ (B|KiB))+\r\x1b\\[K" +
                                                        message.substr(0, message.size() - 1) + "\r?\n")))
        << result.err;
    EXPECT_FALSE(std::filesystem::exists(file("a.png")));
}

TEST_F(Interrupt, ATerminalSaysWhenTheTreeIsBuilt) {
    const ProcessResult result = run_process(call({"info", CORNELL_BOX}), on_terminal());
    EXPECT_EQ(result.err, "\r\x1b[Kbuilding the tree\r\x1b[K");
}

}  // namespace
}  // namespace candela
