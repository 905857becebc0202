// See describe.h.
#include "serve/describe.h"

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "scene/geometry.h"
#include "view/camera_control.h"

namespace candela::serve {
namespace {

Json describe_device(const vk::DeviceInfo& info, bool is_default) {
    const vk::DeviceLimits& limits = info.limits;
    return {{"index", info.index},
            {"name", info.name},
            {"type", vk::to_string(info.type)},
            {"default", is_default},
            {"usable", info.reason.empty()},
            {"reason", info.reason},
            {"vulkan", vk::version_text(info.api_version)},
            {"driver", info.driver},
            {"memory_bytes", info.device_heap},
            {"subgroup_size", info.subgroup_size},
            {"timestamps", info.timestamp_bits > 0},
            {"ray_query", info.ray_query},
            {"limits",
             {{"maxTexelBufferElements", limits.max_texel_buffer_elements},
              {"maxStorageBufferRange", limits.max_storage_buffer_range},
              {"maxImageDimension2D", limits.max_image_dimension_2d},
              {"maxMemoryAllocationSize", limits.max_memory_allocation_size}}}};
}

// The index of the device that is used by default; none if no device can be used.
std::optional<uint32_t> default_device(std::span<const vk::DeviceInfo> devices) {
    try {
        return vk::select_device(devices, std::nullopt).index;
    } catch (const Error&) {
        return std::nullopt;
    }
}

Json describe(const DoubleBox& box) {
    if (box.is_empty()) return nullptr;
    const auto point = [](dvec3 p) { return Json{p.x, p.y, p.z}; };
    return {point(box.lo), point(box.hi)};
}

template <class Things>
Json names_of(const Things& things) {
    Json names = Json::array();
    for (const auto& thing : things)
        names.push_back(thing.name);
    return names;
}

}  // namespace

Json describe_camera(const Camera& camera, uvec2 size) {
    return Json::parse(camera_json(camera, "camera", size))["cameras"]["camera"];
}

Json describe_scene(const Scene& scene) {
    Json cameras = Json::object();
    for (const Camera& camera : scene.cameras)
        cameras[camera.name] = describe_camera(camera, camera.film_size.value_or(scene.film.size));
    const uvec2 size = scene.cameras.front().film_size.value_or(scene.film.size);
    return {{"cameras", cameras},
            {"materials", names_of(scene.materials)},
            {"objects", scene.objects},
            {"lights", names_of(scene.lights)},
            {"environment", scene.environment.has_value()},
            {"bounds", describe(bounds(scene))},
            {"triangles", triangle_count(scene)},
            {"size", {size.x, size.y}},
            {"spp", scene.integrator.spp}};
}

Json describe_devices(std::span<const vk::DeviceInfo> devices) {
    const std::optional<uint32_t> best = default_device(devices);
    Json list = Json::array();
    for (const vk::DeviceInfo& info : devices)
        list.push_back(describe_device(info, best == info.index));
    return list;
}

}  // namespace candela::serve
