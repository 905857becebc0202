// Bounds of compiled kernels: kernels within them pass, all others are named, with what to do.
#include "bench/kernel_bounds.h"

#include <gtest/gtest.h>

#include "base/file.h"
#include "unit/base/base_fixture.h"

namespace candela {
namespace {

const std::string DEVICE = "Null hardware (RADV NAVI21)";

CompiledKernel make_kernel(double demand, double spilled, double scratch) {
    return {.scene = "box",
            .kernel = "render",
            .buffers = "texel",
            .statistics = {{STATISTIC_VGPRS, 64},
                           {STATISTIC_VGPR_DEMAND, demand},
                           {STATISTIC_SPILLED_VGPRS, spilled},
                           {STATISTIC_SCRATCH, scratch}}};
}

KernelBound make_bound(const std::string& device, const std::string& kernel) {
    return {.device = device, .scene = "box", .kernel = kernel, .buffers = "texel", .vgpr_demand = 50};
}

// What is wrong with `kernels`, of which the one called render has a bound of 50.
std::vector<std::string> violations(const std::vector<CompiledKernel>& kernels) {
    const KernelBounds bounds{.file = "bounds.json",
                              .driver = "radv",
                              .bounds = {make_bound("NAVI21", "render"), make_bound("VEGA10", "position")}};
    return find_violations(bounds, DEVICE, kernels);
}

TEST(KernelBounds, AKernelAtItsBoundPasses) {
    EXPECT_TRUE(violations({make_kernel(50, 0, 0)}).empty());
}

TEST(KernelBounds, ADemandAboveTheBoundIsNamedWithTheRemedy) {
    const auto found = violations({make_kernel(51, 0, 0)});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0],
              "render (texel buffers) of box on Null hardware (RADV NAVI21): \"Pre-Sched VGPRs\" is 51, the "
              "bound is 50; let fewer values be alive at once, or raise the bound in bounds.json and say why "
              "there");
}

TEST(KernelBounds, SpillsAndScratchAreNeverAllowed) {
    const auto found = violations({make_kernel(50, 1, 1024)});
    ASSERT_EQ(found.size(), 2u);
    EXPECT_NE(found[0].find("\"Scratch size\" is 1024, the bound is 0"), std::string::npos) << found[0];
    EXPECT_NE(found[1].find("\"Spilled VGPRs\" is 1, the bound is 0"), std::string::npos) << found[1];
}

TEST(KernelBounds, AStatisticThatTheDriverDoesNotTellIsNotTakenForGood) {
    CompiledKernel kernel = make_kernel(50, 0, 0);
    kernel.statistics.clear();
    const auto found = violations({kernel});
    ASSERT_EQ(found.size(), 3u);
    EXPECT_NE(found[2].find("the driver does not tell \"Pre-Sched VGPRs\""), std::string::npos) << found[2];
}

TEST(KernelBounds, AKernelWithoutABoundIsNamed) {
    CompiledKernel storage = make_kernel(10, 0, 0);
    storage.buffers = "storage";
    const auto found = violations({make_kernel(50, 0, 0), storage});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0],
              "render (storage buffers) of box on Null hardware (RADV NAVI21): it has no bound; give it one "
              "in bounds.json");
}

TEST(KernelBounds, ABoundWithoutAKernelIsNamed) {
    CompiledKernel other = make_kernel(50, 0, 0);
    other.kernel = "position";
    const auto found = violations({other});
    ASSERT_EQ(found.size(), 2u) << "the bound of another device is found as well";
    EXPECT_NE(found[1].find("render (texel buffers) of box on"), std::string::npos) << found[1];
    EXPECT_NE(found[1].find("no such kernel was compiled"), std::string::npos) << found[1];
    other.buffers = "storage";
    EXPECT_EQ(violations({other}).size(), 1u) << "only kernels of one kind of buffers were compiled";
}

// The message of the error that a file of that text gives.
std::string error_of_file(const std::string& text) {
    const TemporaryDirectory folder;
    const std::filesystem::path file = folder / "kernel_bounds.json";
    write_file_atomically(file, text);
    return error_of([&] { load_kernel_bounds(file); });
}

TEST(KernelBounds, ABoundMustSayWhy) {
    const std::string message = error_of_file(
        R"({"driver": "radv", "bounds": [{"device": "", "scene": "", "kernel": "display", "buffers": "",
            "vgpr_demand": 12, "why": ""}]})");
    EXPECT_NE(message.find("kernel_bounds.json: a bound does not say why: {"), std::string::npos) << message;
    EXPECT_NE(message.find("display"), std::string::npos) << message;
}

TEST(KernelBounds, AFileThatIsNoneIsNamed) {
    EXPECT_NE(error_of_file("{").find("kernel_bounds.json: "), std::string::npos);
    EXPECT_NE(error_of_file(R"({"driver": "radv"})").find("'bounds' not found"), std::string::npos);
    EXPECT_NE(error_of_file(R"({"driver": "radv", "bounds": [{}]})").find("'why' not found"),
              std::string::npos);
}

TEST(KernelBounds, TheBoundsOfTheProjectCanBeRead) {
    const KernelBounds bounds = load_kernel_bounds(CANDELA_SCENES "/../tests/bench/kernel_bounds.json");
    EXPECT_FALSE(bounds.driver.empty());
    EXPECT_FALSE(bounds.bounds.empty());
}

}  // namespace
}  // namespace candela
