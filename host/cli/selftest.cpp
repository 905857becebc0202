// `candela selftest`: evidence that the renderer is right on the user's own device.
#include "cli/selftest.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "base/printable.h"
#include "base/text.h"
#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/json_text.h"
#include "cli/vulkan.h"
#include "os/program.h"
#include "session/version.h"
#include "vk/device.h"
#include "vk/instance.h"

namespace candela {
namespace {

using Json = nlohmann::ordered_json;

struct SelftestOptions {
    std::optional<std::string> device;
    Effort effort = Effort::full;
    bool json = false;
};

// A probability with three significant digits.
std::string probability_text(double p) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", p);
    return text;
}

void print_heading(const vk::DeviceInfo& device, Effort effort, double level) {
    std::printf("candela %s selftest\n", CANDELA_VERSION);
    std::printf("device   %u: %s (%s)\n", device.index, printable(device.name, MAX_NAME_BYTES).c_str(),
                vk::to_string(device.type));
    std::printf("driver   %s\n", printable(device.driver, MAX_NAME_BYTES).c_str());
    std::printf("Vulkan   %s\n", vk::version_text(device.api_version).c_str());
    std::printf("system   %s\n", os::system_text().c_str());
    std::printf("effort   %s\n\n", name_of(effort, EFFORT_NAMES).c_str());
    std::printf("p is how often chance gives a result as odd; %s or less fails a check.\n",
                probability_text(level).c_str());
    std::printf("Chance fails a correct device with a probability of %s at most, in all.\n\n",
                probability_text(SELFTEST_ALPHA).c_str());
    std::printf("%-22s%-30s%-18s %-5s%4s\n", "check", "asked", "found", "", "time");
}

// "1 ray", "6758400 samples"; `unit` is a plural.
std::string count_text(uint64_t count, const std::string& unit) {
    return concat(count, ' ', count == 1 ? unit.substr(0, unit.size() - 1) : unit);
}

// "6758400 samples, 264 tests"
std::string asked_text(const CheckResult& result) {
    if (result.error) return "";
    const Evidence& evidence = result.evidence;
    const std::string tests = evidence.tests() > 0 ? ", " + count_text(evidence.tests(), "tests") : "";
    return count_text(evidence.compared(), result.unit) + tests;
}

std::string found_text(const CheckResult& result) {
    if (result.error) return "error";
    const std::string p =
        result.evidence.tests() > 0 ? ", p " + probability_text(result.evidence.p_value()) : "";
    return concat(result.evidence.wrong(), " wrong", p);
}

// What went wrong, in words; empty if nothing.
std::string reason_text(const CheckResult& result, double level) {
    if (result.error) return result.error->what();
    std::string reason;
    if (result.evidence.wrong() > 0) reason = "first: " + result.evidence.first_wrong();
    if (!(result.evidence.p_value() > level))
        reason += (reason.empty() ? "" : "; ") + ("unlikely: " + result.evidence.least_likely());
    return reason;
}

void print_row(const CheckResult& result, double level) {
    std::printf("%-22s%-30s%-18s %-5s%4s\n", result.name.c_str(), asked_text(result).c_str(),
                found_text(result).c_str(), result.passed ? "ok" : "FAIL", fixed(result.seconds, 1).c_str());
    if (!result.passed) std::printf("    %s\n", reason_text(result, level).c_str());
}

Json to_json(const CheckResult& result, double level) {
    const Evidence& evidence = result.evidence;
    return {{"name", result.name},
            {"unit", result.unit},
            {"compared", evidence.compared()},
            {"wrong", evidence.wrong()},
            {"tests", evidence.tests()},
            {"p", evidence.tests() > 0 ? Json(evidence.p_value()) : Json(nullptr)},
            {"passed", result.passed},
            {"reason", reason_text(result, level)},
            {"seconds", result.seconds}};
}

void print_json(const std::vector<CheckResult>& results, const vk::DeviceInfo& device, Effort effort,
                double level, size_t failed) {
    Json checks = Json::array();
    for (const CheckResult& result : results)
        checks.push_back(to_json(result, level));
    const Json report = {{"version", CANDELA_VERSION},
                         {"device", device.name},
                         {"type", vk::to_string(device.type)},
                         {"driver", device.driver},
                         {"vulkan", vk::version_text(device.api_version)},
                         {"system", os::system_text()},
                         {"effort", name_of(effort, EFFORT_NAMES)},
                         {"false_alarm_probability", SELFTEST_ALPHA},
                         {"p_limit", level},
                         {"checks", checks},
                         {"failed", failed},
                         {"passed", failed == 0}};
    std::printf("%s\n", json_text(report).c_str());
}

void print_verdict(const std::vector<CheckResult>& results, size_t checks, size_t failed) {
    double seconds = 0.0;
    for (const CheckResult& result : results)
        seconds += result.seconds;
    const std::string verdict = failed == 0 ? concat("all ", checks, " checks passed")
                                            : concat(failed, " of ", checks, " checks FAILED");
    std::printf("\n%s, in %s\n", verdict.c_str(), duration_text(seconds).c_str());
}

// Shows which check is running: on a terminal in a line that is cleared later; elsewhere only if no table is
// printed.
void print_progress(size_t done, const std::vector<Check>& checks, bool json) {
    const bool terminal = os::stderr_is_terminal();
    if (terminal) std::fputs("\r\x1b[K", stderr);
    if (done == checks.size() || !(terminal || json)) return;
    std::fprintf(stderr, "check %zu of %zu: %s%s", done + 1, checks.size(), checks[done].name.c_str(),
                 terminal ? "" : "\n");
}

ExitCode selftest(const SelftestOptions& options) {
    const vk::Instance instance(instance_options());
    const std::vector<vk::DeviceInfo> devices = instance.devices();
    const vk::Device device(instance, vk::select_device(devices, options.device), pipeline_cache_folder());
    const ExitCode code =
        run_selftest(selftest_checks(device, options.effort), options.effort, device.info(), options.json);
    check_validation(instance);
    return code;
}

}  // namespace

ExitCode run_selftest(const std::vector<Check>& checks, Effort effort, const vk::DeviceInfo& device,
                      bool json) {
    const double level = check_level(checks.size());
    if (!json) print_heading(device, effort, level);
    std::vector<CheckResult> results;
    std::optional<Error> lost;
    for (size_t i = 0; i < checks.size() && !lost; ++i) {
        print_progress(i, checks, json);
        const CheckResult result = run_check(checks[i], level);
        print_progress(checks.size(), checks, json);
        if (!json) print_row(result, level);
        flush_results();
        if (result.error && result.error->kind() == ErrorKind::device_lost) lost = result.error;
        results.push_back(result);
    }
    // Skipped checks have not passed.
    const auto passed = std::ranges::count(results, true, &CheckResult::passed);
    const size_t failed = checks.size() - size_t(passed);
    if (json) {
        print_json(results, device, effort, level, failed);
    } else {
        print_verdict(results, checks.size(), failed);
    }
    flush_results();
    if (lost) throw Error(*lost);
    return failed == 0 ? ExitCode::done : ExitCode::failed;
}

Command add_selftest_command(CLI::App& app) {
    CLI::App* const command =
        app.add_subcommand("selftest", "Check that images are right on this device; takes a minute on a CPU");
    const auto options = std::make_shared<SelftestOptions>();
    command
        ->add_option("--device", options->device,
                     "Index or part of the name (default: the best; see candela devices)")
        ->type_name("D");
    add_choice(*command, "--effort", options->effort, EFFORT_NAMES,
               "quick: a sixteenth of the samples, rays and images, for devices on which full (the default) "
               "takes many minutes; records, random numbers, warps and BSDFs as in full");
    command->add_flag("--json", options->json, "Print JSON for programs");
    command->footer(
        "Paste the output into a bug report. Seeds are fixed, so that a device always gets the same "
        "verdict.\n"
        "The probability that chance alone fails a correct device is at most 0.001, over all checks.\n"
        "Exit code: 0 if all checks passed, 1 if not.");
    return {command, [options] { return selftest(*options); }};
}

}  // namespace candela
