// `candela devices`: every Vulkan device, what it offers, and whether candela can use it.
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/printable.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/json_text.h"
#include "cli/vulkan.h"
#include "serve/describe.h"
#include "vk/device_info.h"
#include "vk/instance.h"

namespace candela {
namespace {

const char* yes_or_no(bool value) {
    return value ? "yes" : "no";
}

void print_row(const char* key, const std::string& value) {
    std::printf("    %-26s%s\n", key, printable(value, MAX_MESSAGE_BYTES).c_str());
}

void print(const vk::DeviceInfo& info, bool is_default) {
    std::printf("%u: %s (%s)%s\n", info.index, printable(info.name, MAX_NAME_BYTES).c_str(),
                vk::to_string(info.type), is_default ? ", used by default" : "");
    print_row("suitable", info.reason.empty() ? "yes" : "no: " + info.reason);
    print_row("Vulkan", vk::version_text(info.api_version));
    if (!info.reason.empty()) return;  // The rest may be unknown.
    print_row("driver", info.driver);
    // The computer's RAM limits a CPU device, not the heap that it reports.
    print_row("memory",
              info.type == vk::DeviceType::cpu ? "the computer's free RAM" : bytes_text(info.device_heap));
    print_row("subgroup size", std::to_string(info.subgroup_size));
    print_row("timestamps", yes_or_no(info.timestamp_bits > 0));
    print_row("ray query (not used)", yes_or_no(info.ray_query));
    print_row("maxTexelBufferElements", std::to_string(info.limits.max_texel_buffer_elements));
    print_row("maxStorageBufferRange", bytes_text(info.limits.max_storage_buffer_range));
    print_row("maxImageDimension2D", std::to_string(info.limits.max_image_dimension_2d));
    print_row("maxMemoryAllocationSize", bytes_text(info.limits.max_memory_allocation_size));
}

// The index of the device that is used by default. If no device can be used: none, and the reason in
// `failure`.
std::optional<uint32_t> find_default(const std::vector<vk::DeviceInfo>& devices,
                                     std::optional<Error>& failure) {
    try {
        return vk::select_device(devices, std::nullopt).index;
    } catch (const Error& error) {
        failure = error;
        return std::nullopt;
    }
}

ExitCode devices(bool json) {
    const vk::Instance instance(instance_options());
    const std::vector<vk::DeviceInfo> devices = instance.devices();
    std::optional<Error> failure;
    const std::optional<uint32_t> best = find_default(devices, failure);

    if (json) {
        std::printf("%s\n", json_text(serve::describe_devices(devices)).c_str());
    } else {
        for (const vk::DeviceInfo& info : devices)
            print(info, best == info.index);
    }
    flush_results();
    if (failure) throw Error(*failure);
    check_validation(instance);
    return ExitCode::done;
}

}  // namespace

Command add_devices_command(CLI::App& app) {
    CLI::App* const command =
        app.add_subcommand("devices", "List Vulkan devices, and why candela cannot use some");
    const auto json = std::make_shared<bool>(false);
    command->add_flag("--json", *json, "Print JSON for programs");
    command->footer("Give the index or a part of the name to --device of `candela render`.");
    return {command, [json] { return devices(*json); }};
}

}  // namespace candela
