// host/vk's instance and device: what they report, which errors they give, and the file of the pipeline
// cache.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "vk/buffer.h"
#include "vk/commands.h"
#include "vk/device.h"
#include "vk/image.h"
#include "vk/kernel.h"
#include "vk/pipeline_cache.h"
#include "vk/transfer.h"
#include "vk_fixture.h"

namespace candela::vk {
namespace {

// Sets an environment variable for the length of a scope.
class ScopedVariable {
  public:
    ScopedVariable(const char* name, const char* value) : name_(name) {
        if (const char* old = std::getenv(name)) old_ = old;
        setenv(name, value, 1);
    }
    ~ScopedVariable() { old_ ? setenv(name_, old_->c_str(), 1) : unsetenv(name_); }
    ScopedVariable(const ScopedVariable&) = delete;
    ScopedVariable& operator=(const ScopedVariable&) = delete;

  private:
    const char* name_;
    std::optional<std::string> old_;
};

TEST_F(Vk, DeviceInfoIsFilledIn) {
    EXPECT_EQ(info_.index, uint32_t(&select_device(devices_, {}) - devices_.data()));
    EXPECT_FALSE(info_.name.empty());
    EXPECT_GE(info_.driver.size(), 3u);
    EXPECT_GE(info_.api_version, VK_API_VERSION_1_2);
    EXPECT_GT(info_.device_heap, 0u);
    EXPECT_GT(info_.subgroup_size, 0u);
    // What every Vulkan 1.2 device guarantees.
    EXPECT_GE(info_.limits.max_compute_work_group_invocations, 128u);
    EXPECT_GE(info_.limits.max_texel_buffer_elements, 65536u);
    EXPECT_GE(info_.limits.max_storage_buffer_range, 1u << 27);
    EXPECT_GE(info_.limits.max_push_constants_size, 128u);
    EXPECT_GE(info_.limits.max_image_array_layers, 256u);
    EXPECT_GE(info_.limits.max_image_bytes, uint64_t{1} << 31);
    EXPECT_GE(info_.limits.max_memory_allocation_size, uint64_t{1} << 30);
}

TEST_F(Vk, LimitsAreNamed) {
    const std::string allows = ", but \"" + info_.name + "\" allows ";
    const std::string remedy = "; use less or choose another device";
    info_.limits.max_texel_buffer_elements = 100;
    info_.limits.max_storage_buffer_range = 1600;
    info_.limits.max_uniform_buffer_range = 160;
    info_.limits.max_image_dimension_2d = 64;
    info_.limits.max_image_array_layers = 4;
    info_.limits.max_image_bytes = 64 * 64 * 4 * 16 - 1;
    info_.limits.max_push_constants_size = 4;
    const Device device(instance_, info_);
    const auto too_big = [](const std::function<void()>& action) {
        return error_of(ErrorKind::out_of_memory, action);
    };

    EXPECT_EQ(too_big([&] { Buffer(device, 1601, BufferUsage::texel, "nodes"); }),
              "buffer \"nodes\" needs 101 texels" + allows + "100 (maxTexelBufferElements)" + remedy);
    EXPECT_EQ(too_big([&] { Buffer(device, 1601, BufferUsage::storage, "nodes"); }),
              "buffer \"nodes\" needs 1616 bytes" + allows + "1600 (maxStorageBufferRange)" + remedy);
    EXPECT_EQ(too_big([&] { Buffer(device, 161, BufferUsage::uniform, "camera"); }),
              "buffer \"camera\" needs 176 bytes" + allows + "160 (maxUniformBufferRange)" + remedy);
    EXPECT_EQ(too_big([&] { make_storage_image(device, 65, 1, 1, "film"); }),
              "image \"film\" (65x1, 1 layers) needs 65 pixels across" + allows + "64 (maxImageDimension2D)" +
                  remedy);
    EXPECT_EQ(too_big([&] { make_storage_image(device, 1, 66, 1, "film"); }),
              "image \"film\" (1x66, 1 layers) needs 66 pixels down" + allows + "64 (maxImageDimension2D)" +
                  remedy);
    EXPECT_EQ(too_big([&] { make_storage_image(device, 1, 1, 5, "film"); }),
              "image \"film\" (1x1, 5 layers) needs 5 layers" + allows + "4 (maxImageArrayLayers)" + remedy);
    EXPECT_EQ(
        too_big([&] { make_storage_image(device, 64, 64, 4, "film"); }),
        "image \"film\" (64x64, 4 layers) needs 262144 bytes" + allows + "262143 (maxResourceSize)" + remedy);
    EXPECT_EQ(
        too_big([&] { Kernel(device, kernels::vk_test, TEST_BINDINGS, 8, {}, "trace"); }),
        "kernel \"trace\" needs 8 bytes of push constants" + allows + "4 (maxPushConstantsSize)" + remedy);
}

TEST_F(Vk, LimitsOfMemoryAndBindingsAreNamed) {
    const std::string allows = ", but \"" + info_.name + "\" allows ";
    const std::string remedy = "; use less or choose another device";
    const auto too_big = [](const std::function<void()>& action) {
        return error_of(ErrorKind::out_of_memory, action);
    };
    info_.limits.max_per_stage_descriptor_storage_buffers = 1;
    info_.limits.max_memory_allocation_size = 4096;
    const Device device(instance_, info_);
    EXPECT_EQ(too_big([&] { Kernel(device, kernels::vk_test, TEST_BINDINGS, 8, {}, "trace"); }),
              "kernel \"trace\" needs 2 storage buffers" + allows +
                  "1 (maxPerStageDescriptorStorageBuffers)" + remedy);
    EXPECT_EQ(too_big([&] { Buffer(device, 8192, BufferUsage::storage, "nodes"); }),
              "buffer \"nodes\" needs 8192 bytes" + allows + "4096 (maxMemoryAllocationSize)" + remedy);
}

TEST_F(Vk, AvailableMemoryBoundsAllocations) {
    info_.type = DeviceType::discrete;  // Its heap is then used, even on a CPU.
    info_.device_heap = 1 << 20;
    const Device device(instance_, info_);
    EXPECT_EQ(device.available_memory(), uint64_t{1} << 20);
    EXPECT_EQ(error_of(ErrorKind::out_of_memory, [&] { make_storage_image(device, 512, 512, 1, "film"); }),
              "image \"film\" (512x512, 1 layers) needs 4194304 bytes, but \"" + info_.name +
                  "\" allows 1048576 (available memory); use less or choose another device");
}

TEST_F(Vk, ADeviceThatWillNotDoIsNotOpened) {
    info_.reason = "it has no compute queue";
    EXPECT_EQ(error_of(ErrorKind::no_device, [&] { Device(instance_, info_); }),
              "device \"" + info_.name + "\" is unsuitable: it has no compute queue");
}

TEST(VkInstance, WithoutADriverNamesTheRemedy) {
    const ScopedVariable old_name("VK_ICD_FILENAMES", "/dev/null");
    const ScopedVariable new_name("VK_DRIVER_FILES", "/dev/null");
    EXPECT_EQ(error_of(ErrorKind::no_device, [] { Instance instance({}); }),
              "no Vulkan driver is installed; install the driver of your GPU, or mesa-vulkan-drivers to "
              "render on the "
              "CPU");
}

// A driver's file that cannot be read, and one whose library is missing, or is not a library.
TEST(VkInstance, WithABrokenDriverNamesItsFile) {
    const std::filesystem::path driver =
        std::filesystem::temp_directory_path() / ("candela-driver-" + std::to_string(getpid()) + ".json");
    const ScopedVariable old_name("VK_ICD_FILENAMES", driver.c_str());
    const ScopedVariable new_name("VK_DRIVER_FILES", driver.c_str());
    const auto with_library = [](const std::string& library) {
        return R"({"file_format_version": "1.0.0", "ICD": {"api_version": "1.2.0", "library_path": ")" +
               library + "\"}}";
    };
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"{\"ICD", driver.string()},
        {with_library("/nonexistent/lib.so"), "/nonexistent/lib.so"},
        {with_library(driver.string()), driver.string()}};
    for (const auto& [text, named] : cases) {
        std::ofstream(driver) << text;
        const std::string message = error_of(ErrorKind::no_device, [] { Instance instance({}); });
        EXPECT_TRUE(message.starts_with("no Vulkan driver can be loaded: ")) << message;
        EXPECT_NE(message.find(named), std::string::npos) << message;
        EXPECT_TRUE(message.ends_with("; repair or remove that file, or install the driver again"))
            << message;
        EXPECT_EQ(message.find("memory"), std::string::npos) << message;
    }
    std::filesystem::remove(driver);
}

TEST(VkInstance, WithoutTheValidationLayerNamesTheRemedy) {
    const ScopedVariable layers("VK_LAYER_PATH", "/nonexistent");
    EXPECT_EQ(error_of(ErrorKind::other, [] { Instance instance({.validation = true}); }),
              "validation was asked for, but the Vulkan layer VK_LAYER_KHRONOS_validation is missing; "
              "install vulkan-validationlayers");
    EXPECT_FALSE(Instance({}).devices().empty());
}

TEST(VkInstance, CollectsWhatTheValidationLayerSays) {
    const Instance instance({.validation = true});
    const std::vector<DeviceInfo> devices = instance.devices();
    {
        const Device device(instance, select_device(devices, {}));
        EXPECT_TRUE(instance.validation_messages().empty());
        VkFenceCreateInfo info{};  // Its type is missing.
        VkFence fence = VK_NULL_HANDLE;
        vkCreateFence(device.handle(), &info, nullptr, &fence);
        vkDestroyFence(device.handle(), fence, nullptr);
    }
    EXPECT_FALSE(instance.validation_messages().empty());
}

// Two writes of one buffer, the second of which does not wait for the first.
TEST(VkInstance, CollectsWhatSynchronizationLacks) {
    const Instance instance({.validation = true});
    const std::vector<DeviceInfo> devices = instance.devices();
    const Device device(instance, select_device(devices, {}));
    const Buffer buffer(device, 16, BufferUsage::storage, "written twice");
    Commands commands(device);
    vkCmdFillBuffer(commands.handle(), buffer.handle(), 0, VK_WHOLE_SIZE, 1);
    EXPECT_TRUE(instance.validation_messages().empty());
    vkCmdFillBuffer(commands.handle(), buffer.handle(), 0, VK_WHOLE_SIZE, 2);
    EXPECT_FALSE(instance.validation_messages().empty());
}

// A directory of its own for the pipeline cache's file.
class VkPipelineCache : public Vk {
  protected:
    VkPipelineCache() { std::filesystem::remove_all(directory_); }
    ~VkPipelineCache() override { std::filesystem::remove_all(directory_); }

    // Opens the device with the cache in the file, compiles a kernel and closes it again.
    void use_cache() const {
        const Device device(instance_, info_, directory_);
        const Kernel kernel(device, kernels::vk_test, TEST_BINDINGS, sizeof(TestPush), {}, "cached");
    }
    std::vector<std::filesystem::path> files() const {
        std::vector<std::filesystem::path> result;
        for (const auto& entry : std::filesystem::directory_iterator(directory_))
            result.push_back(entry.path());
        return result;
    }
    // The only file.
    std::filesystem::path file() const {
        EXPECT_EQ(files().size(), 1u);
        return files().at(0);
    }
    static std::string contents(const std::filesystem::path& file) {
        std::ifstream stream(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    static void write(const std::filesystem::path& file, const std::string& data) {
        std::ofstream(file, std::ios::binary) << data;
    }

    // The bytes that precede the data.
    static std::string hash_of(std::string_view data) {
        uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a.
        for (const char c : data)
            hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
        return {reinterpret_cast<const char*>(&hash), sizeof hash};
    }
    // The file is complete, and this device's. A driver may well give other data each time.
    void expect_good() const {
        const std::string data = contents(file());
        ASSERT_GE(data.size(), HASH_BYTES + sizeof(VkPipelineCacheHeaderVersionOne));
        EXPECT_EQ(data.substr(0, HASH_BYTES), hash_of(std::string_view(data).substr(HASH_BYTES)));
        VkPhysicalDeviceProperties properties{};
        vkGetPhysicalDeviceProperties(info_.handle, &properties);
        VkPipelineCacheHeaderVersionOne header{};
        std::memcpy(&header, data.data() + HASH_BYTES, sizeof header);
        EXPECT_EQ(header.headerVersion, VK_PIPELINE_CACHE_HEADER_VERSION_ONE);
        EXPECT_EQ(header.vendorID, properties.vendorID);
        EXPECT_EQ(header.deviceID, properties.deviceID);
        EXPECT_EQ(std::memcmp(header.pipelineCacheUUID, properties.pipelineCacheUUID, VK_UUID_SIZE), 0);
    }

    const std::filesystem::path directory_ =
        std::filesystem::temp_directory_path() / ("candela-vk-test-" + std::to_string(getpid()));
    static constexpr size_t HASH_BYTES = 8;
};

TEST_F(VkPipelineCache, IsSavedWhenItChangedAndLeavesNothingElse) {
    use_cache();
    expect_good();
    const std::string before = contents(file());
    const auto long_ago = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
    std::filesystem::last_write_time(file(), long_ago);
    const auto written = std::filesystem::last_write_time(file());  // As the file system holds it.
    use_cache();
    expect_good();
    // Some drivers' data grow each time.
    EXPECT_EQ(std::filesystem::last_write_time(file()) == written, contents(file()) == before);
}

TEST_F(VkPipelineCache, DamagedDataIsIgnoredAndReplaced) {
    use_cache();
    const std::string good = contents(file());
    std::string flipped = good;
    flipped.back() = static_cast<char>(flipped.back() ^ 1);
    for (const std::string& bad : {std::string{}, std::string("not a cache"), good.substr(0, 20), flipped}) {
        write(file(), bad);
        use_cache();
        expect_good();
    }
}

TEST_F(VkPipelineCache, DataOfAnotherDeviceIsIgnoredAndReplaced) {
    use_cache();
    const std::string good = contents(file());
    for (const size_t field : {4u, 8u, 12u, 16u}) {  // Version, vendor, device, UUID.
        std::string data = good.substr(HASH_BYTES);
        data[field] = static_cast<char>(data[field] ^ 1);
        write(file(), hash_of(data) + data);
        use_cache();
        expect_good();
    }
}

TEST_F(VkPipelineCache, EachDeviceHasAFileOfItsOwn) {
    use_cache();
    const std::filesystem::path first = file();
    const std::string good = contents(first);
    {
        VkPhysicalDeviceProperties other{};
        vkGetPhysicalDeviceProperties(info_.handle, &other);
        other.pipelineCacheUUID[VK_UUID_SIZE - 1] ^= 1;
        const Device device(instance_, info_);
        const PipelineCache cache(device.handle(), other, directory_);
    }
    EXPECT_EQ(files().size(), 2u);
    EXPECT_EQ(contents(first), good);
}

TEST_F(VkPipelineCache, IsForThisUserAlone) {
    use_cache();
    EXPECT_EQ(std::filesystem::status(directory_).permissions(), std::filesystem::perms(0700));
}

// A folder, a pipe that nobody writes to, a device without end, and a link to another file.
TEST_F(VkPipelineCache, WhatIsNoFileIsLeftAlone) {
    use_cache();
    const std::filesystem::path place = file();
    const std::filesystem::path other = directory_ / "other";
    write(other, "precious");
    const auto fill = [&](const std::function<void()>& make) {
        std::filesystem::remove(place);
        make();
        use_cache();
        EXPECT_FALSE(std::filesystem::is_regular_file(place));
    };
    fill([&] { std::filesystem::create_directory(place); });
    fill([&] { ASSERT_EQ(::mkfifo(place.c_str(), 0600), 0); });
    fill([&] { std::filesystem::create_symlink("/dev/zero", place); });
    std::filesystem::remove(place);
    std::filesystem::create_symlink(other, place);
    use_cache();
    EXPECT_TRUE(std::filesystem::is_symlink(place));
    EXPECT_EQ(contents(other), "precious");
}

TEST_F(VkPipelineCache, WhatOthersMayHaveWrittenIsNotUsed) {
    use_cache();
    write(file(), "old");
    std::filesystem::permissions(directory_, std::filesystem::perms(0777));
    use_cache();
    EXPECT_EQ(contents(file()), "old");
}

// Larger than any cache; the file uses no space on the disk.
TEST_F(VkPipelineCache, AHugeFileIsIgnoredAndReplaced) {
    use_cache();
    std::filesystem::resize_file(file(), uintmax_t{1} << 40);
    use_cache();
    expect_good();
}

TEST_F(VkPipelineCache, AFileThatCannotBeWrittenIsNoError) {
    std::filesystem::create_directories(directory_);
    write(directory_ / "file", "");
    const Device device(instance_, info_, directory_ / "file" / "below");
}

}  // namespace
}  // namespace candela::vk
