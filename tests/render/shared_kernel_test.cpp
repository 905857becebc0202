// Which scenes have the same kernel.
#include "render/scene_buffers.h"
#include "render_fixture.h"

namespace candela {
namespace {

class SharedKernelTest : public RenderTest {
  protected:
    // The constants for a ball of that material, of 2 x 16 x rings triangles.
    KernelConstants constants(VkDriverId driver, uint32_t rings, const PrincipledMaterial& material) const {
        Scene scene = scene_with_camera(dvec3(0, 0, 5), dvec3(0), 0.9f);
        add_shape(scene, sphere_mesh(rings, 16), add_material(scene, material));
        vk::DeviceInfo info = info_;
        info.driver_id = driver;
        const vk::Device device(instance_, info);
        const GpuScene gpu_scene = build_gpu_scene(scene);
        return kernel_constants(device, gpu_scene, map_arrays(info, gpu_scene, SceneAccess::automatic),
                                scene.cameras[0], settings_for(8, 8));
    }
};

TEST_F(SharedKernelTest, PlainModelsShareOneOnLavapipe) {
    const PrincipledMaterial plastic{.metalness = 0.0f}, metal{.metalness = 1.0f, .roughness = 0.1f};
    const KernelConstants small = constants(VK_DRIVER_ID_MESA_LLVMPIPE, 8, plastic);
    EXPECT_EQ(small, constants(VK_DRIVER_ID_MESA_LLVMPIPE, 60, metal));
    EXPECT_FALSE(small == constants(VkDriverId{}, 60, metal));
    EXPECT_FALSE(small == constants(VK_DRIVER_ID_MESA_LLVMPIPE, 8, {.coat = 1.0f}));
}

}  // namespace
}  // namespace candela
