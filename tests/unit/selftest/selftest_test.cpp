// The machinery of the selftest: how evidence is counted and judged, and what a check that fails looks like.
#include "selftest/selftest.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/statistics.h"
#include "cli/selftest.h"
#include "selftest/histogram.h"

namespace candela {
namespace {

std::string first_word() {
    return "the first";
}
std::string another_word() {
    return "another";
}

TEST(Evidence, CountsComparisonsAndKeepsTheFirstThatIsWrong) {
    Evidence evidence;
    evidence.expect(true, another_word);
    EXPECT_TRUE(evidence.passes(0.5));
    evidence.expect(false, first_word);
    evidence.expect(false, another_word);
    EXPECT_EQ(evidence.compared(), 3u);
    EXPECT_EQ(evidence.wrong(), 2u);
    EXPECT_EQ(evidence.first_wrong(), "the first");
    EXPECT_FALSE(evidence.passes(0.0));
}

// With n tests, the least p-value is below x with a probability of 1 - (1 - x)^n.
TEST(Evidence, CorrectsTheLeastPValueForTheNumberOfTests) {
    Evidence evidence;
    EXPECT_EQ(evidence.p_value(), 1.0);
    evidence.add_p_value("a", 0.5);
    EXPECT_DOUBLE_EQ(evidence.p_value(), 0.5);
    evidence.add_p_value("b", 0.01, 3);
    evidence.add_p_value("c", 0.2);
    EXPECT_EQ(evidence.tests(), 5u);
    EXPECT_NEAR(evidence.p_value(), 1.0 - std::pow(0.99, 5.0), 1e-15);
    EXPECT_EQ(evidence.least_likely(), "b");
    EXPECT_TRUE(evidence.passes(0.049));
    EXPECT_FALSE(evidence.passes(0.05));
    // It says the same as judging each test at Sidak's level.
    EXPECT_NEAR(sidak_level(evidence.p_value(), 5), 0.01, 1e-15);
}

TEST(Evidence, APValueThatIsNoNumberCountsAsZero) {
    Evidence evidence;
    evidence.add_p_value("broken", std::nan(""));
    evidence.add_p_value("good", 0.9);
    EXPECT_EQ(evidence.p_value(), 0.0);
    EXPECT_EQ(evidence.least_likely(), "broken");
}

TEST(Evidence, AddsWhatAnotherCheckFound) {
    Evidence a, b;
    a.add_p_value("a", 0.3);
    b.expect(false, first_word);
    b.add_p_value("b", 0.1, 2);
    a.add(b);
    a.add(Evidence{});
    EXPECT_EQ(a.compared(), 1u);
    EXPECT_EQ(a.wrong(), 1u);
    EXPECT_EQ(a.first_wrong(), "the first");
    EXPECT_EQ(a.tests(), 3u);
    EXPECT_EQ(a.least_likely(), "b");
}

TEST(Histogram, PointsOutsideAndNoNumbersBelongToCellsAtTheBorder) {
    const Histogram cells(4);
    const double nan = std::nan("");
    EXPECT_EQ(cells.cell(0.0, 0.0), 0u);
    EXPECT_EQ(cells.cell(0.26, 0.99), 1u * 4 + 3);
    EXPECT_EQ(cells.cell(1.0, 1e300), 15u);
    EXPECT_EQ(cells.cell(-1.0, nan), 0u);
    EXPECT_EQ(cells.cell(std::numeric_limits<double>::infinity(), nan), 12u);
}

Check passing_check() {
    return {"sound", "rays", [] {
                Evidence evidence;
                evidence.expect(true, another_word);
                return evidence;
            }};
}
Check wrong_check() {
    return {"wrong", "rays", [] {
                Evidence evidence;
                evidence.expect(false, [] { return std::string("ray 7"); });
                evidence.add_p_value("fair", 0.5);
                return evidence;
            }};
}
Check unlikely_check() {
    return {"unlikely", "samples", [] {
                Evidence evidence;
                evidence.add_p_value("loaded die", 1e-9);
                return evidence;
            }};
}
Check throwing_check(ErrorKind kind) {
    return {"broken off", "images", [kind]() -> Evidence { throw Error("no room for it; buy more", kind); }};
}

class Selftest : public testing::Test {
  protected:
    // Runs the checks; what they print to stdout is in out_.
    ExitCode run(const std::vector<Check>& checks, bool json = false) {
        vk::DeviceInfo device;
        device.name = "Abacus 3";
        device.type = vk::DeviceType::cpu;
        device.driver = "beads 1.0";
        device.api_version = VK_MAKE_API_VERSION(0, 1, 2, 3);
        testing::internal::CaptureStdout();
        testing::internal::CaptureStderr();
        ExitCode code = ExitCode::done;
        try {
            code = run_selftest(checks, Effort::quick, device, json);
        } catch (const Error& error) {
            code = exit_code(error.kind());
        }
        out_ = testing::internal::GetCapturedStdout();
        err_ = testing::internal::GetCapturedStderr();
        return code;
    }
    void expect_out(const std::string& part) const {
        EXPECT_NE(out_.find(part), std::string::npos) << part << "\nis not in\n" << out_;
    }

    std::string out_, err_;
};

TEST_F(Selftest, TellsWhatItRanOnAndThatAllPassed) {
    EXPECT_EQ(run({passing_check(), passing_check()}), ExitCode::done);
    expect_out("Abacus 3 (CPU)\n");
    expect_out("beads 1.0\n");
    expect_out("1.2.3\n");
    expect_out("effort   quick\n");
    expect_out("a probability of 0.001 at most");
    // 1 - (1 - 10^-3)^(1/2)
    expect_out("; 0.0005 or less fails a check.");
    expect_out("sound                 1 ray                         0 wrong            ok    0.0\n");
    expect_out("all 2 checks passed, in 0.0 s\n");
    EXPECT_EQ(err_, "");
}

TEST_F(Selftest, ACheckThatFailsSaysWhy) {
    EXPECT_EQ(run({passing_check(), wrong_check(), unlikely_check()}), ExitCode::failed);
    expect_out(
        "wrong                 1 ray, 1 test                 1 wrong, p 0.5     FAIL  0.0\n    first: ray "
        "7\n");
    expect_out("0 wrong, p 1e-09   FAIL  0.0\n    unlikely: loaded die\n");
    expect_out("\n2 of 3 checks FAILED, in 0.0 s\n");
}

TEST_F(Selftest, AnErrorFailsItsCheckAndNoOther) {
    EXPECT_EQ(run({throwing_check(ErrorKind::out_of_memory), passing_check()}), ExitCode::failed);
    expect_out("error              FAIL  0.0\n    no room for it; buy more\n");
    expect_out("sound                 1 ray                         0 wrong            ok    0.0\n");
    expect_out("\n1 of 2 checks FAILED, in 0.0 s\n");
}

TEST_F(Selftest, ALostDeviceEndsItWithItsVerdict) {
    EXPECT_EQ(run({passing_check(), throwing_check(ErrorKind::device_lost), passing_check()}),
              ExitCode::device_lost);
    expect_out("    no room for it; buy more\n\n2 of 3 checks FAILED, in 0.0 s\n");
}

TEST_F(Selftest, PrintsTheSameAsJson) {
    EXPECT_EQ(run({passing_check(), wrong_check(), throwing_check(ErrorKind::other)}, true),
              ExitCode::failed);
    const auto report = nlohmann::json::parse(out_);
    EXPECT_EQ(report["device"], "Abacus 3");
    EXPECT_EQ(report["driver"], "beads 1.0");
    EXPECT_EQ(report["vulkan"], "1.2.3");
    EXPECT_EQ(report["effort"], "quick");
    EXPECT_EQ(report["false_alarm_probability"], 1e-3);
    EXPECT_NEAR(report["p_limit"].get<double>(), 1.0 - std::pow(0.999, 1.0 / 3.0), 1e-12);
    EXPECT_EQ(report["failed"], 2);
    EXPECT_EQ(report["passed"], false);
    const auto& checks = report["checks"];
    ASSERT_EQ(checks.size(), 3u);
    EXPECT_EQ(checks[0]["name"], "sound");
    EXPECT_EQ(checks[0]["passed"], true);
    EXPECT_EQ(checks[0]["p"], nullptr);
    EXPECT_EQ(checks[1]["unit"], "rays");
    EXPECT_EQ(checks[1]["compared"], 1);
    EXPECT_EQ(checks[1]["wrong"], 1);
    EXPECT_EQ(checks[1]["tests"], 1);
    EXPECT_EQ(checks[1]["p"], 0.5);
    EXPECT_EQ(checks[1]["passed"], false);
    EXPECT_EQ(checks[1]["reason"], "first: ray 7");
    EXPECT_EQ(checks[2]["reason"], "no room for it; buy more");
    EXPECT_EQ(err_, "check 1 of 3: sound\ncheck 2 of 3: wrong\ncheck 3 of 3: broken off\n");
}

}  // namespace
}  // namespace candela
