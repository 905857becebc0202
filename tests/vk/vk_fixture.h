// What the tests of host/vk share: an instance with the validation layer on, and errors as text.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "vk/device_info.h"
#include "vk/instance.h"
#include "vk/kernel.h"

namespace candela::kernels {
extern const std::span<const std::uint32_t> vk_test;
}

namespace candela::vk {

// The message of the error that `action` must throw, which must have that kind.
inline std::string error_of(ErrorKind kind, const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), kind) << error.what();
        return error.what();
    }
    return "no error";
}

// A fresh instance and the information on its default device; a test opens the devices that it needs. When
// they are closed again, and all objects with them, the validation layer must not have reported anything.
class Vk : public testing::Test {
  protected:
    Vk()
        : instance_({.validation = true}),
          devices_(instance_.devices()),
          info_(select_device(devices_, {})) {}
    void TearDown() override { EXPECT_EQ(instance_.validation_messages(), std::vector<std::string>{}); }

    Instance instance_;
    std::vector<DeviceInfo> devices_;
    DeviceInfo info_;
};

// What tests/kernels/vk_test.comp.glsl declares.
inline constexpr std::array TEST_BINDINGS{
    Binding{0, BindingType::texel_buffer}, Binding{1, BindingType::storage_buffer},
    Binding{2, BindingType::uniform_buffer}, Binding{3, BindingType::storage_image},
    Binding{4, BindingType::storage_buffer}};
struct TestPush {
    uint32_t layer;
    float gain;
};

}  // namespace candela::vk
