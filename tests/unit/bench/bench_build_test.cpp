// The benchmark of building trees: its figures, and that the rival's tree is one.
#include <gtest/gtest.h>

#include "bench/build.h"
#include "bench/tracer.h"
#include "unit/bvh/bvh_boxes.h"

namespace candela {
namespace {

TEST(BenchBuild, MeasuresSpeedCostAndBytesOfEveryMesh) {
    BenchOptions options;
    options.runs = 2;
    options.triangles = {72, 300};
    std::vector<std::string> subjects;
    options.progress = [&](const std::string& text) { subjects.push_back(text); };
    const std::vector<Row> rows = bench_build(options);
    EXPECT_EQ(subjects, (std::vector<std::string>{"build: 72 triangles", "build: 252 triangles"}));
    ASSERT_EQ(rows.size(), 8u);
    EXPECT_EQ(rows[0].unit, "Mtri/s");
    EXPECT_EQ(rows[0].ours.size(), 2u);
    EXPECT_EQ(rows[0].ours_wall.size(), 2u);
    EXPECT_GT(rows[1].ours[0], rows[0].ours[0]);  // Without pairing.
    EXPECT_GT(rows[2].ours[0], 1.0);              // A ray through the bounds hits at least the root.
    // A pair is 48 bytes, its surface and its normals 16 each, and a node has at most seven leaves of one.
    EXPECT_GT(rows[3].ours[0], (48.0 + 16.0 + 16.0 + 64.0 / 7.0) / 2.0);
    EXPECT_EQ(rows[0].rival.size(), embree_version() ? 2u : 0u);
}

// The rival's trees order primitives otherwise, and a single leaf is one, too. Their depth has no limit, but
// stays below ours here.
TEST(BenchBuild, TheRivalsTreeHoldsAllPrimitives) {
    for (const size_t count : {1, 2, 3, 20, 5000}) {
        const std::vector<Box> boxes = random_boxes(count, 0.1f, uint32_t(count));
        const auto built = build_with_embree(boxes);
        ASSERT_EQ(built.has_value(), embree_version().has_value());
        if (built) {
            EXPECT_EQ(validate(built->bvh, boxes), std::nullopt);
        }
    }
}

}  // namespace
}  // namespace candela
