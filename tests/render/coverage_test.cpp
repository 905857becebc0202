// What pixels show first, and how much of each, against rays that the host traces.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "render_fixture.h"

namespace candela {
namespace {

constexpr uint32_t WIDTH = 24, HEIGHT = 16;
constexpr uint32_t GRID = 64;  // The rasteriser's samples along each side of a pixel.

// The distance at which a ray hits a geometry, one function for each; nothing if it does not.
std::optional<double> hit(const Quad& quad, dvec3 o, dvec3 d) {
    const dvec3 n = cross(quad.corners[1] - quad.corners[0], quad.corners[3] - quad.corners[0]);
    const double t = dot(quad.corners[0] - o, n) / dot(d, n);
    const dvec3 p = o + t * d;
    for (size_t i = 0; i < 4; ++i) {
        if (dot(cross(quad.corners[(i + 1) % 4] - quad.corners[i], p - quad.corners[i]), n) < 0.0)
            return std::nullopt;
    }
    return t;
}

std::optional<double> hit(const Sphere& sphere, dvec3 o, dvec3 d) {
    const double b = dot(sphere.center - o, d);
    const double root = b * b - dot(sphere.center - o, sphere.center - o) + sphere.radius * sphere.radius;
    return root < 0.0 ? std::nullopt : std::optional(b - std::sqrt(root));
}

std::optional<double> hit(const Disk& disk, dvec3 o, dvec3 d) {
    const dvec3 n = cross(disk.e1, disk.e2);
    const double t = dot(disk.center - o, n) / dot(d, n);
    const dvec3 p = o + t * d - disk.center;
    const double x = dot(p, disk.e1) / dot(disk.e1, disk.e1), y = dot(p, disk.e2) / dot(disk.e2, disk.e2);
    return x * x + y * y > 1.0 ? std::nullopt : std::optional(t);
}

std::optional<double> hit(const MeshInstance& /*instance*/, dvec3 /*o*/, dvec3 /*d*/) {
    return std::nullopt;
}

uint32_t first_shape(const Scene& scene, dvec3 o, dvec3 d) {
    uint32_t nearest = NO_PART.shape;
    double least = double(INFINITE);
    for (uint32_t i = 0; i < scene.shapes.size(); ++i) {
        const auto t = std::visit([&](const auto& g) { return hit(g, o, d); }, scene.shapes[i].geometry);
        if (!t || *t <= 0.0 || *t >= least) continue;
        least = *t;
        nearest = i;
    }
    return nearest;
}

// How many of the rasteriser's samples of pixel (x, y) show each shape; the last: nothing.
std::vector<uint32_t> rasterise(const Scene& scene, uint32_t x, uint32_t y) {
    const Camera& camera = scene.cameras[0];
    std::vector<uint32_t> counts(scene.shapes.size() + 1);
    for (uint32_t i = 0; i < GRID * GRID; ++i) {
        const double u = (x + (i % GRID + 0.5) / GRID) / WIDTH * 2.0 - 1.0;
        const double v = 1.0 - (y + (i / GRID + 0.5) / GRID) / HEIGHT * 2.0;
        const double half =
            camera.ortho_height ? 0.5 * *camera.ortho_height : std::tan(0.5 * double(camera.vertical_fov));
        const dvec3 film(u * half * WIDTH / HEIGHT, v * half, 0.0);
        const uint32_t shape = camera.ortho_height
                                   ? first_shape(scene, camera.position + film, dvec3(0, 0, -1))
                                   : first_shape(scene, camera.position, normalize(film + dvec3(0, 0, -1)));
        ++counts[std::min<size_t>(shape, scene.shapes.size())];
    }
    return counts;
}

// A camera at z = 4 looks down -z at things that lie over each other.
Scene some_things() {
    Scene scene = scene_with_camera(dvec3(0, 0, 4), dvec3(0), 0.6f);
    const uint32_t grey = add_diffuse(scene, vec3(0.5f));
    add_shape(scene, parallelogram(dvec3(-3, -0.9, -0.5), dvec3(6, 0.4, -0.3), dvec3(0, 1.1, -0.2)), grey);
    add_shape(scene, Sphere{dvec3(-0.8, 0.1, 0.2), 0.6}, grey);
    add_shape(scene, Disk{dvec3(0.7, 0.2, 0), dvec3(0.7, 0.1, 0), dvec3(-0.05, 0.35, 0)}, grey);
    add_shape(scene, Sphere{dvec3(1.1, -0.3, 0.5), 0.25}, grey);
    return scene;
}

class CoverageTest : public RenderTest {
  protected:
    Coverage coverage(const GpuScene& gpu, const Camera& camera, const RenderSettings& settings) const {
        return Renderer(device(), gpu, camera, settings).coverage(gpu, [] { return true; });
    }
    Coverage coverage(const Scene& scene,
                      const RenderSettings& settings = settings_for(WIDTH, HEIGHT)) const {
        return coverage(build_gpu_scene(scene), scene.cameras[0], settings);
    }

    // Shape 1 covers much of the picture.
    void expect_alpha(const Scene& scene, const RenderSettings& settings) const {
        const Coverage covered = coverage(scene, settings);
        const Image image = image_of(render(scene, settings, FIRST_HITS));
        uint32_t different = 0, total = 0, of_second = 0;
        for (size_t i = 0; i < covered.pixel_count(); ++i) {
            uint32_t hits = 0;
            for (const CoveredPart& part : covered.at(i)) {
                hits += part.hits;
                if (part.part.shape == 1) of_second += part.hits;
            }
            const double alpha = double(image.find("A")->values[i]);
            different += uint32_t(std::abs(double(hits) - alpha * FIRST_HITS) + 0.5);
            total += hits;
        }
        EXPECT_GT(of_second, 500u);
        EXPECT_GT(total, 5000u);
        EXPECT_LT(different, total / 1000);
    }
};

uint32_t hits_of(const Coverage& coverage, size_t pixel, uint32_t shape) {
    for (const CoveredPart& covered : coverage.at(pixel)) {
        if (covered.part.shape == shape) return covered.hits;
    }
    return 0;
}

void expect_same(const Coverage& a, const Coverage& b) {
    ASSERT_EQ(a.pixel_count(), b.pixel_count());
    for (size_t i = 0; i < a.pixel_count(); ++i)
        ASSERT_TRUE(std::ranges::equal(a.at(i), b.at(i))) << i;
}

// Each of the 64 cells of a pixel has one ray, so a cell is off only if an edge crosses it, by less than its
// area: an outline that is nearly straight crosses at most 16 of them, and 128 of the rasteriser's. A ray is
// a uniform point of its cell, so a cell has a variance of 1/4 at most, and a pixel a standard deviation of
// at most sqrt(16 / 4) / 64 = 1/32. The mean of the errors of n pixels, which are independent, has one of at
// most 1/32 / sqrt(n); the rasteriser's own errors are a 64th of that.
void expect_as_rasterised(const Coverage& coverage, const Scene& scene) {
    double sum = 0.0, squares = 0.0;
    size_t edges = 0;
    for (uint32_t pixel = 0; pixel < WIDTH * HEIGHT; ++pixel) {
        const std::vector<uint32_t> counts = rasterise(scene, pixel % WIDTH, pixel / WIDTH);
        for (uint32_t shape = 0; shape < scene.shapes.size(); ++shape) {
            const uint32_t hits = hits_of(coverage, pixel, shape);
            const double error = double(hits) / FIRST_HITS - double(counts[shape]) / (GRID * GRID);
            if (counts[shape] == 0 || counts[shape] == GRID * GRID) {
                ASSERT_LE(std::abs(error), 1.0 / FIRST_HITS) << pixel;  // A corner that the grid misses.
                continue;
            }
            ASSERT_LE(std::abs(error), 2.0 * 16.0 / FIRST_HITS) << pixel;  // Where two outlines cross.
            sum += error;
            squares += error * error;
            ++edges;
        }
    }
    ASSERT_GT(edges, 100u);
    EXPECT_LT(std::sqrt(squares / double(edges)), 1.0 / 32.0);
    EXPECT_LT(std::abs(sum / double(edges)), 5.0 / 32.0 / std::sqrt(double(edges)));
}

TEST_F(CoverageTest, IsThatOfARasteriser) {
    const Scene scene = some_things();
    expect_as_rasterised(coverage(scene), scene);
}

TEST_F(CoverageTest, OfAnOrthographicCameraIsThatOfARasteriser) {
    Scene scene = some_things();
    scene.cameras[0].ortho_height = 2.4;
    scene.cameras[0].vertical_fov = 0.0f;
    expect_as_rasterised(coverage(scene), scene);
}

// A camera within a sphere sees nothing else.
TEST_F(CoverageTest, FromWithinAShapeIsThatShape) {
    Scene scene = some_things();
    add_shape(scene, Sphere{scene.cameras[0].position, 0.1}, 0);
    const Coverage all = coverage(scene);
    for (size_t i = 0; i < all.pixel_count(); ++i)
        ASSERT_EQ(hits_of(all, i, 4), FIRST_HITS);
}

// It is asked at least every so many pixels; those that are left show nothing.
TEST_F(CoverageTest, StopsSoonAfterItIsToldTo) {
    constexpr uint32_t SIDE = 128, MOST_AT_ONCE = SIDE * SIDE / 2;
    const Scene scene = some_things();
    const GpuScene gpu = build_gpu_scene(scene);
    Renderer renderer(device(), gpu, scene.cameras[0], settings_for(SIDE, SIDE));
    const Coverage all = renderer.coverage(gpu, [] { return true; });
    int asked = 0;
    const Coverage part = renderer.coverage(gpu, [&] { return asked++ < 1; });
    EXPECT_EQ(asked, 2);
    ASSERT_EQ(part.pixel_count(), SIDE * SIDE);
    bool is_whole = true;
    for (size_t i = 0; i < part.pixel_count(); ++i) {
        is_whole = is_whole && std::ranges::equal(part.at(i), all.at(i));
        EXPECT_TRUE(part.at(i).empty() || (is_whole && i < MOST_AT_ONCE)) << i;
    }
    EXPECT_FALSE(part.at(SIDE * SIDE / 2 - SIDE / 2).empty());
}

TEST_F(CoverageTest, DependsOnPixelAndSeedAlone) {
    const Scene scene = some_things();
    const Coverage whole = coverage(scene);
    RenderSettings settings = settings_for(WIDTH, HEIGHT);
    settings.sampler = SamplerKind::independent;
    settings.first_sample = 1000;
    settings.max_depth = 1;
    expect_same(coverage(scene, settings), whole);

    settings.crop = {5, 3, 20, 9};
    const Coverage part = coverage(scene, settings);
    for (uint32_t i = 0; i < part.pixel_count(); ++i) {
        const uint32_t x = 5 + i % 15, y = 3 + i / 15;
        ASSERT_TRUE(std::ranges::equal(part.at(i), whole.at(y * WIDTH + x))) << i;
    }

    settings.seed = 1;
    const Coverage other = coverage(scene, settings);
    size_t different = 0;
    for (size_t i = 0; i < part.pixel_count(); ++i)
        different += !std::ranges::equal(part.at(i), other.at(i));
    EXPECT_GT(different, 0u);
}

// Meshes with trees of their own have the same shapes as those without, up to rounding at their edges.
TEST_F(CoverageTest, OfInstancesIsThatOfCopies) {
    Scene scene = scene_with_camera(dvec3(0, 0, 4), dvec3(0), 0.6f);
    add_diffuse(scene, vec3(0.5f));
    add_shape(scene, sphere_mesh(6, 8), 0);
    add_shape(scene, Sphere{dvec3(0, -1, 0), 0.3}, 0);
    for (int i = 0; i < 5; ++i) {
        Transform transform;
        ASSERT_TRUE(transform.append(glm::dmat4(dvec4(0.3, 0, 0, 0), dvec4(0, 0.3, 0, 0), dvec4(0, 0, 0.3, 0),
                                                dvec4(-1.2 + 0.5 * i, 0.2 * i - 0.3, 0.1 * i, 1))));
        scene.shapes.push_back({.geometry = MeshInstance{0, transform}, .material = 0, .emission = {}});
    }
    scene.shapes.erase(scene.shapes.begin());
    const SceneFrame frame = build_gpu_scene(scene).frame;
    const InstancingRule always{.min_uses = 1, .min_triangles = 0}, never{.min_uses = UINT32_MAX};
    const GpuScene instances = build_gpu_scene(scene, frame, always),
                   copies = build_gpu_scene(scene, frame, never);
    ASSERT_EQ(instances.instances.size(), 5u);
    ASSERT_TRUE(copies.instances.empty());
    const RenderSettings settings = settings_for(WIDTH, HEIGHT);
    const Coverage a = coverage(instances, scene.cameras[0], settings);
    const Coverage b = coverage(copies, scene.cameras[0], settings);
    std::vector<uint32_t> total(scene.shapes.size());
    uint32_t different = 0;
    for (size_t i = 0; i < a.pixel_count(); ++i) {
        for (uint32_t shape = 0; shape < total.size(); ++shape) {
            const uint32_t n = hits_of(a, i, shape), m = hits_of(b, i, shape);
            total[shape] += n;
            different += n > m ? n - m : m - n;
        }
    }
    for (const uint32_t hits : total)
        EXPECT_GT(hits, 200u);
    EXPECT_LT(different, 5u);
}

// The path kernel's camera rays hit something as often: of the same 64 samples, by any lens, through holes
// and what is half transparent. Kernels may round differently at an edge, and where a ray is a bit off,
// another one may pass what is half transparent.
TEST_F(CoverageTest, IsThatOfTheFirstSamples) {
    Scene scene = some_things();
    scene.cameras[0].lens = {.radius = 0.3f, .focal_distance = 3.0f, .blades = 5, .rotation = 0.2f};
    const Texture checks = add_texture(scene, uvec2(8, 8), [](uint32_t x, uint32_t y) {
        return vec4(0.0f, 0.0f, 0.0f, (x + y) % 2 == 0 ? 0.9f : 0.1f);
    });
    Material mask{.name = "mask", .model = DiffuseMaterial{}};
    mask.opacity.value.texture = checks;
    mask.opacity.value.texture->channel = 3;
    mask.opacity.cutoff = 0.5f;
    scene.materials.push_back(mask);
    scene.shapes[0].material = 1;
    scene.materials.push_back({.name = "veil", .model = DiffuseMaterial{}, .opacity = {.value = 0.5f}});
    scene.shapes[1].material = 2;
    RenderSettings settings = settings_for(WIDTH, HEIGHT);
    expect_alpha(scene, settings);
    settings.filter = {FilterShape::gaussian, 5.0f};
    expect_alpha(scene, settings);
    // A fisheye sees nothing outside of its circle, even from within a shape.
    scene.cameras[0].lens = {};
    scene.cameras[0].panorama = Panorama{.mapping = Mapping::fisheye, .fisheye_fov = 1.0f};
    scene.shapes[1].geometry = Sphere{scene.cameras[0].position, 0.1};
    expect_alpha(scene, settings_for(WIDTH, HEIGHT));
}

// Squares from left to right, of groups 2, 0 and 1, in a mesh that has a flat triangle, too.
TEST_F(CoverageTest, TellsGroupsOfAMeshApart) {
    Scene scene = scene_with_camera(dvec3(0, 0, 4), dvec3(0), 0.6f);
    add_diffuse(scene, vec3(0.5f));
    TriangleMesh mesh;
    for (const float x : {-1.2f, -0.4f, 0.4f}) {
        add_triangle(mesh, vec3(x, -1, 0), vec3(x + 0.8f, -1, 0), vec3(x + 0.8f, 1, 0));
        add_triangle(mesh, vec3(x, -1, 0), vec3(x + 0.8f, 1, 0), vec3(x, 1, 0));
    }
    add_triangle(mesh, vec3(0), vec3(1, 0, 0), vec3(2, 0, 0));
    std::swap(mesh.triangles[1], mesh.triangles[6]);
    mesh.groups = {2, 9, 0, 0, 1, 1, 2};
    add_shape(scene, Sphere{dvec3(0, 0, -9), 0.1}, 0);
    add_shape(scene, mesh, 0);
    const Coverage covered = coverage(scene);
    const auto at = [&](uint32_t x) { return covered.at(8 * WIDTH + x).front(); };
    EXPECT_EQ(at(5), (CoveredPart{{1, 2}, FIRST_HITS}));
    EXPECT_EQ(at(12), (CoveredPart{{1, 0}, FIRST_HITS}));
    EXPECT_EQ(at(18), (CoveredPart{{1, 1}, FIRST_HITS}));
}

}  // namespace
}  // namespace candela
