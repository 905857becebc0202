// `candela selftest` on the device at hand: every check passes, and table and JSON say so.
#include <regex>
#include <sstream>

#include "cli/cli_fixture.h"

namespace candela {
namespace {

class SelftestCommand : public CliTest {
  protected:
    // Every check is in the report and has passed, and `err` reported it on the way.
    static void expect_passed(const nlohmann::json& report, const std::string& err) {
        EXPECT_EQ(report["passed"], true);
        EXPECT_EQ(report["failed"], 0);
        EXPECT_NE(report["device"], "");
        EXPECT_NE(report["driver"], "");
        EXPECT_NE(report["system"], "");
        EXPECT_EQ(report["checks"].size(), 21u);
        for (const auto& check : report["checks"]) {
            EXPECT_EQ(check["passed"], true) << check;
            EXPECT_EQ(check["wrong"], 0) << check;
            EXPECT_EQ(check["reason"], "") << check;
            EXPECT_GT(check["compared"], 0) << check;
            EXPECT_EQ(check["tests"] == 0, check["p"].is_null()) << check;
            EXPECT_CONTAINS(err, ": " + check["name"].get<std::string>() + "\n");
        }
    }
};

// The same checks, at the same size, are tests of shaders and of pictures as well.
using SlowSelftestCommand = SelftestCommand;

TEST_F(SlowSelftestCommand, PassesOnThisDevice) {
    const ProcessResult result = candela({"selftest", "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
    const auto report = nlohmann::json::parse(result.out);
    EXPECT_EQ(report["effort"], "full");
    expect_passed(report, result.err);
}

// The same number of checks; those of rays take fewer samples.
TEST_F(SelftestCommand, QuickPassesWithFewerSamples) {
    const ProcessResult result = candela({"selftest", "--json", "--effort", "quick"});
    ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
    const auto report = nlohmann::json::parse(result.out);
    EXPECT_EQ(report["effort"], "quick");
    expect_passed(report, result.err);
    for (const auto& check : report["checks"]) {
        if (check["name"] != "rays in closed meshes") continue;
        EXPECT_LT(check["compared"], 10000);
    }
}

TEST_F(SelftestCommand, HelpSaysHowOftenChanceFailsIt) {
    const ProcessResult help = candela({"selftest", "--help"});
    EXPECT_EQ(help.exit_code, 0);
    for (const char* part : {"--device", "--effort", "--json", "is at most 0.001", "Exit code: 0"})
        EXPECT_CONTAINS(help.out, part);
}

TEST_F(SelftestCommand, UnknownDevicesAndWordsAreRefused) {
    EXPECT_EQ(candela({"selftest", "--device", "abacus"}).exit_code, 3);
    EXPECT_EQ(candela({"selftest"}, NO_DRIVER).exit_code, 3);
    const ProcessResult effort = candela({"selftest", "--effort", "some"});
    EXPECT_EQ(effort.exit_code, 2);
    EXPECT_CONTAINS(effort.err, "--effort: cannot use \"some\"; expected quick|full");
    const ProcessResult word = candela({"selftest", "now"});
    EXPECT_EQ(word.exit_code, 2);
    EXPECT_CONTAINS(word.err, "unknown argument \"now\"; see candela selftest --help");
}

}  // namespace
}  // namespace candela
