// The file of the pipeline cache: a hash of the data, 8 bytes in the machine's order, then the data that
// Vulkan gave. A driver runs its contents, so nobody else may have written it.
#include "vk/pipeline_cache.h"

#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "base/private_file.h"
#include "vk/check.h"

namespace candela::vk {

// A driver's cache of our few kernels is far smaller.
static constexpr size_t MAX_BYTES = size_t{64} << 20;

// FNV-1a, 64 bits. Vulkan checks only the header, and drivers trust the rest.
static uint64_t hash(std::span<const char> data) {
    uint64_t h = 0xcbf29ce484222325u;
    for (const char c : data) {
        h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    }
    return h;
}

// True if `data` begins with the header that this device and driver write.
static bool fits_device(std::span<const char> data, const VkPhysicalDeviceProperties& properties) {
    VkPipelineCacheHeaderVersionOne header{};
    if (data.size() < sizeof header) return false;
    std::memcpy(&header, data.data(), sizeof header);
    return header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
           header.vendorID == properties.vendorID && header.deviceID == properties.deviceID &&
           std::memcmp(header.pipelineCacheUUID, properties.pipelineCacheUUID, VK_UUID_SIZE) == 0;
}

// The data of the file, or nothing if it is missing, damaged or foreign.
static std::vector<char> load(const std::filesystem::path& folder, const std::string& name,
                              const VkPhysicalDeviceProperties& properties) {
    const std::string bytes = read_private_file(folder, name, MAX_BYTES).value_or("");
    uint64_t expected = 0;
    if (bytes.size() < sizeof expected) return {};
    std::memcpy(&expected, bytes.data(), sizeof expected);
    std::vector<char> data(bytes.begin() + sizeof expected, bytes.end());
    if (hash(data) != expected || !fits_device(data, properties)) return {};
    return data;
}

// "pipelines-" and the UUID in hexadecimal digits.
static std::string file_name(const VkPhysicalDeviceProperties& properties) {
    std::string name = "pipelines-";
    for (const uint8_t byte : properties.pipelineCacheUUID) {
        name += "0123456789abcdef"[byte >> 4];
        name += "0123456789abcdef"[byte & 15];
    }
    return name;
}

PipelineCache::PipelineCache(VkDevice device, const VkPhysicalDeviceProperties& properties,
                             const std::optional<std::filesystem::path>& folder)
    : device_(device), folder_(folder), name_(file_name(properties)) {
    if (folder) loaded_ = load(*folder, name_, properties);
    VkPipelineCacheCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO;
    info.initialDataSize = loaded_.size();
    info.pInitialData = loaded_.data();
    VkPipelineCache cache = VK_NULL_HANDLE;
    VK_CHECK(vkCreatePipelineCache(device, &info, nullptr, &cache));
    cache_ = {cache, vkDestroyPipelineCache, device};
}

PipelineCache::~PipelineCache() {
    try {
        if (folder_) save();
    } catch (...) {  // No memory, or no place on the disk: the next run compiles again.
    }
}

void PipelineCache::save() const {
    size_t size = 0;
    VK_CHECK(vkGetPipelineCacheData(device_, cache_.get(), &size, nullptr));
    std::vector<char> data(size);
    VK_CHECK(vkGetPipelineCacheData(device_, cache_.get(), &size, data.data()));
    data.resize(size);
    if (data == loaded_) return;

    const uint64_t checksum = hash(data);
    std::string bytes(sizeof checksum, '\0');
    std::memcpy(bytes.data(), &checksum, sizeof checksum);
    bytes.append(data.begin(), data.end());
    if (bytes.size() <= MAX_BYTES) write_private_file(*folder_, name_, bytes);
}

}  // namespace candela::vk
