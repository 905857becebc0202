// See oidn_library.h.
#include "denoise/oidn_library.h"

#include <cstdlib>
#include <system_error>

#include <dlfcn.h>

#include "base/error.h"

namespace candela {
namespace {

constexpr const char* VARIABLE = "CANDELA_OIDN";

// What dlopen() said last, without what a message must not hold.
std::string loader_message() {
    const char* const message = dlerror();
    return message == nullptr ? "the system gives no reason" : message;
}

bool is_name_alone(const std::filesystem::path& candidate) {
    return !candidate.has_parent_path();
}

}  // namespace

std::vector<std::filesystem::path> oidn_candidates() {
    if (const char* const named = std::getenv(VARIABLE)) {
        const std::filesystem::path file(named);
        return {is_name_alone(file) ? "." / file : file};
    }
    std::vector<std::filesystem::path> candidates;
    std::error_code unknown;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", unknown);
    if (!unknown) {
        candidates.push_back(program.parent_path() / OIDN_FILE);
        candidates.push_back(program.parent_path() / "lib" / OIDN_FILE);
    }
    candidates.emplace_back(OIDN_FILE);
    return candidates;
}

OidnLibrary::OidnLibrary(const std::vector<std::filesystem::path>& candidates) {
    std::string places;
    for (const std::filesystem::path& candidate : candidates) {
        std::error_code ignored;
        const bool by_system = is_name_alone(candidate);
        places += (places.empty() ? "" : ", ") +
                  (by_system ? "the system's library path" : '"' + candidate.string() + '"');
        if (!by_system && !std::filesystem::exists(candidate, ignored)) continue;
        handle_ = dlopen(candidate.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
        file_ = candidate.string();
        if (handle_ != nullptr) break;
        const std::string why = loader_message();
        if (!by_system) throw Error("cannot load Open Image Denoise from \"" + file_ + "\": " + why);
    }
    if (handle_ == nullptr) {
        throw Error("Open Image Denoise, a library that removes noise, is not there (looked for in " +
                        places + "); get it by `sh cmake/denoiser.sh`, or name its file " + OIDN_FILE +
                        " in " + VARIABLE,
                    ErrorKind::request);
    }
    try {
        find(new_device, "oidnNewDevice");
        find(commit_device, "oidnCommitDevice");
        find(release_device, "oidnReleaseDevice");
        find(set_device_bool, "oidnSetDeviceBool");
        find(get_device_int, "oidnGetDeviceInt");
        find(get_device_error, "oidnGetDeviceError");
        find(new_filter, "oidnNewFilter");
        find(commit_filter, "oidnCommitFilter");
        find(execute_filter, "oidnExecuteFilter");
        find(release_filter, "oidnReleaseFilter");
        find(set_filter_bool, "oidnSetFilterBool");
        find(set_filter_int, "oidnSetFilterInt");
        find(set_filter_float, "oidnSetFilterFloat");
        find(set_image, "oidnSetSharedFilterImage");
    } catch (...) {
        dlclose(handle_);
        throw;
    }
}

OidnLibrary::~OidnLibrary() {
    dlclose(handle_);
}

template <class Function>
void OidnLibrary::find(Function*& function, const char* name) {
    function = reinterpret_cast<Function*>(dlsym(handle_, name));
    if (function != nullptr) return;
    throw Error("cannot use \"" + file_ + "\" as Open Image Denoise: it has no function " + name +
                "; candela needs version " + std::to_string(OIDN_MAJOR_VERSION) +
                " (`sh cmake/denoiser.sh` gets it)");
}

}  // namespace candela
