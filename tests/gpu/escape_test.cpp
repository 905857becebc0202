// No ray leaves a closed mesh: millions of them, half of which aim at vertices and edges.
#include <array>
#include <map>
#include <string>

#include "gpu/device_fixture.h"
#include "load/ply/ply.h"
#include "support/scene_builders.h"

namespace candela {
namespace {

// Rays from around a point within the mesh.
struct EscapeItem {
    vec3 point;
    float spread;
    uint32_t first;  // Counter of its first ray.
    uint32_t count;
    uvec2 unused{0};
};

struct EscapeResult {
    uint32_t shot;
    uint32_t escapes;
    vec3 o, d;  // The last ray that escaped.
};

// A closed mesh, and points within it: no surface is nearer to them than `room`.
struct ClosedMesh {
    std::string name;
    TriangleMesh mesh;
    std::vector<vec3> points;
    float room;
};

// Every edge, by position, occurs once in either direction: nothing is open.
void expect_closed(const TriangleMesh& mesh) {
    const auto key = [](vec3 p) { return std::array{p.x, p.y, p.z}; };
    std::map<std::array<std::array<float, 3>, 2>, int> crossings;
    for (const uvec3 t : mesh.triangles) {
        for (const int i : {0, 1, 2}) {
            const auto a = key(mesh.positions[t[i]]), b = key(mesh.positions[t[(i + 1) % 3]]);
            if (a == b) continue;
            ++crossings[{a, b}];
            --crossings[{b, a}];
        }
    }
    for (const auto& [edge, count] : crossings)
        ASSERT_EQ(count, 0) << edge[0][0] << ' ' << edge[0][1] << ' ' << edge[0][2];
}

// A mesh all of which can be seen from its centre.
ClosedMesh around(vec3 centre, const char* name, TriangleMesh mesh) {
    double room = 1e30;  // To the nearest plane of a triangle.
    for (const uvec3 t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        const glm::dvec3 n = cross(b - a, c - a);
        if (length(n) > 0.0) room = std::min(room, dot(a - glm::dvec3(centre), n) / length(n));
    }
    return {name, std::move(mesh), {centre}, float(room)};
}

// The cube [-1, 1]^3, its faces cut into cells^2 squares.
TriangleMesh cube_mesh(uint32_t cells) {
    TriangleMesh mesh;
    for (const int axis : {0, 1, 2}) {
        for (const float sign : {-1.0f, 1.0f}) {
            const auto first = uint32_t(mesh.positions.size());
            for (uint32_t i = 0; i <= cells; ++i) {
                for (uint32_t k = 0; k <= cells; ++k) {
                    vec3 p(sign);
                    p[(axis + 1) % 3] = 2.0f * float(i) / float(cells) - 1.0f;
                    p[(axis + 2) % 3] = sign * (2.0f * float(k) / float(cells) - 1.0f);
                    mesh.positions.push_back(p);
                }
            }
            for (uint32_t i = 0; i < cells; ++i) {
                for (uint32_t k = 0; k < cells; ++k) {
                    const uint32_t a = first + i * (cells + 1) + k, b = a + cells + 1;
                    mesh.triangles.emplace_back(a, b, b + 1);
                    mesh.triangles.emplace_back(a, b + 1, a + 1);
                }
            }
        }
    }
    return mesh;
}

// A sphere some of whose vertices are drawn out into thorns: slivers, and edges sharp from within.
TriangleMesh thorny_mesh() {
    TriangleMesh mesh = sphere_mesh(24, 36);
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        if (i % 29 == 0) mesh.positions[i] *= 30.0f;
    }
    return mesh;
}

// The knot of glass, from points halfway between its surface and the middle of its tube.
ClosedMesh knot() {
    constexpr float TUBE = 0.62f;
    std::vector<std::string> warnings;
    ClosedMesh knot{"knot",
                    load_ply(CANDELA_SCENES "/knot.ply", MeshNormals::file,
                             FileReach(CANDELA_SCENES "/knot.ply"), warnings),
                    {},
                    0.4f * TUBE};
    for (size_t i = 0; i < knot.mesh.positions.size(); i += 7)
        knot.points.push_back(knot.mesh.positions[i] - 0.5f * TUBE * knot.mesh.normals[i]);
    return knot;
}

std::vector<ClosedMesh> closed_meshes() {
    const auto sphere_at = [](vec3 centre, float radius) {
        return transformed(sphere_mesh(48, 64), [=](vec3 p) { return centre + radius * p; });
    };
    const vec3 far(1e4f, -2e4f, 3e4f);
    std::vector<ClosedMesh> meshes{around(vec3(0), "sphere", sphere_at(vec3(0), 1.0f)),
                                   around(vec3(0), "cube", cube_mesh(16)),
                                   around(vec3(0), "thorns", thorny_mesh()),
                                   around(far, "far away", sphere_at(far, 1.0f)),
                                   around(vec3(0), "tiny", sphere_at(vec3(0), 1e-6f)),
                                   around(vec3(0), "huge", sphere_at(vec3(0), 1e6f))};
    for (const double scale : {1e-6, 1e-3, 1e3, 1e6})
        meshes.push_back(around(vec3(0), "scaled", in_its_frame(sphere_mesh(48, 64), scale, dvec3(0))));
    meshes.push_back(around(vec3(0), "moved", in_its_frame(cube_mesh(16), 1.0, dvec3(1e7, -3e6, 2e7))));
    meshes.push_back(knot());
    return meshes;
}

class EscapeTest : public DeviceTest {
  protected:
    // Shoots that many rays in total.
    void expect_no_escapes(uint64_t rays) const {
        // Few enough for lavapipe, which ends all loops of an invocation after 65 535 iterations.
        constexpr uint32_t RAYS_PER_ITEM = 32;
        const std::vector<ClosedMesh> meshes = closed_meshes();
        const uint64_t items_per_mesh = rays / meshes.size() / RAYS_PER_ITEM + 1;
        uint64_t shot = 0;
        uint32_t counter = 0;
        for (const ClosedMesh& closed : meshes) {
            expect_closed(closed.mesh);
            ASSERT_GT(closed.room, 0.0f) << closed.name;
            std::vector<EscapeItem> items;
            for (uint64_t i = 0; i < items_per_mesh; ++i, counter += RAYS_PER_ITEM) {
                // The corners of the cube that rays start from are sqrt(3) times as far as its faces.
                items.push_back(
                    {closed.points[i % closed.points.size()], 0.5f * closed.room, counter, RAYS_PER_ITEM});
            }
            const DeviceScene scene(device(), build_gpu_scene(scene_of_mesh(closed.mesh), SceneFrame{}),
                                    SceneAccess::texel_buffers);
            for (const EscapeResult& r : map<EscapeResult>(kernels::escape, items, {}, &scene)) {
                ASSERT_EQ(r.shot, RAYS_PER_ITEM) << "the driver ended a loop before its time";
                shot += r.shot;
                ASSERT_EQ(r.escapes, 0u) << closed.name << ", from " << r.o.x << ' ' << r.o.y << ' ' << r.o.z
                                         << " towards " << r.d.x << ' ' << r.d.y << ' ' << r.d.z;
            }
        }
        EXPECT_GE(shot, rays);
    }
};

TEST_F(EscapeTest, NoneOfTenMillionRaysLeavesAClosedMesh) {
    expect_no_escapes(sized(test_effort(), 10'000'000));
}

using SlowEscapeTest = EscapeTest;

TEST_F(SlowEscapeTest, NoneOfAHundredMillionRaysLeavesAClosedMesh) {
    expect_no_escapes(100'000'000);
}

}  // namespace
}  // namespace candela
