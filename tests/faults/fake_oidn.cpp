// Stands in for Open Image Denoise in tests: the functions that candela calls, with filters so simple that a
// test knows their result, and failures where the environment asks for them:
//
//     FAKE_OIDN_VERSION=N    it is version N.5.1
//     FAKE_OIDN_DEVICE=no    it opens no device
//     FAKE_OIDN_FAILS=WHERE  "device", "filter" or "execute" reports an error
//     FAKE_OIDN_AFTER=N      the first N executions succeed
//     FAKE_OIDN_LOG=FILE     each execution of a filter adds a line to the file
//
// The filter of colour gives twice the colour plus the albedo, that of an albedo or a normal alone half of
// it.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>

namespace {

std::string error;
int executions = 0;

std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? "" : value;
}

void fail_if_asked(const char* where) {
    if (variable("FAKE_OIDN_FAILS") == where) error = std::string("out of luck in ") + where;
}

}  // namespace

struct OidnDeviceHandle {};

struct OidnFilterHandle {
    struct Image {
        float* values;
        size_t width, height;
    };
    std::map<std::string, Image> images;
    std::map<std::string, int> numbers;
    float scale = 0.0f;
};

extern "C" {

OidnDeviceHandle* oidnNewDevice(int type) {
    executions = 0;
    if (variable("FAKE_OIDN_DEVICE") == "no") return nullptr;
    return type == 1 ? new OidnDeviceHandle : nullptr;
}

void oidnCommitDevice(OidnDeviceHandle*) {
    fail_if_asked("device");
}

void oidnReleaseDevice(OidnDeviceHandle* device) {
    delete device;
}

void oidnSetDeviceBool(OidnDeviceHandle*, const char*, bool) {}

int oidnGetDeviceInt(OidnDeviceHandle*, const char* name) {
    const std::string version = variable("FAKE_OIDN_VERSION");
    if (std::strcmp(name, "versionMajor") == 0) return version.empty() ? 2 : std::atoi(version.c_str());
    return std::strcmp(name, "versionMinor") == 0 ? 5 : 1;
}

int oidnGetDeviceError(OidnDeviceHandle*, const char** message) {
    static std::string last;
    last = error;
    error.clear();
    *message = last.c_str();
    return last.empty() ? 0 : 1;
}

OidnFilterHandle* oidnNewFilter(OidnDeviceHandle*, const char*) {
    return new OidnFilterHandle;
}

void oidnCommitFilter(OidnFilterHandle*) {
    fail_if_asked("filter");
}

void oidnReleaseFilter(OidnFilterHandle* filter) {
    delete filter;
}

void oidnSetFilterBool(OidnFilterHandle* filter, const char* name, bool value) {
    filter->numbers[name] = value ? 1 : 0;
}

void oidnSetFilterInt(OidnFilterHandle* filter, const char* name, int value) {
    filter->numbers[name] = value;
}

void oidnSetFilterFloat(OidnFilterHandle* filter, const char*, float value) {
    filter->scale = value;
}

void oidnSetSharedFilterImage(OidnFilterHandle* filter, const char* name, void* values, int, size_t width,
                              size_t height, size_t, size_t, size_t) {
    filter->images[name] = {static_cast<float*>(values), width, height};
}

void oidnExecuteFilter(OidnFilterHandle* filter) {
    const std::string after = variable("FAKE_OIDN_AFTER");
    if (++executions > (after.empty() ? 0 : std::atoi(after.c_str()))) fail_if_asked("execute");
    const OidnFilterHandle::Image output = filter->images.at("output");
    const size_t count = 3 * output.width * output.height;
    const bool has_colour = filter->images.contains("color"), has_albedo = filter->images.contains("albedo");
    const std::string alone = has_albedo ? "albedo" : "normal";
    for (size_t i = 0; i < count; ++i) {
        for (const auto& [name, image] : filter->images) {
            const bool is_input = name != "output" || !has_colour;
            if (is_input && !std::isfinite(image.values[i])) error = name + " is not finite";
        }
        if (has_colour) {
            output.values[i] = 2.0f * filter->images["color"].values[i] +
                               (has_albedo ? filter->images["albedo"].values[i] : 0.0f);
        } else {
            output.values[i] = 0.5f * filter->images[alone].values[i];
        }
    }
    const std::string log = variable("FAKE_OIDN_LOG");
    if (log.empty()) return;
    std::FILE* const file = std::fopen(log.c_str(), "a");
    for (const auto& [name, image] : filter->images)
        std::fprintf(file, "%s ", name.c_str());
    for (const auto& [name, number] : filter->numbers)
        std::fprintf(file, "%s=%d ", name.c_str(), number);
    std::fprintf(file, "%zux%zu inputScale=%g\n", output.width, output.height, double(filter->scale));
    std::fclose(file);
}

}  // extern "C"
