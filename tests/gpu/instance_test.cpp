// Instances: rays in the spaces of their meshes meet what they would meet of baked copies, in any order, and
// none meets the surface that it leaves.
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "gpu/device_fixture.h"
#include "probe/random.h"
#include "scene/mesh.h"
#include "selftest/traversal.h"
#include "support/scene_builders.h"

namespace candela {
namespace {

// Every mesh gets a tree of its own, or none.
constexpr InstancingRule ALL{.min_uses = 1, .min_triangles = 1};
constexpr InstancingRule NONE{.min_uses = ~0u, .min_triangles = ~0u};

// A transform that turns, scales by `scale`, shears, and moves.
Transform transform_of(Random& random, dvec3 scale, double shear, dvec3 shift) {
    const dvec3 axis(random.direction());
    Transform transform;
    glm::dmat4 sheared(1.0);
    sheared[1][0] = shear;
    transform.append(sheared);
    transform.append(glm::scale(glm::dmat4(1.0), scale));
    transform.append(glm::rotate(glm::dmat4(1.0), 6.3 * double(random.unit()), axis));
    transform.append(glm::translate(glm::dmat4(1.0), shift));
    return transform;
}

struct NamedTransform {
    const char* name;
    Transform transform;
};

// Sizes from 10^-3 to 10^3, mirrored, uneven, sheared, and far from the origin.
std::vector<NamedTransform> transforms() {
    Random random(11);
    return {{"turned", transform_of(random, dvec3(1), 0, dvec3(0))},
            {"small", transform_of(random, dvec3(1e-3), 0, dvec3(0.2, 0.1, -0.3))},
            {"large", transform_of(random, dvec3(1e3), 0, dvec3(20, 0, 0))},
            {"mirrored", transform_of(random, dvec3(-1, 1, 1), 0, dvec3(0.1))},
            {"flat", transform_of(random, dvec3(1, 1e-3, 1), 0, dvec3(0))},
            {"long", transform_of(random, dvec3(1, 1, 1e3), 0, dvec3(3))},
            {"sheared", transform_of(random, dvec3(1, 2, 1), 1.5, dvec3(1, 2, 3))},
            {"small, mirrored and sheared", transform_of(random, dvec3(1e-3, -2e-3, 1e-3), 1, dvec3(1))},
            {"far away", transform_of(random, dvec3(1), 0, dvec3(1e4, -2e4, 3e4))}};
}

// A scene of instances of one mesh.
Scene scene_of(const TriangleMesh& mesh, const std::vector<Transform>& places) {
    Scene scene = scene_of_mesh(mesh);
    scene.shapes.clear();
    for (const Transform& transform : places)
        scene.shapes.push_back({.geometry = MeshInstance{0, transform}, .material = 0, .emission = {}});
    return scene;
}

// Whether a point is inside a convex mesh.
bool is_within(const TriangleMesh& mesh, dvec3 p) {
    return std::ranges::all_of(mesh.triangles, [&](uvec3 t) {
        const dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        return dot(cross(b - a, c - a), p - a) < 0.0;
    });
}

// Boxes that all rays meet: traversal then tests every leaf of every instance.
void open_all_boxes(GpuScene& scene) {
    std::vector<uvec4> words = scene.arrays[ARRAY_NODES];
    for (size_t i = 0; i < words.size(); i += BVH_NODE_WORDS) {
        PackedBvhNode packed;
        std::copy_n(words.begin() + std::ptrdiff_t(i), BVH_NODE_WORDS, packed.begin());
        BvhNode node = unpack(packed);
        if (is_instance(node)) continue;
        node.origin = vec3(-0x1p40f);
        node.scale = vec3(0x1p33f);
        for (uvec3& q : node.q_lo)
            q = uvec3(0);
        for (uvec3& q : node.q_hi)
            q = uvec3(0xFFFFFFFFu);
        std::ranges::copy(pack(node), words.begin() + std::ptrdiff_t(i));
    }
    scene.arrays[ARRAY_NODES] = std::move(words);
}

// Puts nodes that nothing refers to between the top tree and that of the only mesh, so that its root is
// `root`.
void push_mesh_back(GpuScene& scene, uint32_t root) {
    std::vector<uvec4> words = scene.arrays[ARRAY_NODES];
    const uint32_t first = instance_at(scene, scene.instances.at(0)).root, count = root - first;
    for (const InstancePlace& place : scene.instances)
        words[size_t{place.node} * BVH_NODE_WORDS].w += count << 8u;
    const auto begin = words.begin() + std::ptrdiff_t(first * BVH_NODE_WORDS);
    for (auto i = begin; i != words.end(); i += BVH_NODE_WORDS) {
        PackedBvhNode packed;
        std::copy_n(i, BVH_NODE_WORDS, packed.begin());
        BvhNode node = unpack(packed);
        node.children.x += count;
        std::ranges::copy(pack(node), i);
    }
    words.insert(begin, size_t{count} * BVH_NODE_WORDS, uvec4(~0u));
    scene.arrays[ARRAY_NODES] = std::move(words);
}

class InstanceTest : public DeviceTest {
  protected:
    std::vector<InteractionResult> interactions(const GpuScene& scene,
                                                const std::vector<InteractionItem>& items) const {
        const DeviceScene on_device(device(), scene, SceneAccess::automatic);
        return map<InteractionResult>(kernels::interaction, items, traversal_constants(scene), &on_device);
    }
};

// Rays from a cube of half edge `reach` around the frame's origin; the second one leaves on the side of the
// viewer or on the other.
std::vector<InteractionItem> items_in_frame(size_t count, float reach, uint32_t seed) {
    Random random(seed);
    std::vector<InteractionItem> items(count);
    for (size_t i = 0; i < count; ++i) {
        items[i].o = reach * random.cube();
        items[i].d = random.direction();
        items[i].wi = random.direction();
        items[i].side = uint32_t(i % 2);
    }
    return items;
}

std::vector<Transform> forest(uint32_t count, double size) {
    Random random(5);
    std::vector<Transform> places;
    for (uint32_t i = 0; i < count; ++i) {
        const double scale = size * std::exp2(4.0 * double(random.unit()) - 2.0);
        const vec3 at = random.cube();
        places.push_back(transform_of(random, scale * dvec3(i % 3 == 0 ? -1 : 1, 1, 1),
                                      i % 5 == 0 ? 1.0 : 0.0, dvec3(at)));
    }
    places.push_back(places.back());  // Twice at one place: every hit is a tie.
    return places;
}

// What a ray hits must not depend on which boxes cull what.
TEST_F(InstanceTest, TheNearestHitIsThatOfAllLeaves) {
    for (const auto& [mesh, size] :
         {std::pair(sphere_mesh(6, 8), 0.2), std::pair(triangle_soup(60, 0.3f, 3), 0.3),
          std::pair(nasty_mesh(80), 1e-3)}) {
        GpuScene scene = build_gpu_scene(scene_of(mesh, forest(60, size)), SceneFrame{}, ALL);
        ASSERT_EQ(scene.instances.size(), 61u);
        std::vector<InteractionItem> items = items_in_frame(sized(test_effort(), 20'000), 1.2f, 7);
        for (size_t i = 0; i < items.size(); i += 8)
            items[i].o *= 1000.0f;  // From far outside, towards the scene.
        for (size_t i = 0; i < items.size(); i += 8)
            items[i].d = normalize(0.5f * items[i].d - items[i].o);
        const std::vector<InteractionResult> found = interactions(scene, items);
        open_all_boxes(scene);
        const std::vector<InteractionResult> expected = interactions(scene, items);
        size_t hits = 0;
        for (size_t i = 0; i < items.size(); ++i) {
            hits += expected[i].t < NO_HIT;
            ASSERT_EQ(found[i].t, expected[i].t) << i;
            ASSERT_EQ(found[i].id, expected[i].id) << i;
            ASSERT_EQ(found[i].next_t, expected[i].next_t) << i;
        }
        EXPECT_GT(hits, items.size() / 20);
    }
}

TEST_F(InstanceTest, BakedCopiesHaveTheSameHits) {
    const TriangleMesh mesh = sphere_mesh(12, 16);
    const Scene scene = scene_of(mesh, forest(60, 0.2));
    const std::vector<InteractionItem> items = items_in_frame(sized(test_effort(), 100'000), 1.2f, 8);
    const std::vector<InteractionResult> instanced =
        interactions(build_gpu_scene(scene, SceneFrame{}, ALL), items);
    const std::vector<InteractionResult> baked =
        interactions(build_gpu_scene(scene, SceneFrame{}, NONE), items);
    size_t others = 0, hits = 0;
    for (size_t i = 0; i < items.size(); ++i) {
        // A ray along an edge, or one that meets the two copies at one place.
        if (instanced[i].id != baked[i].id || (instanced[i].t < NO_HIT) != (baked[i].t < NO_HIT)) {
            ++others;
            continue;
        }
        if (baked[i].t == NO_HIT) continue;
        ++hits;
        // Rounding of floats around 1; a grazing ray hits a surface that lies off by that much later.
        const float cosine = std::abs(dot(baked[i].n, items[i].d));
        ASSERT_NEAR(instanced[i].t, baked[i].t, 2e-6f / cosine) << i;
        ASSERT_LT(length(instanced[i].p - baked[i].p), 2e-6f / cosine) << i;
        ASSERT_LT(length(instanced[i].n - baked[i].n), 1e-4f) << i;
        ASSERT_EQ(instanced[i].front, baked[i].front) << i;
    }
    EXPECT_GT(hits, items.size() / 4);
    EXPECT_LT(others, items.size() / 500);
}

// Nodes of meshes may have any index.
TEST_F(InstanceTest, AMeshMayLieBehindManyNodes) {
    GpuScene scene = build_gpu_scene(scene_of(sphere_mesh(6, 8), forest(60, 0.2)), SceneFrame{}, ALL);
    const std::vector<InteractionItem> items = items_in_frame(sized(test_effort(), 20'000), 1.2f, 7);
    const std::vector<InteractionResult> expected = interactions(scene, items);
    push_mesh_back(scene, 1u << 19);
    const std::vector<InteractionResult> found = interactions(scene, items);
    for (size_t i = 0; i < items.size(); ++i) {
        ASSERT_EQ(found[i].t, expected[i].t) << i;
        ASSERT_EQ(found[i].id, expected[i].id) << i;
        ASSERT_EQ(found[i].next_t, expected[i].next_t) << i;
    }
}

// Rays begin as near to a small body as its own size and place in the scene allow, not those of its mesh: 256
// roundings of its size, which is a thousandth.
TEST_F(InstanceTest, OffsetsShrinkWithTheBody) {
    Random random(4);
    const Transform small = transform_of(random, dvec3(1e-3), 0, dvec3(0));
    const GpuScene scene = build_gpu_scene(scene_of(sphere_mesh(12, 16), {small}), SceneFrame{}, ALL);
    for (const InteractionResult& r : interactions(scene, items_in_frame(1000, 2e-4f, 3))) {
        ASSERT_LT(r.t, NO_HIT);
        ASSERT_LE(r.p_error, 256 * 0x1p-24f * 1e-3f);
        ASSERT_GT(r.p_error, 0.0f);
    }
}

// A ray that leaves a convex body outwards hits nothing, and one that goes in hits its other side.
TEST_F(InstanceTest, RaysLeaveTheSurfaceThatTheyBeginOn) {
    const TriangleMesh mesh = sphere_mesh(24, 32);
    for (const auto& [name, transform] : transforms()) {
        SCOPED_TRACE(name);
        const Scene scene = scene_of(mesh, {transform});
        const GpuScene gpu = build_gpu_scene(scene, choose_frame(scene), ALL);
        ASSERT_EQ(gpu.instances.size(), 1u);
        size_t slips = 0;
        // From within the body towards all of its surface.
        Random random(9);
        std::vector<InteractionItem> items(sized(test_effort(), 40'000));
        for (size_t i = 0; i < items.size(); ++i) {
            const uvec3 t = mesh.triangles[random.bits() % mesh.triangles.size()];
            const vec2 b = 0.5f * random.square();
            const vec3 to = mesh.positions[t.x] + b.x * (mesh.positions[t.y] - mesh.positions[t.x]) +
                            b.y * (mesh.positions[t.z] - mesh.positions[t.x]);
            const vec3 from = 0.3f * random.direction();
            items[i].o = gpu.frame.point(transform.point(dvec3(from)));
            items[i].d = normalize(gpu.frame.point(transform.point(dvec3(to))) - items[i].o);
            items[i].wi = random.direction();
            items[i].side = uint32_t(i % 2);
        }
        const glm::dmat4 to_mesh = inverse(transform.matrix());
        for (const InteractionResult& r : interactions(gpu, items)) {
            ASSERT_LT(r.t, NO_HIT) << "a ray from within misses";
            ASSERT_EQ(r.front, 0u);
            const bool outside = dot(r.next_d, r.n) < 0.0f;  // The viewer is within.
            if (outside) {
                ASSERT_EQ(r.next_t, NO_HIT) << "met again where it began, or on the way out";
            } else {
                // Where the body is thinner than the ray's offset, it begins on the other side.
                const bool began_within =
                    is_within(mesh, dvec3(to_mesh * glm::dvec4(gpu.frame.world(r.next_o), 1.0)));
                slips += r.next_t == NO_HIT && !began_within;
                ASSERT_TRUE(r.next_t < NO_HIT || !began_within) << "slipped out";
            }
        }
        const double max = double(items.size()) / 1000;  // By chance, a few more.
        EXPECT_LE(double(slips), max + 4 * std::sqrt(max));
    }
}

}  // namespace
}  // namespace candela
