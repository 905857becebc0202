// The contract: N samples give the same bits however the work was cut into submissions, sessions, files and
// threads, however the scene is read, and in a crop as in the whole.
#include <array>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <numeric>
#include <set>

#include "film/checkpoint.h"
#include "render/make_identity.h"
#include "render_fixture.h"
#include "unit/base/base_fixture.h"

namespace candela {
namespace {

// The Cornell box, and a scene with one of everything.
class IdentityTest : public RenderTest, public testing::WithParamInterface<Scene (*)()> {
  protected:
    static constexpr uint32_t SPP = 16;

    IdentityTest() : scene_(GetParam()()), gpu_scene_(build_gpu_scene(scene_)) {}

    // No multiple of the work group in either direction.
    static RenderSettings settings() {
        RenderSettings s = settings_for(37, 23);
        s.seed = 77;
        s.aovs = true;
        return s;
    }
    Renderer renderer(const RenderSettings& settings) const {
        return Renderer(device(), gpu_scene_, scene_.cameras[0], settings);
    }
    static void finish(Renderer& renderer, uint32_t spp = SPP) {
        ASSERT_TRUE(renderer.render(spp, [](double) { return true; }));
    }
    Accumulation in_one_go(const RenderSettings& settings) const {
        Renderer r = renderer(settings);
        finish(r);
        return r.download();
    }
    static void expect_same_bits(const Accumulation& a, const Accumulation& b) {
        EXPECT_EQ(a.layer_count, b.layer_count);
        ASSERT_EQ(a.values.size(), b.values.size());
        EXPECT_EQ(std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(float)), 0);
        EXPECT_EQ(image_hash(image_of(a)), image_hash(image_of(b)));
    }

    Scene scene_;
    GpuScene gpu_scene_;
};

TEST_P(IdentityTest, ManySmallSubmissions) {
    RenderSettings s = settings();
    s.submission_seconds = 10.0;
    const Accumulation whole = in_one_go(s);
    s.submission_seconds = 1e-6;  // A work group at a time, after the first submission.
    s.pass_growth = EVEN_PASS_GROWTH;
    Renderer r = renderer(s);
    size_t submissions = 0;
    EXPECT_TRUE(r.render(SPP, [&](double) { return ++submissions > 0; }));
    EXPECT_GT(submissions, 30u);  // 15 tiles a pass.
    expect_same_bits(r.download(), whole);
}

// So few pixels that all their samples fit into the first submission, however fast the device is.
TEST_P(IdentityTest, OneSubmissionOrSixteen) {
    RenderSettings s = settings();
    s.crop = {3, 2, 18, 18};
    const auto submissions = [](Renderer& r, uint32_t target) {
        size_t count = 0;
        EXPECT_TRUE(r.render(target, [&](double) { return ++count > 0; }));
        return count;
    };
    Renderer whole = renderer(s);
    EXPECT_EQ(submissions(whole, SPP), 1u);
    Renderer stepwise = renderer(s);
    size_t count = 0;
    for (uint32_t target = 1; target <= SPP; ++target)
        count += submissions(stepwise, target);
    EXPECT_EQ(count, 16u);
    expect_same_bits(stepwise.download(), whole.download());
}

// So few pixels that thousands of samples of each fit into one submission.
TEST_P(IdentityTest, ManySamplesOfAFewPixels) {
    constexpr uint32_t MANY = 5000;
    RenderSettings s = settings();
    s.crop = {20, 20, 22, 21};
    s.submission_seconds = 10.0;
    Renderer r = renderer(s);
    finish(r, MANY);
    const Accumulation at_once = r.download();
    EXPECT_EQ(at_once.total_samples(), 2 * MANY);
    Renderer stepwise = renderer(s);
    for (uint32_t target = 10; target <= MANY; target += 10)
        finish(stepwise, target);
    expect_same_bits(at_once, stepwise.download());
}

TEST_P(IdentityTest, SeveralCalls) {
    Renderer r = renderer(settings());
    for (const uint32_t target : {1u, 5u, 5u, SPP})
        finish(r, target);
    expect_same_bits(r.download(), in_one_go(settings()));
}

TEST_P(IdentityTest, AnInterruptionBetweenSubmissions) {
    RenderSettings s = settings();
    s.submission_seconds = 1e-6;
    s.pass_growth = EVEN_PASS_GROWTH;
    Renderer r = renderer(s);
    size_t submissions = 0;
    EXPECT_FALSE(r.render(SPP, [&](double) { return ++submissions < 23; }));
    const Accumulation interrupted = r.download();
    EXPECT_LT(interrupted.total_samples(), SPP * interrupted.pixel_count());
    finish(r);
    expect_same_bits(r.download(), in_one_go(settings()));
}

TEST_P(IdentityTest, AStateThatWentThroughAFile) {
    const TemporaryDirectory folder;
    {
        RenderSettings s = settings();
        s.submission_seconds = 1e-6;
        s.pass_growth = EVEN_PASS_GROWTH;
        Renderer r = renderer(s);
        size_t submissions = 0;
        r.render(SPP, [&](double) { return ++submissions < 30; });
        const Accumulation state = r.download();
        save_checkpoint(folder / "state.exr",
                        {.identity = make_identity(gpu_scene_, scene_.cameras[0], s), .maker = {}},
                        {&state, 1});
    }
    Renderer r = renderer(settings());
    r.upload(load_checkpoint(folder / "state.exr").states.at(0));
    finish(r);
    expect_same_bits(r.download(), in_one_go(settings()));
}

// Each sample by itself, folded here as the device folds them.
TEST_P(IdentityTest, SamplesThatBeginLater) {
    const Accumulation whole = in_one_go(settings());
    const size_t pixels = whole.pixel_count();
    std::vector<float> folded(whole.layer_count * pixels * 4), rays(pixels);
    Renderer r = renderer(settings());
    for (uint32_t n = 0; n < SPP; ++n) {
        RenderSettings s = settings();
        s.first_sample = n;
        r.reset(gpu_scene_, scene_.cameras[0], s);
        finish(r, 1);
        const Accumulation one = r.download();
        for (size_t i = 0; i < pixels; ++i)
            rays[i] += one.at(LAYER_SQUARE_COMPENSATION, i)[3];
        for (uint32_t layer = 0; layer < whole.layer_count; layer += 2) {
            float* const sum = &folded[layer * pixels * 4];
            float* const compensation = sum + pixels * 4;
            for (size_t i = 0; i < pixels * 4; ++i) {
                const float y = one.at(layer, 0)[i] - compensation[i];
                const float t = sum[i] + y;
                compensation[i] = (t - sum[i]) - y;
                sum[i] = t;
            }
        }
    }
    for (size_t i = 0; i < pixels; ++i) {
        folded[(LAYER_L_COMPENSATION * pixels + i) * 4 + 3] = float(SPP);
        folded[(LAYER_SQUARE_COMPENSATION * pixels + i) * 4 + 3] = rays[i];
    }
    EXPECT_EQ(std::accumulate(rays.begin(), rays.end(), 0.0), double(whole.counters.rays));
    EXPECT_EQ(std::memcmp(folded.data(), whole.values.data(), folded.size() * sizeof(float)), 0);
}

TEST_P(IdentityTest, AStateThatDoesNotFitIsRefused) {
    const Accumulation state = in_one_go(settings());
    const auto expect_refused = [&](const std::function<void(RenderSettings&)>& change) {
        RenderSettings s = settings();
        change(s);
        Renderer r = renderer(s);
        EXPECT_EQ(
            error_of([&] { r.upload(state); }),
            "the state does not fit: its size, crop, seed, first sample or set of images differs from this "
            "rendering's; render with the settings that it was made with");
    };
    expect_refused([](RenderSettings& s) { s.size.x = 38; });
    expect_refused([](RenderSettings& s) { s.crop.x0 = 1; });
    expect_refused([](RenderSettings& s) { s.seed = 78; });
    expect_refused([](RenderSettings& s) { s.first_sample = 1; });
    expect_refused([](RenderSettings& s) { s.aovs = false; });
}

TEST_P(IdentityTest, ACrop) {
    const Accumulation whole = in_one_go(settings());
    for (const PixelRect crop :
         {PixelRect{5, 3, 24, 20}, PixelRect{36, 22, 37, 23}, PixelRect{0, 9, 37, 10}}) {
        RenderSettings s = settings();
        s.crop = crop;
        const Accumulation part = in_one_go(s);
        for (uint32_t layer = 0; layer < whole.layer_count; ++layer) {
            for (uint32_t y = crop.y0; y < crop.y1; ++y) {
                const float* expected = whole.at(layer, size_t(y) * whole.rect.width() + crop.x0);
                const float* row = part.at(layer, size_t(y - crop.y0) * crop.width());
                ASSERT_EQ(std::memcmp(row, expected, crop.width() * 4 * sizeof(float)), 0)
                    << layer << ' ' << y;
            }
        }
    }
}

TEST_P(IdentityTest, TexelAndStorageBuffers) {
    RenderSettings s = settings();
    s.scene_access = SceneAccess::texel_buffers;
    const Accumulation texels = in_one_go(s);
    s.scene_access = SceneAccess::storage_buffers;
    expect_same_bits(in_one_go(s), texels);
}

// Drivers other than lavapipe get counters that a work group adds up first, and a tree for few primitives.
TEST_P(IdentityTest, TunedForLavapipeOrNot) {
    const Accumulation tuned = in_one_go(settings());
    vk::DeviceInfo info = info_;
    info.driver_id = info_.is_lavapipe() ? VkDriverId{} : VK_DRIVER_ID_MESA_LLVMPIPE;
    const vk::Device device(instance_, info);
    Renderer renderer(device, gpu_scene_, scene_.cameras[0], settings());
    finish(renderer);
    const Accumulation other = renderer.download();
    expect_same_bits(other, tuned);
    EXPECT_EQ(other.counters.rays, tuned.counters.rays);
    EXPECT_EQ(other.counters.depth_limit_hits, tuned.counters.depth_limit_hits);
}

TEST_P(IdentityTest, AovsLeaveTheColoursAlone) {
    const Accumulation with = in_one_go(settings());
    RenderSettings s = settings();
    s.aovs = false;
    const Accumulation without = in_one_go(s);
    ASSERT_EQ(without.layer_count, LAYER_COUNT_COLOUR);
    ASSERT_EQ(with.layer_count, LAYER_COUNT_AOVS);
    EXPECT_EQ(std::memcmp(without.values.data(), with.values.data(), without.values.size() * sizeof(float)),
              0);
}

TEST_P(IdentityTest, AnotherSeedIsAnotherImage) {
    RenderSettings s = settings();
    const uint64_t hash = image_hash(image_of(in_one_go(s)));
    s.seed = 78;
    EXPECT_NE(image_hash(image_of(in_one_go(s))), hash);
}

INSTANTIATE_TEST_SUITE_P(Scenes, IdentityTest,
                         testing::Values(cornell_box, scene_of_everything, textured_scene),
                         [](const testing::TestParamInfo<Scene (*)()>& scene) -> std::string {
                             return scene.param == cornell_box      ? "CornellBox"
                                    : scene.param == textured_scene ? "Textured"
                                                                    : "Everything";
                         });

// Has something in each array.
Scene scene_of_all_arrays() {
    Scene scene = textured_scene();
    scene.environment = one_bright_texel({8, 4}, {5, 1}, vec3(6, 5, 4));
    TriangleMesh ball = sphere_mesh(8, 12);
    ball.normals = ball.positions;
    add_shape(scene, transformed(ball, [](vec3 p) { return vec3(-0.9f, 0.5f, -0.3f) + 0.3f * p; }),
              add_material(scene, DielectricMaterial{.inside = {vec3(0.5f, 1, 2)}}));
    return scene;
}

class LayeredIdentityTest : public IdentityTest {};

// The facets that a principled material measures belong to the ray, not to the work's division.
TEST_P(LayeredIdentityTest, LayersInSmallTilesAndManySubmissions) {
    RenderSettings s = settings();
    s.submission_seconds = 1e-6;
    s.pass_growth = EVEN_PASS_GROWTH;
    Renderer r = renderer(s);
    for (const uint32_t target : {1u, 5u, SPP})
        finish(r, target);
    expect_same_bits(r.download(), in_one_go(settings()));
}

INSTANTIATE_TEST_SUITE_P(Scenes, LayeredIdentityTest, testing::Values(layered_scene, hazy_room));

class ArrayIdentityTest : public IdentityTest {};

// Each array is read through a texel buffer if that may hold it, regardless of the others, and storage
// buffers are shared where there are only as many as Vulkan promises.
TEST_P(ArrayIdentityTest, BuffersThatSuitEachArray) {
    const Accumulation whole = in_one_go(settings());
    std::set<std::string> choices;
    std::set<bool> shared;
    std::set<uint32_t> limits;  // Each is too little for one array.
    for (const auto& array : gpu_scene_.arrays) {
        ASSERT_GT(array.size(), 1u);
        limits.insert(uint32_t(array.size()) - 1);
    }
    uint32_t storage_buffers = 4;
    for (const uint32_t limit : limits) {
        vk::DeviceInfo info = info_;
        info.limits.max_per_stage_descriptor_storage_buffers = storage_buffers;
        info.limits.max_texel_buffer_elements = limit;
        storage_buffers = 36 - storage_buffers;  // As few as Vulkan promises and enough for all, by turns.
        const vk::Device device(instance_, info);
        Renderer renderer(device, gpu_scene_, scene_.cameras[0], settings());
        choices.insert(to_text(renderer.array_map()));
        shared.insert(renderer.array_map().shared_slot != NO_SLOT);
        finish(renderer);
        expect_same_bits(renderer.download(), whole);
    }
    EXPECT_TRUE(choices.contains("mixed"));
    EXPECT_EQ(shared.size(), 2u);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ArrayIdentityTest, testing::Values(scene_of_all_arrays));

using ListTest = RenderTest;

// Lavapipe tests the primitives of a tiny scene one by one. A speck within the tall block, which no ray hits
// and which leaves the scene's frame as it is, makes them one too many for that: then the tree must find the
// same hits, with the same bits.
TEST_F(ListTest, AListOfPrimitivesGivesTheBitsOfATree) {
    RenderSettings settings = settings_for(37, 23);
    settings.aovs = true;
    Scene scene = cornell_box();
    ASSERT_LE(build_gpu_scene(scene).primitive_count, LIST_MAX);
    const Accumulation by_list = render(scene, settings, 16);
    add_shape(scene, parallelogram(vec3(0.37f, 0.1f, 0.35f), vec3(1e-3f, 0, 0), vec3(0, 1e-3f, 0)), 0);
    ASSERT_GT(build_gpu_scene(scene).primitive_count, LIST_MAX);
    const Accumulation by_tree = render(scene, settings, 16);
    ASSERT_EQ(by_list.values.size(), by_tree.values.size());
    EXPECT_EQ(
        std::memcmp(by_list.values.data(), by_tree.values.data(), by_list.values.size() * sizeof(float)), 0);
}

// Lavapipe reads the number of its threads when an instance lists its devices; other drivers ignore the
// variable.
TEST(ThreadsTest, OneThreadTwoOrAsManyAsTheDriverLikes) {
    const Scene scene = scene_of_everything();
    const auto render_with_threads = [&](const char* threads) {
        if (threads) setenv("LP_NUM_THREADS", threads, 1);
        const vk::Instance instance({.validation = true});
        const std::vector<vk::DeviceInfo> devices = instance.devices();
        const vk::Device device(instance, vk::select_device(devices, {}));
        Renderer r(device, build_gpu_scene(scene), scene.cameras[0], settings_for(37, 23));
        EXPECT_TRUE(r.render(16, [](double) { return true; }));
        unsetenv("LP_NUM_THREADS");
        return r.download();
    };
    const Accumulation preferred = render_with_threads(nullptr);
    for (const char* threads : {"1", "2"}) {
        SCOPED_TRACE(threads);
        const Accumulation state = render_with_threads(threads);
        EXPECT_EQ(std::memcmp(state.values.data(), preferred.values.data(),
                              preferred.values.size() * sizeof(float)),
                  0);
    }
}

}  // namespace
}  // namespace candela
