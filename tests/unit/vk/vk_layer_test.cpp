// The parts of host/vk that need no device: the choice among devices, failed calls as errors, owned handles.
#include <algorithm>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "vk/check.h"
#include "vk/device_info.h"
#include "vk/handle.h"

namespace candela::vk {
namespace {

DeviceInfo make_device(uint32_t index, const char* name, DeviceType type, const char* reason = "") {
    DeviceInfo info;
    info.index = index;
    info.name = name;
    info.type = type;
    info.reason = reason;
    return info;
}

const std::vector<DeviceInfo> DEVICES{
    make_device(0, "llvmpipe (LLVM 15.0.6, 256 bits)", DeviceType::cpu),
    make_device(1, "Old Radeon", DeviceType::discrete, "it offers Vulkan 1.1.70, and 1.2 is needed"),
    make_device(2, "Intel UHD 630", DeviceType::integrated),
    make_device(3, "Radeon RX 6600", DeviceType::discrete),
};

uint32_t selected(const std::optional<std::string>& request) {
    return select_device(DEVICES, request).index;
}

// The message and the kind of the error that `action` must throw.
std::pair<std::string, std::optional<ErrorKind>> error_and_kind_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        return {error.what(), error.kind()};
    }
    return {"no error", std::nullopt};
}

TEST(SelectDevice, PrefersDiscreteThenIntegratedThenVirtualThenCpu) {
    EXPECT_EQ(selected(std::nullopt), 3u);
    std::vector<DeviceInfo> devices{make_device(0, "a", DeviceType::cpu),
                                    make_device(1, "b", DeviceType::virtual_gpu),
                                    make_device(2, "c", DeviceType::integrated)};
    EXPECT_EQ(select_device(devices, std::nullopt).index, 2u);
    devices.pop_back();
    EXPECT_EQ(select_device(devices, std::nullopt).index, 1u);
    devices.pop_back();
    EXPECT_EQ(select_device(devices, std::nullopt).index, 0u);
}

TEST(SelectDevice, TakesTheFirstOfEquals) {
    const std::vector<DeviceInfo> devices{make_device(0, "a", DeviceType::discrete),
                                          make_device(1, "b", DeviceType::discrete)};
    EXPECT_EQ(select_device(devices, std::nullopt).index, 0u);
}

TEST(SelectDevice, PrefersLavapipeAmongCpusAlone) {
    std::vector<DeviceInfo> devices{make_device(0, "a", DeviceType::cpu),
                                    make_device(1, "b", DeviceType::cpu),
                                    make_device(2, "c", DeviceType::cpu)};
    devices[0].driver_id = VK_DRIVER_ID_GOOGLE_SWIFTSHADER;
    devices[1].driver_id = devices[2].driver_id = VK_DRIVER_ID_MESA_LLVMPIPE;
    EXPECT_EQ(select_device(devices, std::nullopt).index, 1u);
    devices[0].type = DeviceType::virtual_gpu;
    EXPECT_EQ(select_device(devices, std::nullopt).index, 0u);
}

TEST(SelectDevice, TakesDirect3DOnlyIfThereIsNothingElse) {
    std::vector<DeviceInfo> devices{make_device(0, "a", DeviceType::discrete),
                                    make_device(1, "b", DeviceType::cpu)};
    devices[0].driver_id = VK_DRIVER_ID_MESA_DOZEN;
    EXPECT_EQ(select_device(devices, std::nullopt).index, 1u);
    EXPECT_EQ(select_device(devices, "a").index, 0u);
    devices.pop_back();
    EXPECT_EQ(select_device(devices, std::nullopt).index, 0u);
}

TEST(SelectDevice, TakesAnIndexOrAPartOfTheNameInAnyCase) {
    EXPECT_EQ(selected("0"), 0u);
    EXPECT_EQ(selected("2"), 2u);
    EXPECT_EQ(selected("LLVMPIPE"), 0u);
    EXPECT_EQ(selected("uhd"), 2u);
    EXPECT_EQ(selected("radeon rx"), 3u);
}

TEST(SelectDevice, NoMatchListsWhatThereIs) {
    for (const char* request : {"geforce", "4", "-1", "2x"}) {
        const auto [message, kind] = error_and_kind_of([&] { selected(request); });
        EXPECT_EQ(kind, ErrorKind::no_device);
        EXPECT_EQ(
            message,
            "no device matches \"" + std::string(request) +
                "\"; give the index or a part of the name of one of: "
                "0: \"llvmpipe (LLVM 15.0.6, 256 bits)\" (CPU), "
                "1: \"Old Radeon\" (discrete GPU; unsuitable: it offers Vulkan 1.1.70, and 1.2 is needed), "
                "2: \"Intel UHD 630\" (integrated GPU), 3: \"Radeon RX 6600\" (discrete GPU)");
    }
}

TEST(SelectDevice, AnAmbiguousNameListsWhatThereIs) {
    const auto [message, kind] = error_and_kind_of([] { selected("radeon"); });
    EXPECT_EQ(kind, ErrorKind::no_device);
    EXPECT_NE(message.find("more than one device matches \"radeon\"; give the index"), std::string::npos)
        << message;
    EXPECT_NE(message.find("3: \"Radeon RX 6600\""), std::string::npos) << message;
}

TEST(SelectDevice, ADeviceThatWillNotDoIsRefusedWithItsReason) {
    for (const char* request : {"1", "old"}) {
        const auto [message, kind] = error_and_kind_of([&] { selected(request); });
        EXPECT_EQ(kind, ErrorKind::no_device);
        EXPECT_EQ(message,
                  "device 1 \"Old Radeon\" is unsuitable: it offers Vulkan 1.1.70, and 1.2 is needed; choose "
                  "another device or install a newer driver");
    }
}

TEST(SelectDevice, WithoutAUsableDeviceItNamesTheRemedy) {
    const auto [none, none_kind] = error_and_kind_of([] { select_device({}, std::nullopt); });
    EXPECT_EQ(none_kind, ErrorKind::no_device);
    EXPECT_EQ(
        none,
        "Vulkan finds no device; install the driver of your GPU, or mesa-vulkan-drivers to render on the "
        "CPU");
    const auto [unfit, unfit_kind] =
        error_and_kind_of([] { select_device(std::span(DEVICES).subspan(1, 1), std::nullopt); });
    EXPECT_EQ(unfit_kind, ErrorKind::no_device);
    EXPECT_NE(unfit.find("no suitable Vulkan device:  1: \"Old Radeon\""), std::string::npos) << unfit;
    EXPECT_NE(unfit.find("install a newer driver, or mesa-vulkan-drivers"), std::string::npos) << unfit;
}

TEST(VkCheck, PassesSuccessCodesOn) {
    EXPECT_EQ(VK_CHECK(VK_SUCCESS), VK_SUCCESS);
    EXPECT_EQ(VK_CHECK(VK_TIMEOUT), VK_TIMEOUT);
}

TEST(VkCheck, NamesTheCallThePlaceTheResultAndTheRemedy) {
    const auto [message, kind] = error_and_kind_of(
        [] { check(VK_ERROR_DEVICE_LOST, "vkQueueSubmit(q)", "/home/me/host/vk/commands.cpp", 7); });
    EXPECT_EQ(kind, ErrorKind::device_lost);
    EXPECT_EQ(message,
              "vkQueueSubmit(q) failed at commands.cpp:7: VK_ERROR_DEVICE_LOST (-4); the driver stopped the "
              "device, see the system's log; try another device or a newer driver");
}

TEST(VkCheck, TellsKindsOfFailuresApart) {
    EXPECT_EQ(error_and_kind_of([] { VK_CHECK(VK_ERROR_OUT_OF_DEVICE_MEMORY); }).second,
              ErrorKind::out_of_memory);
    EXPECT_EQ(error_and_kind_of([] { VK_CHECK(VK_ERROR_OUT_OF_HOST_MEMORY); }).second,
              ErrorKind::out_of_memory);
    EXPECT_EQ(error_and_kind_of([] { VK_CHECK(VK_ERROR_INITIALIZATION_FAILED); }).second, ErrorKind::other);
}

// Stands for a Vulkan handle; `destroyed` holds what was destroyed, in order.
std::vector<int> destroyed;
void destroy(int handle, const VkAllocationCallbacks*) {
    destroyed.push_back(handle);
}

TEST(Unique, DestroysEachHandleOnceHoweverItMoves) {
    destroyed.clear();
    {
        Unique<int> a{1, destroy};
        Unique<int> b{2, destroy};
        Unique<int> moved = std::move(a);
        EXPECT_EQ(moved.get(), 1);
        b = std::move(moved);
        EXPECT_EQ(b.get(), 1);
        const Unique<int> empty;
        EXPECT_EQ(empty.get(), 0);
    }
    std::sort(destroyed.begin(), destroyed.end());
    EXPECT_EQ(destroyed, (std::vector{1, 2}));
}

}  // namespace
}  // namespace candela::vk
