// Reads the environment for commands that use Vulkan.
#include "cli/vulkan.h"

#include <algorithm>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/threads.h"
#include "os/memory.h"
#include "os/program.h"

namespace candela {

// A switch is on if it is set to anything but "" or "0".
static bool is_on(const char* name) {
    const std::string value = os::environment(name);
    return !value.empty() && value != "0";
}

// Mesa writes to its cache through mapped memory: on a full disk, SIGBUS ends the program.
static void keep_drivers_off_full_disks() {
    constexpr uintmax_t ENOUGH = uintmax_t{64} << 20;
    std::filesystem::path folder = os::environment("MESA_SHADER_CACHE_DIR");
    if (folder.empty()) folder = os::cache_folder().value_or("/");
    std::error_code ignored;
    while (folder.has_relative_path() && !std::filesystem::exists(folder, ignored))
        folder = folder.parent_path();
    if (std::filesystem::space(folder, ignored).available < ENOUGH)
        os::set_default_environment("MESA_SHADER_CACHE_DISABLE", "true");
}

// Drivers without room for threads and code end the program silently or hang. Both limits, on the address
// space and on data, apply to writable memory.
static void check_address_space() {
    constexpr size_t NEEDED = size_t{768} << 20;
    if (!os::has_address_space(NEEDED)) {
        throw Error(
            "cannot use Vulkan: its drivers need 768 MiB of address space and data, and less is left; raise "
            "the limit (ulimit -v, ulimit -d)",
            ErrorKind::out_of_memory);
    }
}

// Drivers that can start only some of their threads wait for the others for ever.
static void check_threads() {
    // Lavapipe's: two pools of a thread per core, each of at most 16, and two threads more.
    const size_t needed = 2 * std::clamp<size_t>(std::thread::hardware_concurrency(), 1, 16) + 2;
    // No std::latch: that of GCC 12 for Windows sometimes sleeps through its end.
    std::mutex all_started;
    std::unique_lock starting(all_started);
    const std::vector<JoiningThread> threads =
        start_helpers(needed, [&all_started] { const std::lock_guard waits(all_started); });
    starting.unlock();
    if (threads.size() < needed) {
        throw Error("cannot use Vulkan: its drivers start up to " + std::to_string(needed) +
                    " threads, and the system allows only " + std::to_string(threads.size()) +
                    " more; raise the limit (ulimit -u), or end other programs");
    }
}

vk::Instance::Options instance_options() {
    check_address_space();
    check_threads();
    keep_drivers_off_full_disks();
    return {.validation = is_on("CANDELA_VALIDATION")};
}

void check_validation(const vk::Instance& instance) {
    const size_t count = instance.validation_messages().size();
    if (count > 0) {
        throw Error("the Vulkan validation layer reported errors " + std::to_string(count) +
                    " time(s), see above; this is a bug in candela or in the driver; please report it");
    }
}

std::optional<std::filesystem::path> pipeline_cache_folder() {
    if (is_on("CANDELA_NO_CACHE")) return std::nullopt;
    const auto home = os::cache_folder();
    return home ? std::optional(*home / "candela") : std::nullopt;
}

const vk::Device& LazyDevice::open() {
    if (!slot_) {
        instance_.emplace(instance_options());
        slot_.emplace(*instance_, vk::select_device(instance_->devices(), name_), pipeline_cache_folder());
    }
    return slot_->open();
}

void LazyDevice::check() const {
    if (instance_) check_validation(*instance_);
}

}  // namespace candela
