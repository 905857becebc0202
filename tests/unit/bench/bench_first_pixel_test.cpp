// The benchmark of the first image: which calls it times, in which environment, and what it says of those
// that fail.
#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "base/file.h"
#include "bench/first_pixel.h"
#include "unit/base/base_fixture.h"

namespace candela {
namespace {

class BenchFirstPixel : public testing::Test {
  protected:
    // A shell script in the place of candela.
    std::filesystem::path program(const std::string& commands) const {
        const std::filesystem::path path = directory_ / "program";
        std::ofstream(path) << "#!/bin/sh\n" << commands << '\n';
        std::filesystem::permissions(path, std::filesystem::perms::owner_all);
        return path;
    }
    static std::vector<Row> bench(const std::filesystem::path& program) {
        return bench_first_pixel({.runs = 2, .progress = [](const std::string&) {}}, program,
                                 "some/scene.json", "1");
    }

    TemporaryDirectory directory_;
};

TEST_F(BenchFirstPixel, RunsColdAndWarmInTurnAfterAWarmUp) {
    const std::filesystem::path log = directory_ / "log";
    const std::vector<Row> rows =
        bench(program("case $XDG_CACHE_HOME in */candela-*) cache=own;; esac\n"
                      "echo \"no cache: $CANDELA_NO_CACHE $MESA_SHADER_CACHE_DISABLE, cache: $cache, "
                      "$(echo $* | sed 's| /.*first.png| FILE|')\" >> " +
                      log.string()));
    const std::string call = "render some/scene.json --spp 1 --size 64x64 --quiet -o FILE --device 1\n";
    const std::string cold = "no cache: 1 true, cache: , " + call, warm = "no cache:  , cache: own, " + call;
    EXPECT_EQ(read_file(log), warm + cold + warm + cold + warm);

    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].what, "first image, cold");
    EXPECT_EQ(rows[1].what, "first image, warm");
    for (const Row& row : rows) {
        EXPECT_EQ(row.subject, "some/scene.json");
        EXPECT_EQ(row.unit, "s");
        ASSERT_EQ(row.ours.size(), 2u);
        ASSERT_EQ(row.ours_wall.size(), 2u);
        EXPECT_GE(std::ranges::min(row.ours), 0.0);
        EXPECT_GT(std::ranges::min(row.ours_wall), 0.0);
    }
}

// While a process waits, it takes wall time and no CPU time, however slow the machine; both clocks count
// microseconds.
TEST_F(BenchFirstPixel, CpuTimeIsTheProcessesOwn) {
    for (const Row& row : bench(program("exec sleep 0.1"))) {
        for (size_t run = 0; run < row.ours.size(); ++run)
            EXPECT_GE(row.ours_wall[run] - row.ours[run], 0.1 - 1e-5);
    }
}

TEST_F(BenchFirstPixel, AProgramThatFailsIsNamedWithItsCall) {
    const std::string call =
        (directory_ / "program").string() + " render some/scene.json --spp 1 --size 64x64 --quiet";
    const std::string exited = error_of([&] { bench(program("exit 3")); });
    EXPECT_EQ(exited.rfind("first-pixel: `" + call, 0), 0u) << exited;
    EXPECT_NE(exited.find("` exited with 3; see its messages above"), std::string::npos) << exited;
    const std::string killed = error_of([&] { bench(program("kill -9 $$")); });
    EXPECT_NE(killed.find("` was ended by signal 9; see its messages above"), std::string::npos) << killed;
    EXPECT_EQ(error_of([] { bench("/nonexistent/candela"); }),
              "cannot start /nonexistent/candela: " + std::generic_category().message(ENOENT));
}

TEST_F(BenchFirstPixel, AFolderThatCannotBeMadeIsNamed) {
    const char* const before = std::getenv("TMPDIR");
    const std::string kept = before == nullptr ? "" : before;
    ::setenv("TMPDIR", "/nonexistent", 1);
    const std::string message = error_of([] { bench("/bin/true"); });
    before == nullptr ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", kept.c_str(), 1);
    EXPECT_TRUE(message.starts_with("first-pixel: cannot create a temporary folder (")) << message;
    EXPECT_TRUE(message.ends_with("); set TMPDIR to a folder that may be written to")) << message;
}

}  // namespace
}  // namespace candela
