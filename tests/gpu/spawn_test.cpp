// A ray that leaves a surface does not hit it again: triangle_error() against the shaders' own triangle test.
#include <cmath>

#include "gpu/device_fixture.h"
#include "gpu_scene/ray_error.h"
#include "probe/random.h"
#include "shared/primitive.h"

namespace candela {
namespace {

struct SpawnItem {
    vec3 v0;
    float b1;
    vec3 v1;
    float b2;
    vec3 v2;
    float error;
    vec3 direction;
    float unused1;
};

struct SpawnResult {
    float t;
    vec3 o;
    vec3 n;
};

// How a set of triangles is made: of about `scale`, around a point `distance` times as far from the origin,
// so many times longer than wide, or in a plane across an axis.
struct Triangles {
    float scale = 1.0f;
    float distance = 1.0f;
    float aspect = 1.0f;
    bool level = false;
};

class SpawnTest : public DeviceTest {
  protected:
    // Rays from any point of each triangle, every other one nearly within its plane.
    static std::vector<SpawnItem> items(const Triangles& triangles, size_t count, uint32_t seed) {
        Random random(seed);
        std::vector<SpawnItem> items(count);
        for (size_t i = 0; i < count; ++i) {
            SpawnItem& item = items[i];
            const vec3 centre = triangles.distance * random.cube();
            vec3 along = random.direction(), across = random.direction() / triangles.aspect;
            if (triangles.level) along[int(i % 3)] = across[int(i % 3)] = 0.0f;
            item.v0 = triangles.scale * centre;
            item.v1 = triangles.scale * (centre + along);
            item.v2 = triangles.scale * (centre + random.unit() * along + across);
            item.error = float(triangle_error(item.v0, item.v1, item.v2));
            const vec2 u = random.square();
            item.b1 = std::min(u.x, u.y);
            item.b2 = std::max(u.x, u.y) - item.b1;
            if (i % 4 == 0) item.b1 = 0.0f;  // A point of an edge.
            item.direction = random.direction();
            if (i % 2 == 1) {
                const vec3 n = normalize(cross(item.v1 - item.v0, item.v2 - item.v0));
                const vec3 in_plane = item.direction - dot(item.direction, n) * n;
                item.direction = normalize(normalize(in_plane) + std::pow(10.0f, -6.0f * random.unit()) * n);
            }
        }
        return items;
    }

    size_t met_again(const Triangles& triangles, size_t count, uint32_t seed) const {
        const std::vector<SpawnResult> results =
            map<SpawnResult>(kernels::spawn, items(triangles, count, seed));
        return size_t(std::ranges::count_if(results, [](const auto& r) { return r.t > 0.0f; }));
    }
};

TEST_F(SpawnTest, ASpawnedRayMissesItsOwnTriangle) {
    uint32_t seed = 30;
    const size_t count = sized(test_effort(), 40000);
    for (const float scale : {1e-6f, 1e-3f, 1.0f, 1e3f, 1e6f}) {
        for (const float distance : {0.0f, 1.0f, 100.0f, 1e4f}) {
            EXPECT_EQ(met_again({scale, distance, 1.0f, false}, count, seed++), 0u)
                << scale << ' ' << distance;
            EXPECT_EQ(met_again({scale, distance, 20.0f, false}, count, seed++), 0u)
                << scale << ' ' << distance;
            EXPECT_EQ(met_again({scale, distance, 500.0f, false}, count, seed++), 0u)
                << scale << ' ' << distance;
            EXPECT_EQ(met_again({scale, distance, 3.0f, true}, count, seed++), 0u)
                << scale << ' ' << distance;
        }
    }
}

// The error of slivers is limited: a few of their rays hit them again.
TEST_F(SpawnTest, ASpawnedRayHardlyEverHitsItsOwnSliver) {
    for (const float aspect : {1e3f, 1e5f})
        EXPECT_LT(met_again({1.0f, 1.0f, aspect, false}, 40000, 90), 40u) << aspect;
}

// Rays begin on the right side, and no further from the surface than the error says; on a level triangle, by
// roundings of one coordinate alone.
TEST_F(SpawnTest, TheOriginStaysOnTheSurface) {
    for (const float scale : {1e-3f, 1.0f, 1e3f, 1e6f}) {
        for (const bool level : {false, true}) {
            const std::vector<SpawnItem> spawned = items({scale, 1.0f, 1.0f, level}, 10000, 50);
            const std::vector<SpawnResult> results = map<SpawnResult>(kernels::spawn, spawned);
            for (size_t i = 0; i < spawned.size(); ++i) {
                const SpawnItem& s = spawned[i];
                const dvec3 v0(s.v0), v1(s.v1), v2(s.v2), o(results[i].o), n(results[i].n);
                const dvec3 exact = normalize(cross(v1 - v0, v2 - v0));
                const double height = dot(o - v0, dot(exact, n) < 0.0 ? -exact : exact);
                ASSERT_GE(height, 0.0) << "on the wrong side";
                ASSERT_LE(height, 2.0 * double(s.error));
                if (level) {
                    const auto axis = glm::length_t(i % 3);
                    ASSERT_LE(std::abs(o[axis] - v0[axis]), 0x1p-19 * std::abs(v0[axis]));
                }
            }
        }
    }
}

}  // namespace
}  // namespace candela
