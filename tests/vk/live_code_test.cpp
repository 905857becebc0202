// Kernels without the code that their constants leave out, and with ways around their functions: the
// validation layer accepts them, and they do the same.
#include "vk/live_code.h"

#include "render/kernels.h"
#include "vk/buffer.h"
#include "vk/commands.h"
#include "vk/transfer.h"
#include "vk/ways_around.h"
#include "vk_fixture.h"

namespace candela::kernels {
extern const std::span<const std::uint32_t> control_flow, control_flow_inlined;
}

namespace candela::vk {
namespace {

struct ControlFlow {
    bool A, B;
    uint32_t N;

    using uint = uint32_t;
#define precise
#include "kernels/control_flow.h"
#undef precise
};

std::vector<uint32_t> results_of(const Device& device, std::span<const uint32_t> spirv,
                                 const ControlFlow& constants) {
    constexpr size_t RESULTS = size_t{9} * 64;
    constexpr std::array BINDINGS{Binding{0, BindingType::storage_buffer}};
    const Buffer buffer(device, RESULTS * sizeof(uint32_t), BufferUsage::storage, "results");
    Kernel kernel(device, spirv, BINDINGS, 0, {{constants.A, constants.B, constants.N}}, "control_flow");
    kernel.bind(0, buffer);
    Commands commands(device);
    commands.dispatch(kernel, {}, {1, 1, 1});
    commands.submit_and_wait();
    std::vector<uint32_t> results(RESULTS);
    download(buffer, std::as_writable_bytes(std::span(results)));
    return results;
}

TEST_F(Vk, KernelsWithoutDeadCodeDoTheSame) {
    const Device device(instance_, info_);
    for (const auto spirv : {kernels::control_flow, kernels::control_flow_inlined}) {
        for (uint32_t k = 0; k < 20; ++k) {
            ControlFlow constants{k % 2 == 1, k / 2 % 2 == 1, k / 4};
            SCOPED_TRACE(testing::Message() << constants.A << constants.B << constants.N);
            const std::vector<uint32_t> results = results_of(device, spirv, constants);
            for (uint32_t i = 0; i < results.size(); ++i)
                ASSERT_EQ(results[i], constants.control_flow(i / 64, i % 64)) << "function " << i / 64;
        }
    }
}

TEST_F(Vk, KernelsWithWaysAroundFunctionsDoTheSame) {
    const Device device(instance_, info_);
    const auto spirv = kernels::control_flow;
    const ControlFlow constants{true, false, 3};
    const std::vector<uint32_t> results = results_of(device, spirv, constants);
    const std::vector<uint32_t> code = with_ways_around(spirv, 2);
    EXPECT_GT(code.size(), with_ways_around(spirv, 100).size());
    EXPECT_EQ(results_of(device, code, constants), results);
}

TEST(WaysAround, NeedFunctionsOfThatSizeAndTheIndexOfAnInvocation) {
    const auto spirv = kernels::control_flow;
    EXPECT_GT(with_ways_around(spirv, 1).size(), spirv.size());
    EXPECT_EQ(with_ways_around(spirv, 100).size(), spirv.size() + 4);  // A constant that nothing uses.
    std::vector<uint32_t> without_index(spirv.begin(), spirv.end());
    constexpr uint32_t BUILT_IN = 11, LOCAL_INVOCATION_INDEX = 29, LOCAL_INVOCATION_ID = 27;
    for (size_t i = 0; i + 1 < without_index.size(); ++i) {
        if (without_index[i] == BUILT_IN && without_index[i + 1] == LOCAL_INVOCATION_INDEX)
            without_index[i + 1] = LOCAL_INVOCATION_ID;
    }
    EXPECT_EQ(with_ways_around(without_index, 1), without_index);
}

// No branch depends on the constants any more, and no function is left that nothing calls.
TEST(LiveCode, IsLessAndComplete) {
    for (const auto spirv : {kernels::render, kernels::render_inlined, kernels::render_layered}) {
        std::vector<uint32_t> constants(100, 0);
        const std::vector<uint32_t> live = live_code(spirv, constants);
        EXPECT_LT(live.size(), spirv.size() / 2);
        EXPECT_EQ(live_code(live, constants), live);
    }
}

}  // namespace
}  // namespace candela::vk
