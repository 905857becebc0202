// What the benchmarks compute: statistics, tables, the relative error, meshes, rays.
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "bench/meshes.h"
#include "bench/render.h"
#include "bench/report.h"
#include "bench/traversal.h"
#include "bench/triangles.h"
#include "cli/bench_report.h"
#include "image/relative_error.h"
#include "probe/scenes.h"
#include "scene/geometry.h"
#include "unit/base/base_fixture.h"

namespace candela {
namespace {

TEST(BenchReport, AMedianIsTheMiddleValueOrTheMeanOfTheTwo) {
    const Spread odd = spread(std::vector<double>{3.0, 9.0, 1.0});
    EXPECT_EQ(odd.median, 3.0);
    EXPECT_EQ(odd.min, 1.0);
    EXPECT_EQ(odd.largest, 9.0);
    EXPECT_EQ(spread(std::vector<double>{8.0, 1.0, 2.0, 4.0}).median, 3.0);
    EXPECT_EQ(spread(std::vector<double>{5.0}).median, 5.0);
}

// The ratios are 1, 2 and 0.1; that of the medians would be 10 / 5.
TEST(BenchReport, ARatioIsTheMedianOverPairsOfRuns) {
    const Row row{.ours = {1.0, 10.0, 100.0}, .rival = {1.0, 5.0, 1000.0}};
    EXPECT_EQ(ratio(row), 1.0);
    EXPECT_EQ(ratio(Row{.ours = {1.0}}), std::nullopt);
}

TEST(BenchReport, TheTableHasALinePerFigureUnderItsSubject) {
    const BenchTable table{"traversal",
                           {{.subject = "box",
                             .what = "primary rays",
                             .unit = "Mrays/s",
                             .ours = {20.0, 21.25, 30.0},
                             .rival = {40.0, 42.5, 41.0},
                             .ours_wall = {10.0, 11.0, 12.0},
                             .rival_wall = {35.0, 36.0, 37.0}},
                            {.subject = "box", .what = "others", .ours = {0.0}}}};
    // The leading line feed aligns the columns here.
    EXPECT_EQ('\n' + table_text(table), R"(
traversal                            candela                   wall     Embree                    wall     ratio
box
  primary rays           Mrays/s     21.25 (20 .. 30)          11       41 (40 .. 42.5)           36       0.5
  others                             0
)");
}

TEST(BenchReport, TheTableOfOursAloneHasNoColumnsOfARival) {
    const BenchTable table{"render",
                           {{.subject = "a.json", .what = "samples", .unit = "M/s", .ours = {1.5}}}};
    EXPECT_EQ('\n' + table_text(table), R"(
render                               candela                   wall
a.json
  samples                M/s         1.5
)");
}

TEST(BenchReport, JsonHasEveryRun) {
    const BenchTable table{"build",
                           {{.subject = "s",
                             .what = "w",
                             .unit = "u",
                             .ours = {1.0, 3.0},
                             .rival = {2.0, 2.0},
                             .ours_wall = {4.0, 5.0}},
                            {.subject = "s", .what = "x", .ours = {7.0}}}};
    EXPECT_EQ(to_json(table), nlohmann::ordered_json::parse(R"({"group": "build", "rows": [
        {"subject": "s", "what": "w", "unit": "u", "candela": {"runs": [1.0, 3.0], "wall": [4.0, 5.0]},
         "embree": {"runs": [2.0, 2.0], "wall": null}, "ratio": 1.0},
        {"subject": "s", "what": "x", "unit": "", "candela": {"runs": [7.0], "wall": null},
         "embree": null, "ratio": null}]})"));
}

// For a reference r that is the same everywhere, m is r: an image that is off by the share e everywhere has
// the error e^2 r^2 / (r^2 + 0.01 r^2), for any r.
TEST(BenchRender, RelativeErrorOfAConstantImageHasAClosedForm) {
    for (const float r : {0.01f, 1.0f, 500.0f}) {
        const std::vector<float> reference(20, r), image(20, 1.25f * r);
        // Squares and sums of floats in double precision: a relative error of some 2^-24 per factor.
        EXPECT_NEAR(relative_mse({image, image, image}, {reference, reference, reference}), 0.0625 / 1.01,
                    1e-7);
    }
}

// The mean of all six values is 1. Terms: (1 - 0)^2 / (0 + 0.01), (4 - 3)^2 / (9 + 0.01), and four times 0.
TEST(BenchRender, RelativeErrorWeighsEveryPixelByItsOwnReference) {
    const std::vector<float> r{0, 3}, x{1, 4}, same{1, 0.5f};
    EXPECT_NEAR(relative_mse({x, same, same}, {r, same, same}), (1 / 0.01 + 1 / 9.01) / 6, 1e-12);
}

// Takes `cpu` and `wall` seconds for each repeat, and logs what it was asked to do.
class ToyTracer : public RayTracer {
  public:
    ToyTracer(char name, Clocks clocks, std::string& log) : name_(name), clocks_(clocks), log_(&log) {}
    void prepare(const RaySet&) override { *log_ += name_; }
    Clocks trace(uint32_t repeats) override {
        *log_ += name_ + std::to_string(repeats) + ' ';
        return {clocks_.cpu * repeats, clocks_.wall * repeats};
    }
    std::vector<uint32_t> results() const override { return {}; }

  private:
    char name_;
    Clocks clocks_;
    std::string* log_;
};

// 1000 rays take 4 ms of CPU time and 3 ms of wall time, of which 0.1 s is 34 repeats; the rival takes 50 ms,
// so that two suffice.
TEST(BenchTraversal, SpeedsAreRaysOverTimeAndTheTwoTakeTurns) {
    std::string log;
    ToyTracer ours('o', {.cpu = 0.004, .wall = 0.003}, log), rival('r', {.cpu = 0.1, .wall = 0.05}, log);
    const RaySet set{.name = "first bounce", .rays = std::vector<BenchRay>(1000)};
    const Row row = time_rays("box", set, ours, &rival, 2, true);
    EXPECT_EQ(log, "oo1 o1 rr1 r1 o34 r2 o34 r2 ");
    EXPECT_EQ(row.subject, "box");
    EXPECT_EQ(row.what, "first bounce");
    EXPECT_EQ(row.unit, "Mrays/s");
    const auto expect = [](const std::vector<double>& values, double speed) {
        ASSERT_EQ(values.size(), 2u);
        for (const double value : values)
            EXPECT_NEAR(value, speed, 1e-12);
    };
    expect(row.ours, 0.25 * cores());
    expect(row.ours_wall, 1.0 / 3.0);
    expect(row.rival, 0.01 * cores());
    expect(row.rival_wall, 0.02);

    const Row on_gpu = time_rays("box", set, ours, nullptr, 2, false);
    expect(on_gpu.ours, 1.0 / 3.0);
    EXPECT_TRUE(on_gpu.ours_wall.empty());
    EXPECT_TRUE(on_gpu.rival.empty());
}

TEST(BenchTraversal, TracersThatDisagreeAreAnError) {
    EXPECT_NO_THROW(check_same_hits("box, primary rays", 1, 64));
    EXPECT_NO_THROW(check_same_hits("box, primary rays", 2, 1000));
    EXPECT_EQ(error_of([] { check_same_hits("box, primary rays", 3, 1000); }),
              "box, primary rays: 3 of 1000 rays hit something else than in Embree, so the speeds cannot be "
              "compared; run `candela selftest` on this device");
}

TEST(BenchMeshes, NumbersOfTrianglesHaveThreeDigits) {
    EXPECT_EQ(triangles_text(72), "72 triangles");
    EXPECT_EQ(triangles_text(188172), "188 k triangles");
    EXPECT_EQ(triangles_text(999499), "999 k triangles");
    EXPECT_EQ(triangles_text(999500), "1 M triangles");
    EXPECT_EQ(triangles_text(9987852), "9.99 M triangles");
    EXPECT_EQ(triangles_text(999499999), "999 M triangles");
    EXPECT_EQ(triangles_text(1000000004), "1 G triangles");
}

// Every edge, by the positions of its ends, occurs once in either direction. 41 is among the numbers whose
// reciprocal, rounded, times itself is not 1.
TEST(BenchMeshes, ADisplacedSphereIsClosed) {
    for (const uint32_t n : {1u, 2u, 7u, 41u}) {
        const TriangleMesh mesh = displaced_sphere(n, 3);
        EXPECT_EQ(mesh.triangles.size(), 12 * n * n);
        const auto key = [](vec3 p) { return std::tuple(p.x, p.y, p.z); };
        std::map<std::pair<std::tuple<float, float, float>, std::tuple<float, float, float>>, int> edges;
        for (const uvec3 t : mesh.triangles) {
            const vec3 corners[] = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
            for (int i = 0; i < 3; ++i)
                ++edges[{key(corners[i]), key(corners[(i + 1) % 3])}];
        }
        for (const auto& [edge, count] : edges) {
            ASSERT_EQ(count, 1);
            ASSERT_TRUE(edges.contains({edge.second, edge.first}));
        }
    }
}

TEST(BenchMeshes, ADisplacedSphereIsRoughAndItsFrontIsOutside) {
    const TriangleMesh mesh = displaced_sphere(30, 3);
    float min = 9.0f, largest = 0.0f;
    for (const vec3 p : mesh.positions) {
        min = std::min(min, length(p));
        largest = std::max(largest, length(p));
    }
    EXPECT_GE(min, 0.8f);
    EXPECT_LE(largest, 1.2f);
    EXPECT_GT(largest - min, 0.1f);
    // A star-shaped body, seen from 0: the front of every triangle is on its far side.
    for (const uvec3 t : mesh.triangles) {
        const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        ASSERT_GT(dot(cross(b - a, c - a), a), 0.0f);
    }
}

TEST(BenchMeshes, TheSameSeedMakesTheSameBumps) {
    EXPECT_EQ(displaced_sphere(5, 1).positions, displaced_sphere(5, 1).positions);
    EXPECT_NE(displaced_sphere(5, 1).positions, displaced_sphere(5, 2).positions);
}

// n is 1 for 72, 56 for 190 000, 129 for a million.
TEST(BenchMeshes, ASceneHasAboutTheTrianglesAskedFor) {
    EXPECT_EQ(triangle_count(displaced_scene(72)), 72u);
    EXPECT_EQ(triangle_count(displaced_scene(190000)), 60u * 56 * 56 + 12);
    EXPECT_EQ(triangle_count(displaced_scene(1000000)), 60u * 129 * 129 + 12);
}

// The wood is at most a quarter of the triangles.
TEST(BenchMeshes, ATreeHasTheTrianglesAskedForAndTheSizeOfATree) {
    for (const uint32_t triangles : {100u, 5000u, 100'000u}) {
        const TriangleMesh tree = tree_mesh(triangles, 1);
        EXPECT_EQ(tree.triangles.size(), triangles);
        Box box;
        for (const vec3 p : tree.positions)
            box.extend(p);
        EXPECT_NEAR(box.lo.y, 0.0f, 0.2f);
        EXPECT_GT(box.hi.y, 3.0f);
        EXPECT_LT(box.hi.y, 9.0f);
        for (const uvec3 t : tree.triangles) {
            const vec3 a = tree.positions[t.x], b = tree.positions[t.y], c = tree.positions[t.z];
            ASSERT_GT(length(cross(b - a, c - a)), 1e-5f);
        }
        EXPECT_EQ(tree_mesh(triangles, 1).positions, tree.positions);
        EXPECT_NE(tree_mesh(triangles, 2).positions, tree.positions);
    }
}

TEST(BenchMeshes, AForestHasItsTrees) {
    const Scene few = forest_scene(3), more = forest_scene(1000);
    EXPECT_EQ(triangle_count(few), 300'004u);
    EXPECT_EQ(few.meshes.size(), 1u);
    EXPECT_EQ(triangle_count(more), 100'000'004u);
    EXPECT_EQ(more.meshes.size(), 2u);
}

// The ids of copies go on where those of the shapes before end, as if all were baked.
TEST(BenchTriangles, AreThoseOfTheScene) {
    Scene scene = scattered_scene(50);
    add_shape(scene, parallelogram(vec3(-2), vec3(4, 0, 0), vec3(0, 0, 4)), 0);
    const BenchTriangles instanced(build_gpu_scene(scene, SceneFrame{}, {.min_triangles = 1}));
    const BenchTriangles baked(build_gpu_scene(scene, SceneFrame{}, {.min_uses = UINT32_MAX}));
    ASSERT_EQ(instanced.instances().size(), 50u);
    ASSERT_EQ(instanced.baked().size(), 2u);
    ASSERT_EQ(baked.baked().size(), 50u * 48 + 2);
    EXPECT_EQ(instanced.count(), baked.count());
    EXPECT_LT(length(instanced.bounds().lo - vec3(-2)) + length(instanced.bounds().hi - vec3(2, 1.1f, 2)),
              0.3f);
    for (uint32_t id = 0; id < 50 * 48; ++id) {
        // Those baked come first where others are not. A triangle may begin at any of its corners.
        const BenchTriangle a = instanced.at(2 + id), b = baked.at(id);
        ASSERT_LT(length(a.a + a.b + a.c - b.a - b.b - b.c), 1e-5f) << id;
    }
}

TEST(BenchMeshes, TheCameraSeesTheRoomFromWithinAndTheLightShinesDown) {
    const Scene scene = displaced_scene(1000);
    const vec3 eye(scene.cameras.front().position);
    EXPECT_LT(std::max(std::abs(eye.x), std::abs(eye.z)), 3.0f);
    EXPECT_LT(eye.y, 4.0f);
    for (const TriangleMesh& mesh : scene.meshes) {
        for (const vec3 p : mesh.positions)
            EXPECT_GT(distance(p, eye), 1.0f);
    }
    for (const Shape& shape : scene.shapes) {
        if (!shape.emission) continue;
        const Quad& light = std::get<Quad>(shape.geometry);
        EXPECT_LT(cross(light.corners[1] - light.corners[0], light.corners[3] - light.corners[0]).y, 0.0f);
    }
}

}  // namespace
}  // namespace candela
