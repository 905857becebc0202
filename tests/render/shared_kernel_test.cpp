// Which scenes have the same kernel, and that their pictures are those of kernels of their own.
#include <random>
#include <set>

#include "render/scene_buffers.h"
#include "render_fixture.h"
#include "shared/light.h"

namespace candela {
namespace {

// What a model may have, a bit each.
struct With {
    enum : uint32_t {
        COLORS = 1u << 0,
        BASE_IMAGE = 1u << 1,
        NORMAL_MAP = 1u << 2,
        OPACITY = 1u << 3,
        CULLED = 1u << 4,
        METAL = 1u << 5,
        ANISOTROPY = 1u << 6,
        COAT = 1u << 7,
        COAT_NORMAL = 1u << 8,
        SHEEN = 1u << 9,
        IRIDESCENCE = 1u << 10,
        THIN = 1u << 11,
        VOLUME = 1u << 12,
        DISPERSION = 1u << 13,
        UNLIT_PART = 1u << 14,
        GLOW = 1u << 15,
        GLOWING_IMAGE = 1u << 16,
        POINT = 1u << 17,
        SPOT = 1u << 18,
        SUN = 1u << 19,
        SKY = 1u << 20,
        ONLY_UNLIT = 1u << 21,
    };
    static constexpr uint32_t COUNT = 22;
};

bool has(uint32_t features, uint32_t feature) {
    return (features & feature) != 0;
}

void add_lights(Scene& scene, uint32_t features) {
    if (has(features, With::POINT)) scene.lights.push_back({"", PointLight{{0, 3, 3}, vec3(20)}});
    if (has(features, With::SPOT)) scene.lights.push_back({"", SpotLight{{2, 3, 3}, {-2, -3, -3}, vec3(30)}});
    if (has(features, With::SUN)) scene.lights.push_back({"", DirectionalLight{{0, -1, -1}, vec3(2)}});
    if (has(features, With::SKY))
        scene.environment =
            Environment{.size = {2, 1}, .radiance = {vec3(0.5f), vec3(1, 0.5f, 0.2f)}, .visible = false};
}

PrincipledMaterial material_with(uint32_t features, const Texture& image) {
    PrincipledMaterial m;
    m.double_sided = !has(features, With::CULLED);
    if (has(features, With::BASE_IMAGE)) m.base_color.texture = image;
    if (has(features, With::ONLY_UNLIT)) {
        m.unlit = true;
        return m;
    }
    if (has(features, With::METAL)) m.metalness = 1.0f;
    if (has(features, With::ANISOTROPY)) m.anisotropy = 0.5f;
    if (has(features, With::COAT) || has(features, With::COAT_NORMAL)) m.coat = 1.0f;
    if (has(features, With::COAT_NORMAL)) m.coat_normal_map = NormalMap{image, 0.5f};
    if (has(features, With::SHEEN)) m.sheen_color = vec3(0.5f);
    if (has(features, With::IRIDESCENCE)) m.iridescence = 1.0f;
    if (has(features, With::THIN) || has(features, With::VOLUME)) m.transmission = 0.8f;
    if (has(features, With::VOLUME)) m.inside = Medium{vec3(1, 0.5f, 2)};
    if (has(features, With::VOLUME) && has(features, With::DISPERSION)) m.dispersion = 1.0f;
    return m;
}

// Two balls of which the first has these features.
Scene model_with(uint32_t features) {
    Scene scene = scene_with_camera(dvec3(0, 0, 5), dvec3(0), 0.9f);
    const Texture image = add_texture(scene, {4, 2}, [](uint32_t x, uint32_t y) {
        return vec4(0.4f + 0.1f * float(x), 0.5f, 0.6f + 0.2f * float(y), x == 0 ? 0.2f : 1.0f);
    });
    const uint32_t material = add_material(scene, material_with(features, image));
    Material& m = scene.materials[material];
    if (has(features, With::NORMAL_MAP)) m.normal_map = NormalMap{image, 0.5f};
    m.vertex_colors = has(features, With::COLORS);
    if (has(features, With::OPACITY)) m.opacity.value = {1.0f, image};
    std::optional<Emission> glow;
    if (has(features, With::GLOW)) glow = Emission{vec3(3, 2, 1), false};
    if (has(features, With::GLOWING_IMAGE)) glow = Emission{{vec3(3, 2, 1), image}, false};
    TriangleMesh ball = sphere_mesh(4, 6);
    if (has(features, With::COLORS)) ball.colors.assign(ball.positions.size(), vec4(0.5f, 1, 0.5f, 1));
    add_shape(scene, ball, material, has(features, With::ONLY_UNLIT) ? std::nullopt : glow);
    for (vec3& p : ball.positions)
        p.x += 1.5f;
    const bool unlit = has(features, With::UNLIT_PART) || has(features, With::ONLY_UNLIT);
    PrincipledMaterial second{.base_color = {vec3(0.5f), image}, .unlit = unlit};
    if (!has(features, With::BASE_IMAGE)) second.base_color.texture.reset();
    add_shape(scene, ball, add_material(scene, second));
    add_lights(scene, features);
    return scene;
}

// As loaders do: a model without light gets a sky, unless it is unlit.
uint32_t lit(uint32_t features) {
    constexpr uint32_t LIGHTS = With::GLOW | With::GLOWING_IMAGE | With::POINT | With::SPOT | With::SUN;
    return has(features, With::ONLY_UNLIT) || (features & LIGHTS) != 0 ? features : features | With::SKY;
}

// The device as the renderer sees it, if its driver is lavapipe, and if it is another.
class SharedKernelTest : public RenderTest {
  protected:
    SharedKernelTest() {
        info_.driver_id = VK_DRIVER_ID_MESA_LLVMPIPE;
        lavapipe_.emplace(instance_, info_);
        info_.driver_id = {};
        other_.emplace(instance_, info_);
    }
    void TearDown() override {
        lavapipe_.reset();
        other_.reset();
        RenderTest::TearDown();
    }

    static KernelConstants constants(const vk::Device& device, const Scene& scene) {
        const GpuScene gpu_scene = build_gpu_scene(scene);
        return kernel_constants(device, gpu_scene,
                                map_arrays(device.info(), gpu_scene, SceneAccess::automatic),
                                scene.cameras[0], settings_for(8, 8));
    }

    static Accumulation render_on(const vk::Device& device, const Scene& scene,
                                  const RenderSettings& settings, uint32_t spp) {
        Renderer renderer(device, build_gpu_scene(scene), scene.cameras[0], settings);
        EXPECT_TRUE(renderer.render(spp, [](double) { return true; }));
        return renderer.download();
    }

    std::optional<vk::Device> lavapipe_, other_;
};

TEST_F(SharedKernelTest, SmallModelsHaveEightOnLavapipe) {
    std::mt19937 random(1);
    std::set<std::array<uint, CONSTANT_COUNT>> kernels, of_gpus;
    const auto add = [&](uint32_t features) {
        const Scene scene = model_with(lit(features));
        kernels.insert(constants(*lavapipe_, scene).values);
        of_gpus.insert(constants(*other_, scene).values);
    };
    for (uint32_t i = 0; i < With::COUNT; ++i) {
        for (uint32_t j = 0; j <= i; ++j)
            add(1u << i | 1u << j);
    }
    for (uint32_t i = 0; i < 100; ++i)
        add(uint32_t(random() & random()) % (1u << With::COUNT));
    EXPECT_LE(kernels.size(), 8u);
    EXPECT_GT(of_gpus.size(), 100u);
}

// Where the light is chosen in the same way, bit by bit.
TEST_F(SharedKernelTest, TheirPicturesAreThoseOfKernelsOfTheirOwn) {
    constexpr uint32_t MODELS[] = {With::METAL,
                                   With::COLORS | With::CULLED,
                                   With::BASE_IMAGE | With::NORMAL_MAP,
                                   With::OPACITY | With::CULLED,
                                   With::COAT | With::SHEEN,
                                   With::VOLUME,
                                   With::ONLY_UNLIT | With::BASE_IMAGE,
                                   With::GLOWING_IMAGE | With::SKY,
                                   With::POINT | With::SPOT | With::SUN};
    for (const uint32_t features : MODELS) {
        const Scene scene = model_with(lit(features));
        RenderSettings settings = settings_for(24, 16);
        settings.aovs = true;
        const Accumulation shared = render_on(*lavapipe_, scene, settings, 4);
        const Accumulation own = render_on(*other_, scene, settings, 4);
        EXPECT_TRUE(shared.values == own.values) << "features " << std::hex << features;
    }
}

// A single light needs no choice in a kernel of its own, and turned frames have other random directions.
TEST_F(SharedKernelTest, OthersHaveTheSameExpectation) {
    constexpr uint32_t MODELS[] = {With::SUN | With::COLORS, With::COAT_NORMAL | With::VOLUME};
    for (const uint32_t features : MODELS) {
        const Scene scene = model_with(lit(features));
        RenderSettings settings = independent_settings(32, Estimator::mis, 1);
        const Image shared = image_of(render_on(*lavapipe_, scene, settings, 2048));
        settings.seed = 2;
        const Image own = image_of(render_on(*other_, scene, settings, 2048));
        expect_same_expectation(shared, own);
    }
}

TEST_F(SharedKernelTest, LargeModelsKeepTheirOwn) {
    const auto large = [](uint32_t features) {
        Scene scene = model_with(features | With::SKY);
        scene.meshes[1] = sphere_mesh(200, 200);
        return scene;
    };
    const KernelConstants plain = constants(*lavapipe_, large(0));
    EXPECT_EQ(plain, constants(*lavapipe_, large(With::METAL)));
    EXPECT_FALSE(plain == constants(*lavapipe_, large(With::COAT)));
    EXPECT_EQ(plain[CONSTANT_ATTRIBUTES], 0u);
}

}  // namespace
}  // namespace candela
