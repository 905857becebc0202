// A ray that leaves a surface does not hit it again: offset_origin against the renderer's own triangle test.
#include <cmath>

#include "gpu/device_fixture.h"
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
    float unused0;
    vec3 direction;
    float unused1;
};

struct SpawnResult {
    float t;
    vec3 o;
    vec3 n;
};

class SpawnTest : public DeviceTest {
  protected:
    // Triangles of about that size around the origin, rays from any point of each; `grazing`: nearly within
    // its plane.
    static std::vector<SpawnItem> items(float scale, bool grazing, size_t count, uint32_t seed) {
        Random random(seed);
        std::vector<SpawnItem> items(count);
        for (SpawnItem& item : items) {
            const vec3 centre = random.cube();
            item.v0 = scale * (centre + random.cube());
            item.v1 = scale * (centre + random.cube());
            item.v2 = scale * (centre + random.cube());
            const vec2 u = random.square();
            item.b1 = std::min(u.x, u.y);
            item.b2 = std::max(u.x, u.y) - item.b1;
            item.direction = random.direction();
            if (grazing) {
                const vec3 n = normalize(cross(item.v1 - item.v0, item.v2 - item.v0));
                const vec3 in_plane = item.direction - dot(item.direction, n) * n;
                item.direction = normalize(normalize(in_plane) + 1e-3f * random.unit() * n);
            }
        }
        return items;
    }
};

TEST_F(SpawnTest, ASpawnedRayMissesItsOwnTriangle) {
    uint32_t seed = 30;
    for (const float scale : {1e-3f, 1e-2f, 1e-1f, 1.0f, 1e1f, 1e2f, 1e3f, 1e4f, 1e5f, 1e6f}) {
        for (const bool grazing : {false, true}) {
            const std::vector<SpawnResult> results =
                map<SpawnResult>(kernels::spawn, items(scale, grazing, 10000, seed++));
            const auto again =
                std::count_if(results.begin(), results.end(), [](const auto& r) { return r.t > 0.0f; });
            EXPECT_EQ(again, 0) << "of 10000 at scale " << scale << (grazing ? ", grazing" : "");
        }
    }
}

// The step is small: 256 representable numbers along the normal, or 2^-16 m within 2^-5 m of a coordinate
// plane.
TEST_F(SpawnTest, TheOriginStaysOnTheSurface) {
    for (const float scale : {1e-3f, 1.0f, 1e3f, 1e6f}) {
        const std::vector<SpawnItem> spawned = items(scale, false, 10000, 50);
        const std::vector<SpawnResult> results = map<SpawnResult>(kernels::spawn, spawned);
        for (size_t i = 0; i < spawned.size(); ++i) {
            const SpawnItem& s = spawned[i];
            const glm::dvec3 v0(s.v0), v1(s.v1), v2(s.v2);
            const glm::dvec3 p(v0 + double(s.b1) * (v1 - v0) + double(s.b2) * (v2 - v0));
            for (const int axis : {0, 1, 2}) {
                // Representable numbers are at most 2^-23 of |p| apart, or one octave more where p crosses
                // one. p itself was rounded: 5 times 2^-24 of the largest vertex.
                const double rounding = 5 * 0x1p-24 * 2.0 * double(scale);
                const double step = std::max(257.0 * 0x1p-22 * (std::abs(p[axis]) + rounding), 0x1p-16);
                ASSERT_NEAR(results[i].o[axis], p[axis], step + rounding);
            }
            ASSERT_GE(dot(glm::dvec3(results[i].o) - p, glm::dvec3(results[i].n)), 0.0)
                << "on the wrong side";
        }
    }
}

}  // namespace
}  // namespace candela
