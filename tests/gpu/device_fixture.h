// What the tests of shader functions share: a device, and probes, which map an array of items to an array of
// results (probe/probe.h), with or without a scene.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "probe/probe.h"
#include "probe/probes.h"
#include "selftest/evidence.h"
#include "support/effort.h"
#include "vk/vk_fixture.h"

namespace candela {

// Tests of distributions have fixed seeds, so that one device gives one verdict. The verdict may differ on a
// device that rounds differently; this is the probability of wrongly rejecting any of a test's hypotheses.
inline constexpr double CHI_SQUARED_ALPHA = 1e-3;

// All that a check compared must hold, and its p-values must not be too small.
inline void expect_holds(const Evidence& evidence, double alpha = CHI_SQUARED_ALPHA) {
    EXPECT_EQ(evidence.wrong(), 0u) << "of " << evidence.compared() << ", first " << evidence.first_wrong();
    EXPECT_GT(evidence.p_value(), alpha) << evidence.least_likely();
}

// A test with an open device. At its end the validation layer must not have reported anything.
class DeviceTest : public vk::Vk {
  protected:
    DeviceTest() { device_.emplace(instance_, info_); }
    void TearDown() override {
        device_.reset();
        Vk::TearDown();
    }
    const vk::Device& device() const { return *device_; }

    // probe() on this device.
    template <class Result, class Item>
    std::vector<Result> map(std::span<const uint32_t> spirv, const std::vector<Item>& items,
                            const KernelConstants& constants = {}, const DeviceScene* scene = nullptr) const {
        return probe<Result>(*device_, spirv, items, constants, scene);
    }

  private:
    std::optional<vk::Device> device_;
};

}  // namespace candela
