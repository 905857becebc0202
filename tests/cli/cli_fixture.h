// What the tests of the command line share: the program under test, tiny renderings, and a directory for
// files.
#pragma once

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "image/image.h"
#include "image/image_io.h"
#include "support/process.h"
#include "unit/base/base_fixture.h"

namespace candela {

inline const std::string CORNELL_BOX = std::string(CANDELA_SCENES) + "/cornell-box.json";
inline const std::string DEPTH_OF_FIELD = std::string(CANDELA_SCENES) + "/depth-of-field.json";
inline const std::string MESH = std::string(CANDELA_SCENES) + "/mesh.json";

// The driver list that a file is: of one driver, or of none for /dev/null.
inline std::map<std::string, std::string> driver_file(const std::string& path) {
    return {{"VK_DRIVER_FILES", path}, {"VK_ICD_FILENAMES", path}};
}

// A computer without Vulkan.
inline const std::map<std::string, std::string> NO_DRIVER = driver_file("/dev/null");

// The variables that insert tests/faults/device_fault.cpp before the driver.
inline const std::map<std::string, std::string> FAULT_LAYER = {
    {"VK_INSTANCE_LAYERS", "VK_LAYER_candela_device_fault"}, {"VK_ADD_LAYER_PATH", CANDELA_FAULTS}};

inline std::map<std::string, std::string> operator+(std::map<std::string, std::string> a,
                                                    const std::map<std::string, std::string>& b) {
    a.insert(b.begin(), b.end());
    return a;
}

// Each of the first `devices` devices runs that many submissions, and then answers with `result`, a VkResult;
// then that many openings fail.
inline std::map<std::string, std::string> failing_device(int devices, int submissions, int result,
                                                         int openings = 0) {
    return FAULT_LAYER + std::map<std::string, std::string>{{"FAULT_DEVICES", std::to_string(devices)},
                                                            {"FAULT_AFTER", std::to_string(submissions)},
                                                            {"FAULT_RESULT", std::to_string(result)},
                                                            {"FAULT_OPENINGS", std::to_string(openings)}};
}
inline constexpr int OUT_OF_DEVICE_MEMORY = -2, INITIALIZATION_FAILED = -3, DEVICE_LOST = -4;  // VkResult.

using Words = std::vector<std::string>;

inline Words operator+(Words a, const Words& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

// The program under test: the one of this build, or another one that runs on its behalf
// (cmake/try_windows.sh).
inline std::string tested_program() {
    const char* const other = std::getenv("CANDELA_TESTED_PROGRAM");
    return other == nullptr ? CANDELA_BINARY : other;
}

class CliTest : public testing::Test {
  protected:
    // The call of candela with these arguments, and its environment: with validation, and compiled
    // kernels kept between tests.
    static Words call(const Words& arguments) { return Words{tested_program()} + arguments; }
    static ProcessOptions options(std::map<std::string, std::string> environment = {}) {
        environment.insert(
            {{"CANDELA_VALIDATION", "1"}, {"XDG_CACHE_HOME", CANDELA_CACHE}, {"TERM", "xterm"}});
        return {.environment = std::move(environment)};
    }
    static ProcessResult candela(const Words& arguments,
                                 std::map<std::string, std::string> environment = {}) {
        return run_process(call(arguments), options(std::move(environment)));
    }

    // Renders 32x32 pixels of the Cornell box with 4 samples, unless `arguments` say otherwise.
    static ProcessResult render(const Words& arguments) {
        return candela(Words{"render", CORNELL_BOX, "--size", "32x32", "--spp", "4"} + arguments);
    }

    std::string file(const std::string& name) const { return (directory_ / name).string(); }
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(file(name)) << text;
        return file(name);
    }

    // Renders `scene` with `arguments` and returns the report; the test fails if candela does.
    nlohmann::json report_of(const Words& arguments, const std::string& scene = CORNELL_BOX) const {
        const ProcessResult result =
            candela(Words{"render", scene, "-o", file("report.png"), "--report", "-", "--quiet"} + arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return nlohmann::json::parse(result.out);
    }
    std::string hash_of(const Words& arguments, const std::string& scene = CORNELL_BOX) const {
        return report_of(Words{"--size", "32x32", "--spp", "4"} + arguments, scene)["image_hash"];
    }

    TemporaryDirectory directory_;
};

#define EXPECT_CONTAINS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

}  // namespace candela
