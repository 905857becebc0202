// The rays of the benchmark: where they start and where they go. They are traced by testing every triangle.
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "bench/rays.h"
#include "probe/scenes.h"

namespace candela {
namespace {

// Distance along the ray at which it hits the triangle, in double precision; infinite if it misses.
// Ref: Moeller and Trumbore 1997, Fast, Minimum Storage Ray/Triangle Intersection.
double distance_to(const BenchRay& ray, const BenchTriangle& triangle) {
    const dvec3 e1 = dvec3(triangle.b) - dvec3(triangle.a), e2 = dvec3(triangle.c) - dvec3(triangle.a);
    const dvec3 from = dvec3(ray.o) - dvec3(triangle.a);
    const dvec3 p = cross(dvec3(ray.d), e2), q = cross(from, e1);
    const double determinant = dot(e1, p);
    const double u = dot(from, p) / determinant, v = dot(dvec3(ray.d), q) / determinant;
    const double t = dot(e2, q) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? t : double(INFINITE);
}

// The Cornell box, 32x32 camera rays and what follows from them. Every other triangle is turned round, so
// that rays hit backs too.
class BenchRays : public testing::Test {
  protected:
    BenchRays() {
        for (size_t i = 0; i < triangles_.size(); i += 2)
            std::swap(triangles_[i].b, triangles_[i].c);
        const auto triangle = [this](uint32_t id) { return triangles_.at(id); };
        sets_ =
            make_ray_sets(scene_, triangle, BenchTriangles(gpu_).bounds(), 1000, [this](const RaySet& set) {
                std::vector<uint32_t> ids;
                for (const BenchRay& ray : set.rays)
                    ids.push_back(closest(ray));
                hits_.push_back(ids);
                return ids;
            });
    }

    uint32_t closest(const BenchRay& ray) const {
        uint32_t id = NO_TRIANGLE;
        double nearest = double(ray.t_max);
        for (uint32_t i = 0; i < triangles_.size(); ++i) {
            const double t = distance_to(ray, triangles_[i]);
            if (t >= nearest) continue;
            nearest = t;
            id = i;
        }
        return id;
    }

    // The rays of a set that hit something, and the unit normals there on the rays' side.
    std::vector<std::pair<BenchRay, dvec3>> hits_of(size_t set) const {
        std::vector<std::pair<BenchRay, dvec3>> result;
        for (size_t i = 0; i < hits_[set].size(); ++i) {
            if (hits_[set][i] == NO_TRIANGLE) continue;
            const BenchTriangle& t = triangles_[hits_[set][i]];
            const dvec3 n = normalize(cross(dvec3(t.b) - dvec3(t.a), dvec3(t.c) - dvec3(t.a)));
            const BenchRay& ray = sets_[set].rays[i];
            result.emplace_back(ray, dot(n, dvec3(ray.d)) > 0 ? -n : n);
        }
        return result;
    }

    const Scene scene_ = cornell_box();
    const GpuScene gpu_ = build_gpu_scene(scene_, SceneFrame{});
    std::vector<BenchTriangle> triangles_ = BenchTriangles(gpu_).baked();
    std::vector<std::vector<uint32_t>> hits_;  // Hits of the first two sets.
    std::vector<RaySet> sets_;
};

TEST_F(BenchRays, SetsFollowFromEachOther) {
    ASSERT_EQ(sets_.size(), 4u);
    EXPECT_EQ(sets_[0].name, "primary rays");
    EXPECT_EQ(sets_[0].rays.size(), 1024u);  // 4x4 tiles are the fewest that hold 1000 pixels.
    EXPECT_EQ(sets_[1].rays.size(), hits_of(0).size());
    EXPECT_EQ(sets_[2].rays.size(), hits_of(1).size());
    EXPECT_EQ(sets_[3].rays.size(), hits_of(0).size());
    for (const RaySet& set : sets_) {
        EXPECT_EQ(set.any_hit, set.name == "shadow rays");
        EXPECT_EQ(set.coherent, set.name == "primary rays");
    }
}

// Ray i goes through its pixel: that of tile i / 64, and i % 64 in the tile, both row by row. The film of the
// Cornell box is 25 mm wide behind 35 mm, the camera looks along +z, and x runs to the left.
TEST_F(BenchRays, PrimaryRaysGoThroughTheirPixelsInTiles) {
    for (size_t i = 0; i < 1024; ++i) {
        const BenchRay& ray = sets_[0].rays[i];
        const dvec3 d = dvec3(ray.d) / double(ray.d.z);
        const double x = (0.5 - d.x * 35.0 / 25.0) * 32.0, y = (0.5 - d.y * 35.0 / 25.0) * 32.0;
        const size_t tile = i / 64, column = tile % 4 * 8 + i % 8, row = tile / 4 * 8 + i / 8 % 8;
        // Directions have rounding errors of a few 2^-24, pixels a size of 2^-5.
        EXPECT_NEAR(x, double(column) + 0.5, 0.5 + 1e-4) << i;
        EXPECT_NEAR(y, double(row) + 0.5, 0.5 + 1e-4) << i;
        EXPECT_EQ(ray.o, vec3(scene_.cameras.front().position));
        EXPECT_EQ(ray.t_max, INFINITE);
    }
}

// The origin lies on the previous ray, 1e-5 of the scene's extent (0.56 m) above the surface; coordinates are
// rounded to 2^-25 m.
TEST_F(BenchRays, BouncesStartJustAboveTheSurfaceThatWasHit) {
    for (const size_t set : {0u, 1u}) {
        const auto before = hits_of(set);
        for (size_t i = 0; i < before.size(); ++i) {
            const auto& [ray, n] = before[i];
            const BenchRay& bounce = sets_[set + 1].rays[i];
            const dvec3 way = dvec3(bounce.o) - 0.56e-5 * n - dvec3(ray.o);
            EXPECT_NEAR(length(cross(way, dvec3(ray.d))), 0.0, 2e-7);
            EXPECT_GE(dot(dvec3(bounce.d), n), 0.0);
            EXPECT_NEAR(length(dvec3(bounce.d)), 1.0, 2e-7);
            if (set == 0) {
                EXPECT_EQ(sets_[3].rays[i].o, bounce.o);
            }
        }
    }
}

// Where directions follow the cosine, cos^2 is uniform in [0, 1]. Its mean over both bounces, of mean 1/2 and
// variance 1/12, is off by five standard deviations with a probability of 6e-7.
TEST_F(BenchRays, BouncesFollowTheCosine) {
    double sum = 0.0, count = 0.0;
    for (const size_t set : {0u, 1u}) {
        const auto before = hits_of(set);
        for (size_t i = 0; i < before.size(); ++i) {
            const double cosine = dot(dvec3(sets_[set + 1].rays[i].d), before[i].second);
            sum += cosine * cosine;
            count += 1.0;
        }
    }
    EXPECT_NEAR(sum / count, 0.5, 5.0 * std::sqrt(1.0 / 12.0 / count));
}

// The light is the rectangle [0.213, 0.343] x {0.5485} x [0.227, 0.332]; rays end a thousandth before it.
TEST_F(BenchRays, ShadowRaysEndJustBeforeThePointsOfTheLight) {
    for (const BenchRay& ray : sets_[3].rays) {
        const vec3 end = ray.o + ray.t_max / 0.999f * ray.d;
        EXPECT_NEAR(end.y, 0.5485f, 1e-6f);
        EXPECT_NEAR(end.x, 0.278f, 0.065f + 1e-6f);
        EXPECT_NEAR(end.z, 0.2795f, 0.0525f + 1e-6f);
    }
}

}  // namespace
}  // namespace candela
