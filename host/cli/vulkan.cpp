// Reads the environment for commands that use Vulkan.
#include "cli/vulkan.h"

#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>

#include <sys/mman.h>

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

// Where programs keep what they can make again; nothing if the environment does not say. By the XDG
// specification, a relative path is ignored.
static std::optional<std::filesystem::path> cache_home() {
    const std::filesystem::path cache = environment("XDG_CACHE_HOME");
    if (cache.is_absolute()) return cache;
    const std::filesystem::path home = environment("HOME");
    return home.is_absolute() ? std::optional(home / ".cache") : std::nullopt;
}

// Mesa writes to its cache through mapped memory: on a full disk, SIGBUS ends the program.
static void keep_drivers_off_full_disks() {
    constexpr uintmax_t ENOUGH = uintmax_t{64} << 20;
    std::filesystem::path folder = environment("MESA_SHADER_CACHE_DIR");
    if (folder.empty()) folder = cache_home().value_or("/");
    std::error_code ignored;
    while (folder.has_relative_path() && !std::filesystem::exists(folder, ignored))
        folder = folder.parent_path();
    if (std::filesystem::space(folder, ignored).available < ENOUGH)
        ::setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
}

// Drivers that find no room for threads and code end the program silently or hang.
static void check_address_space() {
    constexpr size_t NEEDED = size_t{768} << 20;
    void* const room = ::mmap(nullptr, NEEDED, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room == MAP_FAILED) {
        throw Error(
            "cannot use Vulkan: fewer than 768 MiB of address space are left, which its drivers "
            "take; raise the limit (ulimit -v)",
            ExitCode::out_of_memory);
    }
    ::munmap(room, NEEDED);
}

vk::Instance::Options instance_options() {
    check_address_space();
    keep_drivers_off_full_disks();
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
    const auto home = cache_home();
    return home ? std::optional(*home / "candela") : std::nullopt;
}

}  // namespace candela
