// Where no more threads can be started (tests/faults/thread_fault.cpp): one is enough to read, build and
// write. What drivers cannot do without theirs is an error.
#include <algorithm>
#include <thread>

#include "cli/cli_fixture.h"

#ifdef CANDELA_THREAD_FAULT

namespace candela {
namespace {

class ThreadFaults : public CliTest {
  protected:
    // Runs candela where so many threads can be started.
    ProcessResult candela_with(long threads, const Words& arguments) const {
        std::filesystem::remove(file("log"));
        return candela(arguments, {{"CANDELA_VALIDATION", "0"},
                                   {"LD_PRELOAD", CANDELA_THREAD_FAULT},
                                   {"THREAD_FAULT_AFTER", std::to_string(threads)},
                                   {"THREAD_FAULT_LOG", file("log")}});
    }
    // How many it wanted to start.
    long wanted() const {
        const std::string log = std::filesystem::exists(file("log")) ? read_file(file("log")) : "";
        return std::ranges::count(log, '\n');
    }
    static Words render_to(const std::string& output) {
        return {"render", CORNELL_BOX, "--size", "16x16", "--spp", "2", "--quiet", "-o", output};
    }
};

TEST_F(ThreadFaults, ASceneIsReadAndAPictureMergedByOne) {
    const Words info{"info", CORNELL_BOX};
    const ProcessResult alone = candela_with(0, info);
    EXPECT_EQ(alone.exit_code, 0) << alone.err;
    const auto tree = [](const std::string& text) { return text.substr(0, text.find(", built in")); };
    EXPECT_EQ(tree(alone.out), tree(candela(info).out));
    EXPECT_GT(wanted(), 0) << "this machine has one core";

    ASSERT_EQ(candela(render_to(file("a.exr"))).exit_code, 0);
    const ProcessResult merged = candela_with(0, {"merge", file("a.exr"), "-o", file("b.exr")});
    EXPECT_EQ(merged.exit_code, 0) << merged.err;
    EXPECT_GT(wanted(), 0);
    EXPECT_EQ(read_exr(file("b.exr")).find("R")->values, read_exr(file("a.exr")).find("R")->values);
}

// The last threads of all are those that compress: each number of them has the same picture.
TEST_F(ThreadFaults, AtTheEndLoseNoPicture) {
    ASSERT_EQ(candela_with(1000, render_to(file("all.exr"))).exit_code, 0);
    const long all = wanted();
    const long last = long(std::thread::hardware_concurrency());
    ASSERT_GT(all, last);
    for (const long fewer : {last, long{1}}) {
        const ProcessResult result = candela_with(all - fewer, render_to(file("few.exr")));
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err, "");
        const Image few = read_exr(file("few.exr")), usual = read_exr(file("all.exr"));
        for (const char* channel : {"R", "G", "B", "A", "N.X", "SampleCount.V"})
            EXPECT_EQ(few.find(channel)->values, usual.find(channel)->values) << channel;
    }
}

// Lavapipe would wait for ever for those of its threads that have not been started.
TEST_F(ThreadFaults, AtTheStartOfADriverAreAnError) {
    const ProcessResult result = candela_with(0, render_to(file("a.exr")));
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(result.err.starts_with("candela: error: cannot use Vulkan: its drivers start up to "))
        << result.err;
    EXPECT_CONTAINS(result.err,
                    " threads, and the system allows only 0 more; raise the limit (ulimit -u), or end other "
                    "programs\n");
    EXPECT_FALSE(std::filesystem::exists(file("a.exr")));
}

}  // namespace
}  // namespace candela

#endif
