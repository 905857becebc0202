// Textures: look-ups against double precision, and the same bits for all kinds of buffers.
#include <span>

#include "base/hash.h"
#include "gpu/device_fixture.h"
#include "selftest/textures.h"

namespace candela {
namespace {

using TextureTest = DeviceTest;

constexpr size_t COUNT = 1000000;

TEST_F(TextureTest, LookUpsAreThoseOfDoublePrecision) {
    expect_holds(test_textures(device(), SceneAccess::texel_buffers, COUNT));
}

// Every operation is exact or rounded to the nearest float, and none is fused, so that all devices that round
// so give the same bits. This is their hash.
constexpr uint64_t HASH = 2784162866795941463u;

TEST_F(TextureTest, EveryDeviceAndBothKindsOfBuffersGiveTheSameBits) {
    const Scene scene = texture_scene();
    const GpuScene gpu = build_gpu_scene(scene);
    const std::vector<TextureItem> items = texture_items(scene, COUNT);
    for (const SceneAccess access : {SceneAccess::texel_buffers, SceneAccess::storage_buffers}) {
        const std::vector<TextureValue> values = run_textures(device(), gpu, access, items);
        EXPECT_EQ(hash_words(std::as_bytes(std::span(values))), HASH);
    }
}

}  // namespace
}  // namespace candela
