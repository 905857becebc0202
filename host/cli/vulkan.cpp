// Reads the environment for commands that use Vulkan.
#include "cli/vulkan.h"

#include <cstdlib>
#include <string>
#include <string_view>

#include "base/error.h"

namespace candela {

// The value of an environment variable; empty if it is not set.
static std::string_view environment(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? "" : value;
}

// A switch is on if it is set to anything but "" or "0".
static bool is_on(const char* name) {
    const std::string_view value = environment(name);
    return !value.empty() && value != "0";
}

vk::Instance::Options instance_options() {
    return {.validation = is_on("CANDELA_VALIDATION")};
}

void check_validation(const vk::Instance& instance) {
    const size_t count = instance.validation_messages().size();
    if (count > 0) {
        throw Error("the Vulkan validation layer found fault " + std::to_string(count) +
                    " time(s), see above; this is a bug in candela or the driver, please report it");
    }
}

std::optional<std::filesystem::path> pipeline_cache_folder() {
    if (is_on("CANDELA_NO_CACHE")) return std::nullopt;
    // The XDG specification: a relative path is to be ignored.
    const std::filesystem::path cache = environment("XDG_CACHE_HOME");
    if (cache.is_absolute()) return cache / "candela";
    const std::filesystem::path home = environment("HOME");
    return home.is_absolute() ? std::optional(home / ".cache" / "candela") : std::nullopt;
}

}  // namespace candela
