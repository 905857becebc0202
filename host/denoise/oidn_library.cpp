// See oidn_library.h.
#include "denoise/oidn_library.h"

#include <system_error>

#include "base/error.h"
#include "os/process.h"
#include "os/program.h"

namespace candela {
namespace {

constexpr const char* VARIABLE = "CANDELA_OIDN";

bool is_name_alone(const std::filesystem::path& candidate) {
    return !candidate.has_parent_path();
}

}  // namespace

static std::string oidn_file() {
    return os::library_file("OpenImageDenoise", OIDN_MAJOR_VERSION);
}

std::vector<std::filesystem::path> oidn_candidates() {
    if (const std::filesystem::path named = os::environment(VARIABLE); !named.empty())
        return {is_name_alone(named) ? "." / named : named};
    const std::string file = oidn_file();
    std::vector<std::filesystem::path> candidates;
    if (const std::filesystem::path program = os::program_file(); !program.empty()) {
        candidates.push_back(program.parent_path() / file);
        candidates.push_back(program.parent_path() / "lib" / file);
    }
    candidates.emplace_back(file);
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
        library_.emplace(candidate);
        file_ = candidate.string();
        if (library_->is_loaded()) break;
        if (!by_system)
            throw Error("cannot load Open Image Denoise from \"" + file_ + "\": " + library_->error());
    }
    if (!library_ || !library_->is_loaded()) {
        throw Error("Open Image Denoise, a library that removes noise, is not there (looked for in " +
                        places + "); get it by `sh cmake/denoiser.sh`, or name its file " + oidn_file() +
                        " in " + VARIABLE,
                    ErrorKind::request);
    }
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
}

template <class Function>
void OidnLibrary::find(Function*& function, const char* name) {
    function = library_->find<Function>(name);
    if (function != nullptr) return;
    throw Error("cannot use \"" + file_ + "\" as Open Image Denoise: it has no function " + name +
                "; candela needs version " + std::to_string(OIDN_MAJOR_VERSION) +
                " (`sh cmake/denoiser.sh` gets it)");
}

}  // namespace candela
