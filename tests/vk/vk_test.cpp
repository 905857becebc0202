// host/vk on the device at hand, with the validation layer on: data round-trips, kernels see what is bound to
// them, limits are named, and Vulkan is used as its specification says.
#include <array>
#include <chrono>
#include <cstring>
#include <numeric>
#include <set>
#include <vector>

#include "vk/buffer.h"
#include "vk/commands.h"
#include "vk/device.h"
#include "vk/image.h"
#include "vk/kernel.h"
#include "vk/transfer.h"
#include "vk_fixture.h"

namespace candela::vk {
namespace {

std::vector<uint32_t> some_words(size_t count) {
    std::vector<uint32_t> words(count);
    std::iota(words.begin(), words.end(), 1u);
    return words;
}

void expect_buffer_round_trip(const Device& device, BufferUsage usage, size_t words) {
    const std::vector<uint32_t> sent = some_words(words);
    Buffer buffer(device, words * sizeof(uint32_t), usage, "round trip");
    upload(buffer, std::as_bytes(std::span(sent)));
    // One word in the middle, so that offsets are seen.
    const uint32_t changed = 12345;
    const uint64_t offset = words / 2 * sizeof(uint32_t);
    upload(buffer, std::as_bytes(std::span(&changed, 1)), offset);

    std::vector<uint32_t> received(words);
    download(buffer, std::as_writable_bytes(std::span(received)));
    EXPECT_EQ(received[words / 2], changed);
    received[words / 2] = sent[words / 2];
    EXPECT_TRUE(received == sent);
    uint32_t one = 0;
    download(buffer, std::as_writable_bytes(std::span(&one, 1)), offset);
    EXPECT_EQ(one, changed);
}

TEST_F(Vk, BuffersOfEveryUsageRoundTrip) {
    const Device device(instance_, info_);
    for (const BufferUsage usage :
         {BufferUsage::storage, BufferUsage::texel, BufferUsage::uniform, BufferUsage::readback}) {
        expect_buffer_round_trip(device, usage, 1000);
    }
}

// A device that claims to be a discrete GPU gets its data through staging buffers, even where it shares the
// host's memory; more than one chunk of them here.
TEST_F(Vk, BuffersRoundTripThroughStaging) {
    info_.type = DeviceType::discrete;
    const Device device(instance_, info_);
    EXPECT_EQ(Buffer(device, 16, BufferUsage::storage, "staged").mapped(), nullptr);
    expect_buffer_round_trip(device, BufferUsage::storage, STAGING_BYTES / sizeof(uint32_t) + 999);
}

TEST_F(Vk, BufferSizesAreRoundedUpToWholeElements) {
    const Device device(instance_, info_);
    EXPECT_EQ(Buffer(device, 0, BufferUsage::texel, "empty").size(), 16u);
    EXPECT_EQ(Buffer(device, 17, BufferUsage::storage, "odd").size(), 32u);
}

TEST_F(Vk, ImagesStartAsZerosRoundTripAndClear) {
    const Device device(instance_, info_);
    StorageImage image = make_storage_image(device, 37, 11, 3, "round trip");
    const size_t layer_floats = size_t{37} * 11 * 4;
    const std::vector<float> zeros(3 * layer_floats, 0.0f);
    EXPECT_TRUE(download(image, 0, 3) == zeros);

    std::vector<float> sent(2 * layer_floats);
    std::iota(sent.begin(), sent.end(), 1.0f);
    upload(image, 1, sent);
    EXPECT_TRUE(download(image, 1, 2) == sent);
    EXPECT_TRUE(download(image, 2, 1) == std::vector<float>(sent.begin() + layer_floats, sent.end()));
    EXPECT_TRUE(download(image, 0, 1) == std::vector<float>(layer_floats, 0.0f));

    clear(image);
    EXPECT_TRUE(download(image, 0, 3) == zeros);
}

TEST_F(Vk, ImagesLargerThanAStagingBufferRoundTrip) {
    const Device device(instance_, info_);
    StorageImage image =
        make_storage_image(device, 4096, 1030, 1, "large");  // 1024 rows fill the staging buffer.
    std::vector<float> sent(size_t{4096} * 1030 * 4);
    std::iota(sent.begin(), sent.end(), 0.0f);
    upload(image, 0, sent);
    EXPECT_TRUE(download(image, 0, 1) == sent);
}

// The kernel of tests/kernels/vk_test.comp.glsl with resources for an image of 20x12 pixels and 2 layers.
class TestKernel {
  public:
    static constexpr uint32_t WIDTH = 20, HEIGHT = 12, LAYERS = 2;
    static constexpr std::array<uint32_t, 2> CONSTANTS{3, 5};
    static constexpr std::array<uint32_t, 3> GROUPS{(WIDTH + 7) / 8, (HEIGHT + 7) / 8, 1};

    explicit TestKernel(const Device& device)
        : kernel(device, kernels::vk_test, TEST_BINDINGS, sizeof(TestPush), CONSTANTS, "vk_test"),
          image(make_storage_image(device, WIDTH, HEIGHT, LAYERS, "pixels")),
          count(device, sizeof(uint32_t), BufferUsage::readback, "count"),
          texels_(device, texel_words.size() * sizeof(uint32_t), BufferUsage::texel, "texels"),
          weights_(device, WIDTH * sizeof(float), BufferUsage::storage, "weights"),
          tint_(device, sizeof tint, BufferUsage::uniform, "tint") {
        std::iota(weights.begin(), weights.end(), 1.0f);
        upload(texels_, std::as_bytes(std::span(texel_words)));
        upload(weights_, std::as_bytes(std::span(weights)));
        upload(tint_, std::as_bytes(std::span(tint)));
        const uint32_t zero = 0;
        upload(count, std::as_bytes(std::span(&zero, 1)));
        kernel.bind(0, texels_);
        kernel.bind(1, weights_);
        kernel.bind(2, tint_);
        kernel.bind(3, image);
        kernel.bind(4, count);
    }

    void dispatch(Commands& commands, TestPush push) const {
        commands.dispatch(kernel, std::as_bytes(std::span(&push, 1)), GROUPS);
    }
    // The layer after one dispatch with that gain. All values are small integers: exact in any order.
    std::vector<float> expected(float gain) const {
        std::vector<float> values;
        for (size_t i = 0; i < texel_words.size(); ++i) {
            const auto sum = static_cast<float>(texel_words[i] * CONSTANTS[0] + CONSTANTS[1]);
            values.push_back(sum * gain * weights[i / 4 % WIDTH] + tint[i % 4]);
        }
        return values;
    }
    uint32_t pixels_counted() const {
        uint32_t value = 0;
        std::memcpy(&value, count.mapped(), sizeof value);
        return value;
    }

    std::vector<uint32_t> texel_words = some_words(size_t{WIDTH} * HEIGHT * 4);
    std::array<float, WIDTH> weights{};
    std::array<float, 4> tint{1, 2, 3, 4};
    Kernel kernel;
    StorageImage image;
    Buffer count;

  private:
    Buffer texels_, weights_, tint_;
};

TEST_F(Vk, AKernelSeesItsResourcesConstantsAndPushConstants) {
    const Device device(instance_, info_);
    const TestKernel test(device);
    Commands commands(device);
    test.dispatch(commands, {.layer = 1, .gain = 2.0f});
    commands.submit_and_wait();
    EXPECT_EQ(download(test.image, 1, 1), test.expected(2.0f));
    EXPECT_EQ(download(test.image, 0, 1), std::vector<float>(test.texel_words.size(), 0.0f));
    EXPECT_EQ(test.pixels_counted(), TestKernel::WIDTH * TestKernel::HEIGHT);
}

TEST_F(Vk, SubmissionsFollowEachOther) {
    const Device device(instance_, info_);
    const TestKernel test(device);
    Commands commands(device);
    for (int i = 0; i < 3; ++i) {
        test.dispatch(commands, {.layer = 0, .gain = 1.0f});
        commands.submit_and_wait();
    }
    std::vector<float> expected = test.expected(1.0f);
    for (float& value : expected) {
        value *= 3;
    }
    EXPECT_EQ(download(test.image, 0, 1), expected);
}

TEST_F(Vk, AResourceCanBeBoundInPlaceOfAnother) {
    const Device device(instance_, info_);
    TestKernel test(device);
    const StorageImage other = make_storage_image(device, TestKernel::WIDTH, TestKernel::HEIGHT, 1, "other");
    test.kernel.bind(3, other);
    Commands commands(device);
    test.dispatch(commands, {.layer = 0, .gain = 1.0f});
    commands.submit_and_wait();
    EXPECT_EQ(download(other, 0, 1), test.expected(1.0f));
    EXPECT_EQ(download(test.image, 0, 1), std::vector<float>(test.texel_words.size(), 0.0f));
}

// Two kernels of the same parts share one program, with their own resources; any difference makes another.
TEST_F(Vk, OnlyKernelsOfTheSamePartsShareAProgram) {
    const Device device(instance_, info_);
    const TestKernel first(device), second(device);
    EXPECT_EQ(first.kernel.pipeline(), second.kernel.pipeline());
    std::array bindings = TEST_BINDINGS;
    const auto kernel = [&](uint32_t push_bytes, std::span<const uint32_t> constants) {
        return Kernel(device, kernels::vk_test, bindings, push_bytes, constants, "vk_test");
    };
    std::vector<Kernel> all;
    all.push_back(kernel(sizeof(TestPush), TestKernel::CONSTANTS));
    all.push_back(kernel(2 * sizeof(TestPush), TestKernel::CONSTANTS));
    all.push_back(kernel(sizeof(TestPush), {{3, 6}}));
    all.push_back(kernel(sizeof(TestPush), {{3}}));
    bindings[1].count = 2;
    all.push_back(kernel(sizeof(TestPush), TestKernel::CONSTANTS));
    std::vector<uint32_t> spirv(kernels::vk_test.begin(), kernels::vk_test.end());
    spirv[2] += 1;  // The number of the tool that made it, which means nothing.
    all.emplace_back(device, spirv, TEST_BINDINGS, sizeof(TestPush), TestKernel::CONSTANTS, "vk_test");
    EXPECT_EQ(all[0].pipeline(), first.kernel.pipeline());
    std::set<VkPipeline> pipelines;
    for (const Kernel& each : all)
        pipelines.insert(each.pipeline());
    EXPECT_EQ(pipelines.size(), all.size());

    Commands commands(device);
    first.dispatch(commands, {.layer = 0, .gain = 1.0f});
    second.dispatch(commands, {.layer = 0, .gain = 2.0f});
    commands.submit_and_wait();
    EXPECT_EQ(download(first.image, 0, 1), first.expected(1.0f));
    EXPECT_EQ(download(second.image, 0, 1), second.expected(2.0f));
}

// The device forgets programs when there are many, but not those that are used.
TEST_F(Vk, AProgramLivesAsLongAsItsKernel) {
    const Device device(instance_, info_);
    const TestKernel test(device);
    for (uint32_t i = 0; i < 2 * MAX_PROGRAMS; ++i)
        Kernel(device, kernels::vk_test, TEST_BINDINGS, sizeof(TestPush), {{i}}, "vk_test");
    EXPECT_LE(device.programs().count(), MAX_PROGRAMS);
    Commands commands(device);
    test.dispatch(commands, {.layer = 1, .gain = 2.0f});
    commands.submit_and_wait();
    EXPECT_EQ(download(test.image, 1, 1), test.expected(2.0f));
}

TEST_F(Vk, WorkIsTimedByTheDeviceOrTheHost) {
    for (const uint32_t bits : {info_.timestamp_bits, 0u}) {
        info_.timestamp_bits = bits;
        const Device device(instance_, info_);
        const TestKernel test(device);
        Commands commands(device);
        test.dispatch(commands, {.layer = 0, .gain = 1.0f});
        const auto start = std::chrono::steady_clock::now();
        const double seconds = commands.submit_and_wait();
        const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
        EXPECT_GT(seconds, 0.0);
        EXPECT_LE(seconds, wall.count());
    }
}

TEST_F(Vk, TooManyWorkGroupsAreRefused) {
    const Device device(instance_, info_);
    const TestKernel test(device);
    Commands commands(device);
    const uint32_t max = info_.limits.max_compute_work_group_count[1];
    const TestPush push{};
    EXPECT_EQ(
        error_of(ErrorKind::out_of_memory,
                 [&] {
                     commands.dispatch(test.kernel, std::as_bytes(std::span(&push, 1)), {1, max + 1, 1});
                 }),
        "a dispatch of kernel \"vk_test\" needs " + std::to_string(max + 1) +
            " work groups along one axis, but \"" + info_.name + "\" allows " + std::to_string(max) +
            " (maxComputeWorkGroupCount); use less or choose another device");
}

}  // namespace
}  // namespace candela::vk
